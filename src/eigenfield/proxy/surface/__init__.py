"""Surfaces from all sides: depth maps fused, closed and trimmed."""
