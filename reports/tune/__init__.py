"""Search an engine's settings for the cheapest ones that reach a target error."""
