"""The command `run`: one study answered, written to a folder and told on one screen."""
