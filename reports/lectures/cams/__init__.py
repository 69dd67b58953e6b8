"""Cams: from a task to profile, checks and drawings."""
