"""Measurements of heat: calorimetry of the polymer, a pad alone, and the log of a whole module."""
