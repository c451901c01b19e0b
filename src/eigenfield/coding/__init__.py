"""Arrays to payloads and back; knows no scene and no file."""
