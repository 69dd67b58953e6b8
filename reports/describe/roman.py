"""Roman numbers, as classes and inversions are counted by."""

from __future__ import annotations

VALUES = ((10, "X"), (9, "IX"), (5, "V"), (4, "IV"), (1, "I"))


def roman(number: int) -> str:
    """IV for 4; of numbers from 1 to 39."""
    letters = ""
    for value, own in VALUES:
        letters += own * (number // value)
        number %= value
    return letters
