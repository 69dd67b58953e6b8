"""Scene files: read, checked and written."""
