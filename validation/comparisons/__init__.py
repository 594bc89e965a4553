"""The product's values of a case: functions from a case's inputs to named values."""
