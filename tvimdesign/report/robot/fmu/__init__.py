"""The joint as an FMU: heat and torque as C code, made from the product's equations."""
