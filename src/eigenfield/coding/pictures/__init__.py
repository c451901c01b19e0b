"""Pictures of 8-bit and 10-bit codes, and numbers to codes."""
