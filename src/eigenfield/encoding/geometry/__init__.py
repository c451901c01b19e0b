"""A proxy in few bytes: simplified and rounded by rate and distortion in the photographs."""
