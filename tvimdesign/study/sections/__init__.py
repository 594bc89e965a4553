"""Readers of the study file's sections, one file a section or kind of value."""
