"""Tables, plots, the results folder and the ledger: how an answer is told."""
