"""A user's own model: read, run in lines, judged, and reported."""
