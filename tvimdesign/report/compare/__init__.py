"""The command `compare`: studies of any modes compared, as drawn and each optimised for itself."""
