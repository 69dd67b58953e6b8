"""The columns of free cells: times to which they are followed and classes of precision hold."""

from reports.compare.free_facts import FreeFacts
from reports.judge.cell import Checked


def columns(checked: Checked) -> dict[str, object]:
    """The columns of a cell, None where there is no number."""
    known = FreeFacts.of(checked.errors)
    limit = checked.limits.get("phase")
    return {
        "precision": precision(checked),
        "sensitivity": known.sensitivity if known else None,
        "judged_until_s": known.until_s if known else None,
        "left_out": known.left_out if known else None,
        "limit_positions": known.passages if known else None,
        **{
            f"horizon_{name}_s": known.horizon_s(size) if known else None
            for name, size in IFTOMM.items()
        },
        "horizon_limit_s": known.judged_horizon_s(limit.number) if known and limit else None,
    }


COLUMNS = columns


IFTOMM = {"1e-1": 1e-1, "1e-3": 1e-3}
"""Largest unscaled error, by the name of the class, from the low to the high."""
FINE = {"phase": 1e-3, "geometry": 1.5e-3, "energy": 5e-3}
"""Shares of the common limits within which a cell is fine: at steps of 1e-3 s, over ten seconds of
a swinging four-bar, 5e-6 rad, 1e-6 rad and 1e-5 of the energy."""


def precision(checked: Checked) -> str:
    """The classes that a cell reaches, such as ``fine, 1e-3``; "none" where it reaches none.

    The library requires a solution within 1e-1 of its reference (low precision), or within 1e-3
    (high precision): here of the unscaled error of phase and place, in radians or longest links, at
    the same time. Our own classes are over the sensitivity, and separate engines whose errors are
    all within the common limits: an engine that integrates with order four and holds its joints
    stiffly reaches ``fine``.

    Source: M. Gonzalez, D. Dopico, U. Lugris, J. Cuadrado, A benchmarking system for MBS simulation
    software, Multibody System Dynamics 16 (2006), 179-190.
    """
    errors = checked.errors
    facts = FreeFacts.of(errors)
    if facts is None or checked.status != "ok":
        return "none"
    own = []
    if checked.verdict == "within":
        own = ["fine" if is_fine(checked) else "common"]
    reached = [name for name, size in IFTOMM.items() if facts.raw[-1] <= size]
    return ", ".join([*own, *reached[-1:]]) or "none"


def is_fine(checked: Checked) -> bool:
    """True if all judged errors are within the shares of the fine class."""
    assert checked.errors is not None
    for name, share in FINE.items():
        worst = checked.errors.worst(name)
        if worst is not None and not worst.pure <= share * checked.limits[name].number:
            return False
    return True
