"""Many cells of a study, evaluated or optimised by processes or batch jobs, and gathered to a table."""
