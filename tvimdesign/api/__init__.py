"""The door for Python users: studies, results and sweeps as objects; `tvimdesign` itself names what is public."""
