"""What stands under the tables of a verification: units, steps and versions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from rich.markup import escape

from reports.compare.errors import largest
from reports.describe.held_to import BENT, OVER_G, held_to
from reports.judge.cell import Checked
from reports.judge.rules.elastic import TruthEnds

DRIVEN = held_to(free=False, elastic=None, moved=" at the commanded time")
FREE = (
    "Let go: errors at the same time over G, by how much a small change of the start has grown; "
    "geometry at the run's own angle; drift of energy over the largest kinetic energy T. Classes: "
    "fine is a thousandth of the limit of the phase; 1e-1 and 1e-3 of the error as it is, and to "
    "when 1e-3 holds."
)
CHAINS = "engine: against the exact chain of as many segments instead; chain: that against the beam"
BEAMS = (
    "a beam of the engine's own has no exact chain, and under chain stands what its elements lock "
    "by, estimated"
)
THEORIES = (
    "doubt: what the beam may be off by; linear: what the linear theory is, which is judged by "
    "nothing."
)
FORCES = (
    "Forces against kinetostatics at the instants that they act at; F largest reaction, M largest "
    "torque over the run."
)


def footer(checked: Sequence[Checked], facts: Mapping[str, str]) -> str:
    """Units, steps and versions."""
    free = [one for one in checked if one.cell.drive == "free"]
    driven = [one for one in checked if one.cell.drive != "free"]
    lines = [
        *([DRIVEN] if any(not one.cell.scene.elastic for one in driven) else ()),
        *_elastic_words([one for one in checked if one.cell.scene.elastic]),
        *(FORCES for _ in checked[:1] if any(one.cell.with_forces for one in checked)),
        *([FREE] if any(not one.cell.scene.elastic for one in free) else ()),
        *(_free_steps(free) if free else ()),
        *_notes(checked),
        *(_driven_steps(driven) if driven else ()),
        ", ".join(f"{name} {value}" for name, value in facts.items()),
    ]
    return escape("\n".join(lines))


def _driven_steps(driven: Sequence[Checked]) -> list[str]:
    """How driven cells were stepped."""
    steps = sorted({round(one.cell.steps_per_turn, 3) for one in driven})
    turns = sorted({round(one.cell.turns, 3) for one in driven})
    dts = sorted({one.cell.dt_s for one in driven})
    drives = [e for one in driven if one.errors and (e := one.errors.worst("drive"))]
    drive = largest(drives)
    turned = f"{_span(turns)} turn" + ("" if turns == [1.0] else "s")
    return [
        f"dt {_span(dts)} s, {_span(steps)} steps a turn, {turned}; "
        + (f"largest drive error {drive.maximum:.1e} rad; " if drive else "")
        + "- not reported."
    ]


def _elastic_words(bent: Sequence[Checked]) -> list[str]:
    """What the numbers of elastic links are, as what these were given, and where the truth ends."""
    if not bent:
        return []
    is_beam = {one.cell.springs == "beam" for one in bent}
    parts = [f"{BENT}, of deflections over the largest, D, of places over the longest link, L"]
    parts += [CHAINS] * (False in is_beam) + [BEAMS] * (True in is_beam)
    parts += [OVER_G] * any(one.cell.drive == "free" for one in bent)
    given = dict.fromkeys(
        f"{one.cell.segments} elements of a beam"
        if one.cell.springs == "beam"
        else f"{one.cell.segments} segments, {one.cell.springs} springs"
        for one in bent
    )
    ends = dict.fromkeys(
        f"{one.cell.scene.name}, {one.cell.engine}: {found.text}."
        for one in bent
        if one.cell.gated
        for found in one.findings
        if found.rule == TruthEnds.id
    )
    return [f"{'; '.join([*parts, THEORIES])} Given as {'; '.join(given)}.", *ends]


def _free_steps(free: Sequence[Checked]) -> list[str]:
    """How free cells were stepped."""
    dts = sorted({one.cell.dt_s for one in free})
    lasts = sorted({round(one.cell.dt_s * one.cell.steps, 9) for one in free})
    growth = sorted(one.errors.free.sensitivity for one in free if one.errors and one.errors.free)
    return [
        f"dt {_span(dts)} s over {_span(lasts)} s"
        + (f"; G up to {_span(growth)}" if growth else "")
        + "; - not reported.",
    ]


def _notes(checked: Sequence[Checked]) -> list[str]:
    """What is to be said of forces, and of free motion, once for a scene: counts may differ by a
    sample."""
    notes = dict[tuple[str, str], str]()
    for one in checked:
        told = one.cell.with_forces or one.cell.drive == "free"
        for note in one.errors.notes if told and one.errors else ():
            words = "".join(letter for letter in note if not letter.isdigit())
            notes.setdefault((one.cell.scene.name, words), f"{one.cell.scene.name}: {note}.")
    return list(notes.values())


def _span(values: Sequence[float]) -> str:
    """One value, or the smallest and the largest."""
    low, high = f"{values[0]:.4g}", f"{values[-1]:.4g}"
    return low if low == high else f"{low} to {high}"
