"""Whole turns of the links, as functions of the driver's angle."""
