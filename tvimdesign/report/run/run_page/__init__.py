"""The page of a run, section by section, from the functions that the terminal and the tables are made by."""
