"""Small files of tables besides scenes (schemes, contacts): find them; and the base of tasks."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from pydantic import Field, StringConstraints, model_validator

from models.errors import CrankcheckError, cut, nearest
from models.files.reading import is_there
from models.files.schema import Coordinates, Name, Positive, Table, Text
from models.lectures.draft import SPEED_RAD_S


def shipped_in(folder: Path) -> dict[str, Path]:
    """Return the files of a folder by name, in alphabetical order."""
    return {path.stem: path for path in sorted(folder.glob("*.toml"))}


def find_table(name_or_path: str, folder: Path, what: str, lists: str) -> Path:
    """Find the file of a shipped name, or of a path. Raises CrankcheckError for neither. ``what``
    names the kind of table, ``lists`` the command that lists the names."""
    known = shipped_in(folder)
    if name_or_path in known:
        return known[name_or_path]
    path = Path(name_or_path)
    if is_there(name_or_path):
        return path
    near = nearest(path.stem, known, cutoff=0.5)
    hint = f"Did you mean {' or '.join(near)}?" if near else f"`{lists}` lists the names."
    raise CrankcheckError(
        f"{what} {cut(name_or_path, 80)!r}: neither a shipped name nor a file. {hint}"
    )


MOST_LOADS = 20
Source = Annotated[Text, StringConstraints(min_length=1)]


class Region(Table):
    """A rectangle of the ground for the fixed pivots [m]."""

    from_m: Coordinates
    to_m: Coordinates

    @model_validator(mode="after")
    def _is_no_line(self) -> Region:
        if self.from_m[0] >= self.to_m[0] or self.from_m[1] >= self.to_m[1]:
            raise ValueError(
                f"from_m is {list(self.from_m)}, to_m {list(self.to_m)}: give the lower left and "
                "the upper right corner"
            )
        return self

    def holds(self, place: complex) -> bool:
        """True if it contains a place."""
        return (
            self.from_m[0] <= place.real <= self.to_m[0]
            and self.from_m[1] <= place.imag <= self.to_m[1]
        )


class TaskTable(Table):
    """Base of all tasks: the name, the source, and requirements on the solutions.

    ``speed_rad_s`` is the speed of the driver, or its circular frequency if it oscillates;
    ``loads`` are loads of the scenes, on links by the names in the solutions.
    """

    name: Name
    source: Source
    note: Text = ""
    tolerance_m: Positive | None = None
    tolerance_deg: Positive | None = None
    pivots_in: Region | None = None
    least_transmission_deg: Annotated[float, Field(strict=True, ge=0.0, le=60.0)] | None = None
    speed_rad_s: Positive = SPEED_RAD_S
    loads: dict[Name, dict[str, object]] = Field(default_factory=dict, max_length=MOST_LOADS)
