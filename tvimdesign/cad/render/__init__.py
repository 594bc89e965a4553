"""Pictures of the module without a display."""
