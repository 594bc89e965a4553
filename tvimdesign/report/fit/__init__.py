"""Fits of measured data told: screen, folder, figure, record."""
