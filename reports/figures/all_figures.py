"""The figures by name, of all ways. To add one, add a file and its line in the part ``figures``."""

from __future__ import annotations

from collections.abc import Mapping
from typing import cast

from reports.figures.drawing import Drawing
from reports.way.way import own_parts

FIGURES: Mapping[str, Drawing] = {
    name: drawing
    for part in own_parts("figures").values()
    for name, drawing in cast(Mapping[str, Drawing], part).items()
}
