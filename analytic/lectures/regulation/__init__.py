"""How evenly a machine runs over its cycle, and the flywheel that makes it run so."""
