"""A PETG structure that is as stiff and as lossy when warm as at 23 degC, for tests of something else."""

STIFF_WHEN_WARM = {
    "structure_modulus_slope": 0.0,
    "structure_softened_share": 1.0,
    "structure_softening_loss_factor": 0.03,
}
LOSSLESS = {
    **STIFF_WHEN_WARM,
    "structure_loss_factor": 0.0,
    "structure_softening_loss_factor": 0.0,
    "clamped_loss_factor": 0.0,
}
"""And without loss."""
