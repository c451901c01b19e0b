"""Clips: photographs of a rig over time, on one proxy, as groups of frames that share their weights."""
