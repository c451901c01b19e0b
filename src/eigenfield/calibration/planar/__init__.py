"""Planar arrays with one viewing direction."""
