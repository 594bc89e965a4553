"""Measured data in: files read, the product's equations fitted to them, what was found written as a record."""
