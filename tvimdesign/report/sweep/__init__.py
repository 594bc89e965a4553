"""The command `sweep`: the folder, the tables, the figure and the screen of a sweep."""
