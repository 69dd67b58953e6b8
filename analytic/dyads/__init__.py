"""Closed-form solvers of the five class II Assur groups, one per file."""
