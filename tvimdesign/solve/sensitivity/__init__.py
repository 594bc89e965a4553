"""Sensitivity of outputs to inputs: exact derivatives, level sets, ratios of two modules."""
