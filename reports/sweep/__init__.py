"""Runs of many cells: each by itself, their timing, and the storage of their results."""
