"""Arrays that look one way."""
