"""Mobility and Assur groups."""
