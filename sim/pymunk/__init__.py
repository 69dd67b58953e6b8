"""pymunk."""
