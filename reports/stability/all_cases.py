"""The hard cases of all ways, by name."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import cast

from reports.stability.case import Case
from reports.stability.yardstick import yardsticks
from reports.way.way import WAYS, way

YARDSTICKS = yardsticks()
_PARTS = (way(name).own_part("cases", {}) for name in reversed(WAYS))
GROUPS = {
    group: cases
    for part in _PARTS
    for group, cases in cast(Mapping[str, tuple[Case, ...]], part).items()
}
CATALOGUE: dict[str, Case] = {
    case.name: replace(
        case,
        group=group,
        way=YARDSTICKS[case.judge][0],
        error_of=YARDSTICKS[case.judge][1].error_of,
    )
    for group, cases in GROUPS.items()
    for case in cases
}
