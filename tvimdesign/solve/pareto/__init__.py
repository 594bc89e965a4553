"""Pareto fronts: designs that no other one beats in all of two or three outputs."""
