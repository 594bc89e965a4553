"""Every figure, from plain data, and the process that draws them while the solver works."""
