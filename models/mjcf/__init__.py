"""MJCF, MuJoCo's format: the text of a scene."""
