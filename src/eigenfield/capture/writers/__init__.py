"""Calibrations as other tools read them."""
