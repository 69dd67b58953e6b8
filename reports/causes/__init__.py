"""Reasons why the channels of a user's own log are off."""
