"""Motions that masses and forces make, and no driver."""
