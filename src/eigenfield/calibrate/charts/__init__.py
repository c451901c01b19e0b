"""Calibration by boards."""
