"""The steady cycle of a machine and its flywheel in numbers: rows, tables, files."""
