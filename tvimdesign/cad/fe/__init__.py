"""Finite elements on the exported parts of a design: an outside judge of what the model says of them."""
