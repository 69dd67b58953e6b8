"""Numbers that JSON has no name for."""

from __future__ import annotations

import math
from collections.abc import Mapping


def finite(value: object) -> object:
    """The value, and all that it holds, with numbers that are not finite as None."""
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, Mapping):
        return {key: finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [finite(item) for item in value]
    return value
