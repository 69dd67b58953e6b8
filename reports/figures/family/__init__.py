"""Figures of families of mechanisms."""
