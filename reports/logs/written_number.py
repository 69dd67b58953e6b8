"""Numbers that are written as text, and what would make one of a text that is none."""

from __future__ import annotations

import re

from reports.logs.text_fields import COMMA, is_number

FORTRAN = re.compile(r"[-+]?[\d.]+d[-+]?\d+", re.IGNORECASE)
"""A double of Fortran: 1.5D-3."""
CLOCK = re.compile(r"(\d+ days?, )?\d+:\d\d.*|\d{2,4}[-./]\d\d?[-./]\d\d?.*")
"""An hour, or a date: 00:00:01, 2026-01-01."""
THOUSANDS = re.compile(r"[-+]?\d{1,3}(?:[ ,.'\u2019]\d{3})+(?:[.,]\d*)?")
"""Digits in groups of three: 1,000.5."""


def written_number(text: str, decimal: str) -> float:
    """The number that a text is, with that mark before its decimals. Raises ValueError for none."""
    if decimal == ",":
        if "." in text:
            raise ValueError
        text = text.replace(",", ".")
    if "_" in text:  # which Python takes for a number
        raise ValueError
    return float(text)


def cure_of(text: str, decimal: str) -> str:
    """What would make a number of a text."""
    text = text.strip()
    if COMMA.fullmatch(text) and decimal == ".":
        return "write decimal points, or say decimal = ',' in [file] of the map"
    if THOUSANDS.fullmatch(text):
        return "write numbers without marks between the thousands"
    if "." in text and decimal == "," and is_number(text):
        return "write a decimal comma, as the map says decimal = ','"
    if FORTRAN.fullmatch(text):
        return "write e for the d of the exponent"
    if CLOCK.fullmatch(text):
        return "write seconds from the start on"
    return "write numbers alone, or leave the column out ([[channel]] ignore = true)"
