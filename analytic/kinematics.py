"""Public entry of the reference (signatures fixed; body follows)."""
