"""Assur groups of class III: all their assemblies, and one of them followed along the driver."""
