"""Many cells of a study, evaluated or optimised by processes, batch jobs or a cluster, and gathered to a table."""
