"""A model that somebody else wrote for MuJoCo: read as a scene, and run as it is."""
