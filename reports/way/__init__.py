"""The way of a kind of scene, to run it and compare it: the seam, and the list of kinds."""
