"""Elastic links: the reference of mechanisms whose links bend and stretch."""
