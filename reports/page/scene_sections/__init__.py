"""The sections of the page of a solved scene."""
