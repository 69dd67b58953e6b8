"""Requests of crankcheck: a frozen dataclass each, with its answer."""
