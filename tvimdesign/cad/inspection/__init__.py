"""Checks on the solids: whether each part can be printed or milled, put in its place, and stays clear of the others."""
