"""The residual layer, for archives: captured views as they were photographed. No other view has anything of it."""
