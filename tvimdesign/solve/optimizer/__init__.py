"""The problem solved: starts, runs of the solver, the optimum verified outside it, and its shadow prices."""
