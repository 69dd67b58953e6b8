"""Mechanisms that a synthesis found: their files, their table, their proof in engines."""
