"""The polymer between two faces: sheared, squeezed, held under a load."""
