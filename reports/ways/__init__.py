"""The kinds of scenes: a folder each."""
