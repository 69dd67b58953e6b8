"""The kinds of scenes: a module each."""
