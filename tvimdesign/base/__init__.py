"""What every floor stands on: exceptions with their exit codes, quantities with units, files that appear whole."""
