"""Cams: profile, pressure angle, curvature, contact force, and outlines for engines."""
