"""Springs: rate, stress, and how a leg on its pin turns them into a torque about the rotor."""
