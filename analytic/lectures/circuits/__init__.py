"""Circuits and branches of a mechanism, and the motion of its links on its own branch."""
