"""Outside values of a case: closed solutions and stored tables. Nothing here imports the product."""
