"""The paper against its own numbers."""
