"""A mechanism and its motion in words and tables."""
