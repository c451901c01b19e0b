"""A calibrated capture and a proxy in, an eigen-texture scene out."""
