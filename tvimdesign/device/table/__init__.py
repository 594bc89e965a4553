"""The table: kinds of quantities, their definition in a file, and the phases of the working cycle."""
