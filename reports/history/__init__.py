"""One engine in several versions: an environment for each, one verification, and the changes."""
