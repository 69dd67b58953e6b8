"""What a user's own log has to hold, by names of quantities and bodies."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from models.errors import CrankcheckError, few, shown, suggestion
from models.scene import Scene
from reports.compare.errors import Errors
from reports.own_log.log_kind import log_kind
from reports.quantities import QUANTITIES


def required_name(scene: Scene, name: str) -> tuple[str, str, str]:
    """What a name that is required is: as given, a quantity and a body, "" for any.

    Raises CrankcheckError for one that is neither.
    """
    bodies = {*scene.links, *scene.pins, *scene.sliders}
    if name in QUANTITIES:
        return name, name, ""
    if name in bodies:
        return name, "", name
    body, dot, quantity = name.rpartition(".")
    if scene.driver.is_crank and (body, quantity) == (scene.driver.link, "angle"):
        quantity = log_kind(scene).driver_angle
    if dot and body in bodies and quantity in QUANTITIES:
        return name, quantity, body
    names = [*QUANTITIES, *sorted(bodies)]
    raise CrankcheckError(
        f"--require {shown(name)}: neither a quantity nor a body of {scene.name}, nor both as in "
        f"{next(iter(scene.links))}.angle; {suggestion(name, names, 'there are')}"
    )


def absent_names(
    scene: Scene,
    required: Iterable[tuple[str, str, str]],
    not_judged: Sequence[str],
    errors: Errors,
) -> tuple[str, ...]:
    """Each name that is required and not in the log, with what is lacking: of a quantity every
    body, of a body anything. Raises CrankcheckError for what is judged in no log."""
    held = {(row.quantity, row.body) for row in errors.rows}
    found = []
    for name, quantity, body in required:
        lacks = [
            each.replace("drive of", "angle of").replace("phase of", "angle of")
            for each in not_judged
            if (not quantity or each.startswith(f"{quantity} of "))
            and (not body or _is_of(each.partition(" of ")[2], body))
        ]
        there = any(quantity in ("", q) and (not body or _is_of(b, body)) for q, b in held)
        if not (lacks or there):
            none = f"{body or scene.name} has none"
            why = "a point of the ground does not move" if body in scene.ground else none
            raise CrankcheckError(f"--require {name}: {why}, so that is not judged; leave it out")
        if not lacks or (there and not quantity):
            continue
        if body in scene.ground:
            found.append(f"{few(lacks, 6)} (a point of the ground is not judged else)")
        elif lacks == [name] or body:
            found.append(few(lacks, 6))
        else:
            found.append(f"{name} ({few(lacks, 6)})")
    return tuple(found)


def _is_of(judged: str, body: str) -> bool:
    """Whether what is judged is of a body: `C on rod`, the force of a pin on a body, is of C."""
    return judged == body or judged.startswith(f"{body} on ")
