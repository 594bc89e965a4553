"""The device as compiled functions, and its working cycle simulated with them."""
