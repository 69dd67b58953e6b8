"""The steady cycle of a machine and its flywheel, drawn for a paper."""
