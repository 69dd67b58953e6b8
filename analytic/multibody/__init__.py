"""Forward dynamics in redundant coordinates, with a Lagrange multiplier for every constraint."""
