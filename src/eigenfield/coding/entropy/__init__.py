"""Adaptive binary arithmetic coding, and tables of whole numbers on top of it."""
