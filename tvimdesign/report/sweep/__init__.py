"""Tables, figures and pages of sweeps, and of the atlas: the lightest modules over torque and time."""
