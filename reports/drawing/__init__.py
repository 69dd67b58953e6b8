"""A mechanism in motion, drawn."""
