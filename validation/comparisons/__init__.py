"""What the product says of a case: functions from a case's inputs to named values."""
