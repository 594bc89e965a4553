"""What spreading parts and materials do to a module: `tvimdesign tolerate`."""
