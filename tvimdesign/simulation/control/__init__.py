"""Closed-loop control of the joint's state by its heater's current."""
