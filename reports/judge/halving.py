"""Convergence of an error when the step is halved: two finer runs of a cell, and their result."""

import math
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace

from models.errors import CrankcheckError
from models.scene import Scene
from reports.compare.compare import Truth, incomplete, places
from reports.compare.errors import Error, Errors, largest
from reports.compare.whole_errors import force_rows
from reports.judge.rules.reference import too_good
from reports.judge.three_steps import Convergence, convergence
from reports.judge.tolerance import Limit, beyond_engine, limits, shaken_by_rounding
from reports.quantities import named
from sim.engine import Placing, Run

ELASTIC = ("segments", "deflection")
PLACES, FORCES = ("phase", *named("place")), named("force")
HALVINGS = 2
EXACT_DRIVE = 1e-9
"""Drive error [rad] up to which the crank is right up to rounding; long runs add the error of
their sums (`reports.compare.whole_errors`)."""
BEHIND_DRIVE = 5.0
"""Ratio of the other links' rounding to that of the crank, at most."""


@dataclass(frozen=True)
class Followed:
    """Convergence of the largest position error, and of the forces, where there are any."""

    places: Convergence | None = None
    forces: Convergence | None = None


def followed(
    truth: Truth,
    dt_s: float,
    errors: Errors,
    tolerance: Mapping[str, float],
    rerun: Callable[[int], Run],
    placing: Placing = "integrated",
    order: int = 2,
) -> Followed:
    """Follow the largest errors of position and of forces at ``dt_s``, its half and its quarter:
    those of the quantity that is worst at the full step, at the same instants throughout.

    The solutions of the ``truth`` at the full step serve the finer ones; ``rerun`` is the run with
    its step divided by a number, ``placing`` and ``order`` are the engine's (`sim.engine.Engine`).
    """
    worst, force = worst_place(errors), _largest_total(errors.rows, FORCES)
    motion, summed_rad = errors.of_motion, errors.of_scene.summed_rad
    if worst is None or not motion.has_order:
        return Followed()
    parts = [2**halving for halving in range(HALVINGS + 1)]
    finer = [_finer(truth, dt_s, p, rerun) for p in parts[1:]]
    every_row = [*errors.rows, *(row for rows, _ in finer for row in rows)]
    drive = largest(row for row in every_row if row.quantity == "drive")
    least = errors.of_scene.floor
    rounding = _rounding(drive, max(EXACT_DRIVE, least) + parts[-1] * summed_rad, least)
    rounding = motion.rounding(rounding, parts[-1] * summed_rad, worst.pure_bound)
    steps_s, faults = [dt_s / p for p in parts], [fault for _, fault in finer if fault]
    before = limits(truth.scene, errors, tolerance)

    def pure(followed: Error) -> list[float]:
        same = [_largest_total(rows, [followed.quantity]) for rows, _ in finer]
        return [followed.pure, *(row.pure if row else math.nan for row in same)]

    def over(quantities: Sequence[str], rounding: float, rate: int = 0) -> list[str]:
        numbered = zip(parts[1:], finer, strict=True)
        texts = (
            _over(truth.scene, dt_s, errors, before, tolerance, p, rows, quantities, hidden)
            for p, (rows, _) in numbered
            for hidden in [max(rounding, shaken_by_rounding(errors, rate, p))]
        )
        return [text for text in texts if text]

    limit = before.get(worst.tolerance)
    unit = "rad" if worst.unit == "rad" else "of the longest link"
    unit = "of the largest deflection" if worst.quantity in ELASTIC else unit
    of_places = convergence(
        steps_s,
        pure(worst),
        unit,
        rounding,
        faults=faults,
        over=over(motion.closing, rounding),
        copied=_copied(errors, dt_s, parts, [errors.rows, *(rows for rows, _ in finer)], order)
        if placing == "integrated"
        else (),
        cancels=motion.cancels,
        known=beyond_engine(worst.quantity, errors),
        solved=motion.solved * (limit.number if limit else 0.0),
    )
    if force is None:
        return Followed(of_places)
    exact = max(rounding, force.pure_bound)
    share = "torque" if force.quantity == "torque" else "reaction"
    noise = [shaken_by_rounding(errors, 2, p) for p in parts]
    shown = [0.0 if e <= off else e for e, off in zip(pure(force), noise, strict=True)]
    of_forces = convergence(
        steps_s, shown, f"of the largest {share}", exact, over=over(FORCES, exact, 2)
    )
    return Followed(of_places, of_forces)


def _finer(
    truth: Truth, dt_s: float, parts: int, rerun: Callable[[int], Run]
) -> tuple[list[Error], str]:
    """Return errors of position and gaps of a finer run, and its fault: "" where it ended well."""
    at = f"at dt {dt_s / parts:.3g} s"
    try:
        done = rerun(parts)
        beside = truth.beside(done)
        rows = places(beside)
        rows += force_rows(beside).rows if beside else ()
    except CrankcheckError as error:
        return [], f"{at} nothing to compare: {error}"
    if done.status != "ok":
        return rows, f"{at} {done.status} at t = {done.stopped_at_s:.4g} s: {done.reason}"
    short = incomplete(done)
    return rows, f"{at} {short}" if short else ""


def _over(
    scene: Scene,
    dt_s: float,
    errors: Errors,
    before: Mapping[str, Limit],
    tolerance: Mapping[str, float],
    parts: int,
    rows: Sequence[Error],
    quantities: Sequence[str],
    rounding: float,
) -> str:
    """Return the errors of a finer run over the limits of its step, the worst of each quantity. An
    error over its limit at the full step, one of those ``before``, fails its own rule, and is not
    repeated."""
    finer = _at_step(errors, parts, errors.of_scene.summed_rad * parts)
    in_force = limits(scene, finer, tolerance)
    texts = []
    for name in quantities:
        full, fine = errors.worst(name), _largest_total(rows, [name])
        if name not in before or full is None or fine is None:
            continue
        if not full.pure <= before[name].number:
            continue
        limit = in_force[name].number
        if not fine.pure <= max(limit, rounding):
            texts.append(f"{name} of {fine.body} {fine.pure:.2g}, limit {limit:.2g}")
    return f"at dt {dt_s / parts:.3g} s {'; '.join(texts)}" if texts else ""


def _at_step(errors: Errors, parts: int, summed_rad: float) -> Errors:
    """Return the same errors at the step divided by ``parts``."""
    step_rad = errors.of_scene.step_rad / parts
    finer = replace(errors.of_scene, step_rad=step_rad, summed_rad=summed_rad)
    return replace(errors, of_scene=finer)


def _copied(
    errors: Errors,
    dt_s: float,
    parts: Sequence[int],
    runs: Sequence[Sequence[Error]],
    order: int,
) -> list[str]:
    """Return the finer runs that are copies: of one before them, or of the reference. A shorter
    step rounds otherwise, if nothing else: the errors of bodies that do not move evenly with the
    driver are never the same to the last bit."""
    texts = []
    seen: dict[tuple[float, ...], str] = {}
    for number, rows in zip(parts, runs, strict=True):
        at = f"dt {dt_s / number:.3g} s"
        own = [row for row in rows if (row.body_kind, row.body) in errors.of_scene.uneven]
        own = [row for row in own if row.quantity in PLACES and row.kind == "total"]
        places = tuple(size for row in own for size in (row.maximum, row.rms, row.final))
        if places and places in seen:
            texts.append(f"finer run: requested {at}, the places are those of {seen[places]}")
        seen.setdefault(places, at)
        summed_rad = errors.of_scene.summed_rad
        finer = _at_step(replace(errors, rows=tuple(own)), number, summed_rad)
        near = too_good(finer, "integrated", order)
        if near and number > 1:
            texts.append(
                f"finer run: at {at} {near[0].quantity} of {near[0].body} is off by "
                f"{near[0].maximum:.2g} {near[0].unit}, which no step of that size allows"
            )
    return texts


def _rounding(drive: Error | None, exact: float, least: float) -> float:
    """Return the position error that rounding explains, ``least`` or more: of a set crank, at most
    ``exact``."""
    of_crank = drive.pure if drive is not None and drive.pure <= exact else 0.0
    return max(least, BEHIND_DRIVE * of_crank)


def worst_place(errors: Errors) -> Error | None:
    """Return the largest total error of angle, displacement or position, as pure numbers; where
    links bend, that of the deflection against the exact chain."""
    groups = (_largest_total(errors.rows, names) for names in errors.of_links.followed)
    return next((worst for worst in groups if worst), None)


def _largest_total(rows: Iterable[Error], quantities: Collection[str]) -> Error | None:
    return largest(row for row in rows if row.quantity in quantities and row.kind == "total")
