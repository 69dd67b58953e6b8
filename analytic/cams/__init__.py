"""Cams: profile, pressure angle, curvature, contact force, and the law of a given profile."""
