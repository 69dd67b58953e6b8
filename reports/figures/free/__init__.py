"""Figures of free motions."""
