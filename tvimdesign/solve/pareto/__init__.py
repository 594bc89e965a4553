"""Fronts: designs none of which is better in all of two or three outputs."""
