"""The explorer: a study's page from a local server, with controls that evaluate and optimise as they move."""
