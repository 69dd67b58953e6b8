"""A run of segmented links beside the beam, and beside the exact chain of as many segments."""
