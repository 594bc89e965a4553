"""The campaign of inputs: how they are drawn, what is done with each kind, and what counts as a fault."""
