"""A user's own log: the meaning of its columns, and its readings of a scene."""
