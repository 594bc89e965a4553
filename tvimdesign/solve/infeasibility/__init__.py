"""Reasons why a study has no design: proofs from the bounds, the conflict set, and the problem inspected."""
