"""One engine in several versions: an environment for each, the same verification, and the
changes."""
