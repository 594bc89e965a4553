"""The shear module without springs: it holds by its frozen layer and turns freely while that is molten."""
