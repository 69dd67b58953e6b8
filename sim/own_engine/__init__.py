"""Engines that are not ours: a user's own, named by module and attribute or by an entry point."""
