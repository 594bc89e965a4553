"""The device as compiled functions, and its working cycle simulated: how a design is evaluated."""
