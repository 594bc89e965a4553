"""Reports of an answer: tables, plots and the results folder."""
