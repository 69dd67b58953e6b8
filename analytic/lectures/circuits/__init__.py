"""Circuits and branches of a mechanism, and what its links do on the one that it is on."""
