"""The forces of a turn, drawn for a paper."""
