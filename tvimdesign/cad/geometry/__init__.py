"""Means of drawing parts: dimensions in mm, simple solids, springs, kinds of part and how each is produced."""
