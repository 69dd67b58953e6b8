"""Figures of the vibration of elastic links: over a turn, over speeds, over inertia."""
