"""Virtual tests of the polymer and of the joint, as a laboratory would run them."""
