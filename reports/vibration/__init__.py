"""The steady vibration of elastic links in numbers: rows, tables, files."""
