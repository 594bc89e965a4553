"""The quantities all modules have: layout, springs, impedance, heat, mass, clearances, materials."""
