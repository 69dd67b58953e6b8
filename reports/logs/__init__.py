"""A user's own log: what its columns mean, and what they say of a scene."""
