"""A joint by the contacts of its two links, and the motions that the adjacent joints leave it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, model_validator

from models.errors import suggestion
from models.files.faults import read_table
from models.files.schema import Name, Number, Table, Text
from models.lectures.shipped_tables import find_table, shipped_in

Vector = tuple[Number, Number, Number]
CONTACTS = Path(__file__).parents[1] / "contacts"
NEEDS = {
    "point": ("at_m", "normal"),
    "line": ("at_m", "normal", "along"),
    "circle": ("at_m", "axis"),
    "plane": ("at_m", "normal"),
    "cylinder": ("at_m", "axis"),
    "sphere": ("at_m",),
    "revolution": ("at_m", "axis"),
    "prism": ("axis",),
    "thread": ("at_m", "axis", "lead_m"),
}
"""Keys of each kind of contact; from plane on they are surfaces. A circle is the line of contact of
a ball in a tube."""
SURFACES = ("plane", "cylinder", "sphere", "revolution", "prism", "thread")
LIFTING = ("point", "line", "plane")
"""Contacts that open when the links are pulled apart, unless they hold ``both_ways``."""
PARALLEL = 1e-9


@dataclass(frozen=True)
class Contact:
    """Contact of two links, lengths in m; ``normal`` points out of the first. With ``both_ways`` it
    also holds when the two are pulled apart."""

    kind: str
    at: tuple[float, float, float]
    normal: tuple[float, float, float]
    along: tuple[float, float, float]
    axis: tuple[float, float, float]
    lead: float
    both_ways: bool


@dataclass(frozen=True)
class ContactGuide:
    """Freedoms of a joint that the adjacent joints leave it, and these joints."""

    leaves: tuple[str, ...]
    why: str


@dataclass(frozen=True)
class Touching:
    """Two links in contact; freedoms are named by axes through ``at`` [m]."""

    name: str
    source: str
    at: tuple[float, float, float]
    contacts: tuple[Contact, ...]
    guides: Mapping[str, ContactGuide] = field(default_factory=dict)
    note: str = ""

    @property
    def is_lower_pair(self) -> bool:
        """True if the two touch over surfaces alone."""
        return all(contact.kind in SURFACES for contact in self.contacts)


class ContactTable(Table):
    kind: str
    at_m: Vector | None = None
    normal: Vector | None = None
    along: Vector | None = None
    axis: Vector | None = None
    lead_m: Number | None = None
    both_ways: bool | None = None

    @model_validator(mode="after")
    def _is_of_its_kind(self) -> ContactTable:
        if self.kind not in NEEDS:
            raise ValueError(
                f"kind: found {self.kind!r}; {suggestion(self.kind, NEEDS, 'use one of', 1)}"
            )
        given = self.model_fields_set - {"kind"}
        needs = NEEDS[self.kind]
        if missing := [key for key in needs if key not in given]:
            raise ValueError(f"{', '.join(missing)}: missing; a {self.kind} contact has it")
        may = {*needs, "both_ways"} if self.kind in LIFTING else set(needs)
        if strange := sorted(given - may):
            raise ValueError(
                f"{strange[0]}: not of a {self.kind} contact, which has {', '.join(sorted(may))}"
            )
        for key in ("normal", "along", "axis"):
            if (vector := getattr(self, key)) is not None and not any(vector):
                raise ValueError(f"{key}: found {list(vector)}, of length 0; give a direction")
        if self.normal and self.along:
            dot = sum(a * b for a, b in zip(self.normal, self.along, strict=True))
            if dot**2 > PARALLEL * _square(self.normal) * _square(self.along):
                raise ValueError("along: not across the normal; the line lies in both surfaces")
        return self


class GuideTable(Table):
    leaves: list[Literal["Qx", "Qy", "Qz", "Tx", "Ty", "Tz"]] = Field(min_length=1, max_length=6)
    why: Text = ""


class TouchingTable(Table):
    name: Name
    source: Text
    note: Text = ""
    at_m: Vector | None = None
    contacts: Annotated[list[ContactTable], Field(min_length=1, max_length=50)]
    guided: dict[Name, GuideTable] = Field(default_factory=dict, max_length=10)


def shipped_contacts() -> list[str]:
    """List the names of the joints that come with crankcheck."""
    return list(shipped_in(CONTACTS))


def load_touching(name_or_path: str) -> Touching:
    """Load a shipped joint, or one of a file. Raises CrankcheckError as `find_table`,
    `read_table`."""
    path = find_table(name_or_path, CONTACTS, "joint", "crankcheck joint")
    table = read_table(path, TouchingTable)
    contacts = tuple(_contact(each) for each in table.contacts)
    guides = {
        name: ContactGuide(tuple(each.leaves), each.why) for name, each in table.guided.items()
    }
    at = table.at_m or contacts[0].at
    return Touching(table.name, table.source, at, contacts, guides, table.note)


def _contact(table: ContactTable) -> Contact:
    nothing = (0.0, 0.0, 0.0)
    return Contact(
        table.kind,
        table.at_m or nothing,
        _unit(table.normal),
        _unit(table.along),
        _unit(table.axis),
        table.lead_m or 0.0,
        table.kind not in LIFTING if table.both_ways is None else table.both_ways,
    )


def _unit(vector: Vector | None) -> tuple[float, float, float]:
    if vector is None:
        return (0.0, 0.0, 0.0)
    size = _square(vector) ** 0.5
    return (vector[0] / size, vector[1] / size, vector[2] / size)


def _square(vector: Vector) -> float:
    return sum(each * each for each in vector)
