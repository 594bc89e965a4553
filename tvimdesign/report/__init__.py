"""Reports of an answer: tables, plots, the results folder and the paper check."""
