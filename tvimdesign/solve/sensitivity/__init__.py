"""What outputs owe to inputs: exact derivatives, level sets, ratios of two modules."""
