"""The atlas: figure, page and tables of the lightest modules over torque and time."""
