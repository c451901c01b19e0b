"""Calibration of multi-camera rigs with boards."""
