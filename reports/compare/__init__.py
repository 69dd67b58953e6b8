"""A run beside the truth."""
