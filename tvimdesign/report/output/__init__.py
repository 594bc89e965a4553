"""What all reports write with: the results folder, progress on the terminal, tables."""
