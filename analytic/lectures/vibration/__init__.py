"""Vibration of elastic links at a speed, over speeds and over inertia."""
