"""Evaluation of a design: its working cycle simulated, and what a laboratory would measure on the module."""
