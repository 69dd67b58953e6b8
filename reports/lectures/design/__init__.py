"""Mechanisms found by a synthesis: their files, their table, their proof in engines."""
