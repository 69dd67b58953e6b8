"""Hard cases: each engine graded on scenes that run into trouble, by rules."""
