"""The thermal stack, and the two phases of a switch."""
