"""Evenness of a machine's speed over its cycle, and the flywheel for it."""
