"""The first screen of a run: what was asked and got, what it rests on, what holds it back, what to mend."""
