"""Figures of a store's free runs beside the truth."""
