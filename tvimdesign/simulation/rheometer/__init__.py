"""The polymer alone in a virtual rheometer: oscillation, creep, relaxation, and simple models fitted to it."""
