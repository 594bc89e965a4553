"""The command `compare`: studies of any modes held against each other, as drawn and each optimised for itself."""
