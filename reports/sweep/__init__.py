"""Many cells: which there are, running each by itself, timing them, keeping what came of them."""
