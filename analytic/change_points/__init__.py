"""Change points, where assemblies meet: their places, signs, and the smooth motion through them."""
