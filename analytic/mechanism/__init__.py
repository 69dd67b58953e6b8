"""Theory of a whole mechanism."""
