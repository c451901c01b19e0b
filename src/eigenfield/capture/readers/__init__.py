"""One file for each capture format."""
