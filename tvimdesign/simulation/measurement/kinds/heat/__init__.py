"""What heat says: calorimetry of the polymer, a pad alone, and the log of a whole module."""
