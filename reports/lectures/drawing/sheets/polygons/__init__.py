"""Sheets of velocity and acceleration polygons."""
