"""The module as two rigid bodies, what stands and what turns: mass properties and a coarse mesh of each."""
