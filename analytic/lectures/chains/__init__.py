"""Kinematic chains by number and type: links and joints with a wanted mobility."""
