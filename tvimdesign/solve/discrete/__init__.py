"""Choices from lists: branch and bound over sizes and records."""
