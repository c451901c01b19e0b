"""Photographs from files, their profiles, lenses and metadata."""
