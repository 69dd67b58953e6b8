"""A user's own model for MuJoCo: read as a scene, and run as it is."""
