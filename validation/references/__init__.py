"""What others say of a case: closed solutions and stored tables. Nothing here imports the product."""
