"""Which pieces of work make a module's files, done in child processes and cached."""
