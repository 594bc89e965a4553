"""The kinds of measurement: what each needs from a file, the equations behind it, and what follows for a record."""
