"""Figures of mechanisms with elastic links."""
