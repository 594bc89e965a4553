"""Textbook equations as pure functions: SI in, SI out; floats, numpy arrays and CasADi symbols alike."""
