"""The shear module: what its flat layer between floor and rotor plate adds to the quantities that all modes share."""
