"""The problem solved: starts, IPOPT's runs, the optimum verified outside it, and its shadow prices."""
