"""Means, eigen textures and weights fitted to the photographs through the exact drawing, and coded in a closed loop."""
