"""The link's motion in time, exact in every mode of the layer, with contact where blocks only push."""
