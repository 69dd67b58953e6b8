"""The tests; a package, as an engine's wheel installs one of this name too."""
