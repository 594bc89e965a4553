"""What a polymer says on a rheometer: its spectrum from any test, its shift with temperature, its linear range."""
