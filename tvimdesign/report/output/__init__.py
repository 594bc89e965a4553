"""Shared output of all reports: the results folder, progress on the terminal, tables."""
