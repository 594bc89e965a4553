"""Measurements of a polymer on a rheometer: its spectrum from any test, its temperature shift, its linear range."""
