"""How a kind of scene is run and compared: the seam, and which kinds there are."""
