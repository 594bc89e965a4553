"""Stiffness, damping and strength of the joint: PCL, structure and springs together."""
