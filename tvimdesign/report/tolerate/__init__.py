"""Effect of tolerances of parts and materials on a module: `tvimdesign tolerate`."""
