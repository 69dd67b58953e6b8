"""The sections of the page of an own model: its verdict, its lines, the mechanism beside the truth,
what can disturb it, the recommended settings, and how all of it was made."""
