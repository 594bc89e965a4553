"""The optimisation problem written down: unknowns, constraints, objective, collocation, derivatives."""
