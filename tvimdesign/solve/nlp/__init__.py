"""The optimisation problem written down: free numbers, constraints, objective, and their derivatives."""
