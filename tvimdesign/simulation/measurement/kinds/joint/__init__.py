"""What joints and springs say: torque over angle, swings, sines, and where a frozen joint gives."""
