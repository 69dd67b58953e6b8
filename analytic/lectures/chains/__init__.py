"""Kinematic chains by number and type: which links and joints give a wanted mobility."""
