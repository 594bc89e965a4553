"""How a design is evaluated: its working cycle simulated, and what a laboratory would measure on the module."""
