"""Measurements of joints and springs: torque over angle, swings, sines, and where a frozen joint gives."""
