"""Parameters from data: robust least squares with exact derivatives, intervals, and what the data cannot tell apart."""
