"""Heat: conduction, melting and freezing through a stack, and Peltier modules."""
