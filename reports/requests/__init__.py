"""What can be asked of crankcheck: a frozen dataclass each, with what answers it."""
