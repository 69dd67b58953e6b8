"""Stored runs beside each other: what two of them say of the same cell, and what changed."""
