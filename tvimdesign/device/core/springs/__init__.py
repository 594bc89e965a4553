"""The torsion springs: their rate as drawn and held, what they bear, what is bought from stock."""
