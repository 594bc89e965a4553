"""The machinery of the one table: quantities, how a room writes them, and the phases of the working cycle."""
