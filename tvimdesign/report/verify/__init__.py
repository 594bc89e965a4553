"""Comparison of a design's model with finite elements on its exported parts, and its report."""
