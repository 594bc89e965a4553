"""The base of all floors: exceptions with exit codes, quantities with units, files that appear whole."""
