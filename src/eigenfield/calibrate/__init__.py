"""Cameras from photographs: structure from motion, charts, and planar arrays."""
