"""Workshop drawings and the spring maker's sheet: views, dimensions, fits, surfaces and edges."""
