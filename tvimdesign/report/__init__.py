"""Tables, plots, the results folder and the paper check: how an answer is told."""
