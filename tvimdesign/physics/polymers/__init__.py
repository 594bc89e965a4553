"""The polymer as a material: its moduli, its flow, how it freezes and shrinks."""
