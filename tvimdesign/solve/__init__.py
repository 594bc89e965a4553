"""Asks the device questions: evaluate, simulate one switch, optimise."""
