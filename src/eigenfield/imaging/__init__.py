"""Pictures as arrays: rasterising, measures."""
