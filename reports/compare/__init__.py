"""Comparison of a run with the reference."""
