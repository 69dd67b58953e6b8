"""`sensitivity`, and derivatives in Python: effects of lengths on the motion over a turn."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, cast

import numpy as np
from numpy.typing import ArrayLike
from rich.console import Console

from analytic.gradients.dimensions import dimensions
from analytic.gradients.gradient import Gradient
from analytic.gradients.gradient import gradient as gradient_of
from models.array import Array
from models.errors import CrankcheckError
from models.files.reading import find_scene, load_scene
from models.scene.driver import driver_axis, driver_shown
from reports.figures.layout import DOTS_PER_IN
from reports.lectures.machine.effects import SAMPLES, Effects, effects, period_of
from reports.output.console import grid, say
from reports.output.formats import ENDINGS, json_text, write_frame
from reports.output.numbers import readable
from reports.output.write import check_file, write
from reports.requests.arguments import SceneLike, is_true, scene_of, told_at_the_call
from reports.requests.options import SceneName, given, option, output_option
from reports.requests.shown import Shown
from reports.workers.progress import progress_bar

if TYPE_CHECKING:
    import pandas as pd

OF_EFFECTS = "tolerance_mm", "tolerance_deg"
OF_ENGINES = "profiles", "steps", "steps_per_turn", "start_deg", "order", "runs"
"""Fields that apply to effects alone, and to engines alone."""
PICTURES = tuple(f".{kind}" for kind in DOTS_PER_IN)


@dataclass(frozen=True, eq=False, repr=False)
class SceneGradient(Shown, Gradient):
    """Derivatives of a motion by dimensions, and of its forces by masses (`gradient`).

    ``by["crank"].links["rocker"].theta`` is that of the rocker's angle by the length of the crank
    [rad/m], (T,); ``by["crank"].bound`` bounds its error in the same place.
    """

    def frame(self) -> pd.DataFrame:
        """Table with a row for each dimension and sample; units are over that of the dimension."""
        import pandas as pd

        from reports.describe.free_motion import motion_frame

        known = dimensions(self.scene)
        parts = []
        for name, motion in self.by.items():
            one = motion_frame(motion, lengths=False)
            one.insert(0, "by", name)
            one.insert(1, "over", known[name].unit)
            parts.append(one)
        return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame()

    def show(self, console: Console) -> None:
        say(console, f"{self.scene.name}: largest derivatives in {self.time_s.size} samples")
        rows = []
        for kind, field, unit in (("links", "theta", "rad"), ("sliders", "displacement", "m")):
            for name in getattr(self.motion, kind):
                each = (getattr(m, kind)[name] for m in self.by.values())
                sizes = [readable(float(np.abs(vars(one)[field]).max())) for one in each]
                rows.append([f"{name}, {unit}", *sizes])
        known = dimensions(self.scene)
        heads = ("of", *(f"by {name}, {known[name].unit}:" for name in self.by))
        console.print(grid(heads, rows, wraps=True))


@told_at_the_call
def gradient(
    scene: SceneLike,
    time_s: ArrayLike | None = None,
    by: str | Iterable[str] | None = None,
    *,
    forces: bool = False,
) -> SceneGradient:
    """Differentiate the motion of a scene by its lengths and angles, in closed form.

    Parameters
    ----------
    scene : Scene, str or path
        A shipped name, the path of a scene file, or a scene.
    time_s : ArrayLike or None
        Times [s], shape (T,), in any order; 361 over a period of the driver for None.
    by : str, Iterable[str] or None
        Dimensions (``crank``, ``coupler.E.x``, ``C.offset``, ``driver.angle``), masses and inertias
        (``rocker.mass``); None is all dimensions.
    forces : bool
        Differentiate torque and reactions by all masses and inertias as well.

    Raises
    ------
    CrankcheckError
        As `solve`; an unknown name; by masses, Coulomb's friction.
    """
    scene = scene_of(scene)
    times = cast(Array, period_of(scene) if time_s is None else time_s)
    return SceneGradient(**vars(gradient_of(scene, times, by, forces=is_true(forces, "forces"))))


@dataclass(frozen=True)
class SensitivityRequest:
    """Arguments of `sensitivity`, as given."""

    scene: SceneName
    of: Annotated[str, option("A link, a slider or a point; default: the follower.", "NAME")] = ""
    by: Annotated[
        Sequence[str], option("A dimension, such as crank; repeatable (default all).", "LENGTH")
    ] = ()
    tolerance_mm: Annotated[float, option("Tolerance of lengths.", "MM")] = 0.1
    tolerance_deg: Annotated[float, option("Tolerance of angles.", "DEG")] = 0.1
    engines: Annotated[
        Sequence[str], option("Compare an engine's derivatives; repeatable, or all.", "--engine")
    ] = ()
    profiles: Annotated[
        Sequence[str], option("Profile of the engines; repeatable (default tuned).", "--profile")
    ] = ()
    steps: Annotated[str, option("Steps after which engines are compared.", "K,K")] = "1,10,100"
    steps_per_turn: Annotated[float, option("Steps of engines in a turn.", min=24, max=1e6)] = 720.0
    start_deg: Annotated[
        float | None, option("Angle of the driver at the start of engines.", "DEG")
    ] = None
    order: Annotated[bool, "With engines, halve the step as well: the order of the error."] = False
    runs: Annotated[bool, "With engines, difference whole runs beside their own method."] = False
    json: Annotated[bool, "As JSON, not as a table."] = False
    output: Annotated[
        Path | None,
        output_option(
            "Draw the curves (.svg, .pdf, .png), or write .csv, .parquet or .xlsx; with engines, a "
            "page (.html)."
        ),
    ] = None

    def run(self, console: Console, progress: Console) -> int:
        """Show or draw effects, or engines' derivatives; return 1 where one of these is out of
        tolerance, else 0. Raises CrankcheckError for a faulty request."""
        for name, value in (("mm", self.tolerance_mm), ("deg", self.tolerance_deg)):
            if not 0.0 < value < math.inf:
                raise CrankcheckError(f"--tolerance-{name}: found {value:g}; give one above 0")
        kinds = (".html",) if self.engines else (*PICTURES, *ENDINGS)
        check_file(self.output, "-o", kinds, inputs=[find_scene(self.scene)])
        for each in given(self, *(OF_EFFECTS if self.engines else OF_ENGINES)):
            cure = "leave it out with --engine" if self.engines else "name an --engine"
            raise CrankcheckError(f"{each}: {cure}")
        if self.engines:
            return self._compare(console, progress)
        tolerances = 1e-3 * self.tolerance_mm, math.radians(self.tolerance_deg)
        found = effects(load_scene(self.scene), self.of, self.by, *tolerances)
        if self.output is not None:
            _write(found, self.output)
        if self.json:
            facts = {"scene": found.gradient.scene.name, "of": found.of, "unit": found.unit}
            rows = {"dimensions": found.rows(), "locked": list(found.gradient.locked)}
            console.file.write(json_text({**facts, **rows}))
        elif self.output is not None:
            say(console, f"{self.output}: effects on {found.of} of {found.gradient.scene.name}")
        else:
            show_effects(console, found)
        return 0

    def _compare(self, console: Console, progress: Console) -> int:
        """Show and write derivatives of engines beside those of the reference."""
        from reports.lectures.machine import gradient_table as table  # with the engines
        from reports.lectures.machine.engine_gradients import EngineGradient, engine_gradients
        from reports.lectures.machine.gradient_page import gradient_page

        scene, manner = load_scene(self.scene), (self.steps, self.steps_per_turn, self.start_deg)
        question = table.asked(scene, self.of, self.by, *manner)
        choices, found = table.chosen(self.engines, self.profiles), list[EngineGradient]()
        with progress_bar(progress, "engines", len(choices)) as advance:
            for name, profile in choices:
                how = {"with_order": self.order, "with_runs": self.runs}
                found += engine_gradients(question, name, profile, **how)
                advance()
        if all(one.slopes is None for one in found):
            reasons = dict.fromkeys(f"{one.label}: {one.refusal}" for one in found)
            raise CrankcheckError(f"{scene.name}: no derivatives: {'; '.join(reasons)}")
        if self.output is not None:
            write(self.output, gradient_page(question, found))
        if self.json:
            console.file.write(json_text(table.document(question, found)))
        else:
            table.show(console, question, found)
            if self.output is not None:
                say(console, f"{self.output}: gradients of {scene.name}")
        return int(not all(one.within for one in found))


def _write(found: Effects, path: Path) -> None:
    if (ending := path.suffix.lower()) in PICTURES:
        from reports.lectures.machine.sensitivity_figure import effects_picture

        write(path, effects_picture(found, ending[1:]))
    else:
        import pandas as pd

        scene, motion = found.gradient.scene, found.gradient.motion
        driven = driver_axis(scene).rpartition(" [")[2][:-1]
        columns = {f"driver_{driven}": driver_shown(scene, motion), "time_s": motion.time_s}
        for one, series in zip(found.dimensions, found.slopes, strict=True):
            units = f"{'rad' if found.turns else 'm'}_per_{one.unit}"
            columns[f"{found.of}_by_{one.name}_{units}"] = series
        origin = {"scene": scene.name, "source": scene.source}
        write_frame(path, pd.DataFrame(columns), "effects", origin)


def show_effects(console: Console, found: Effects) -> None:
    """Print the effects by size, the largest first."""
    scene, rows = found.gradient.scene, found.rows()
    what = "angle" if found.turns else "place"
    say(console, f"{scene.name}: what dimensions do to the {what} of {found.of} over a turn\n")
    heads = ("dimension", "value:", "tolerance:", f"largest {found.unit}:", "where", "rms:", "1 %:")
    cells = [
        [
            row["dimension"],
            *(f"{row[k]:.6g} {row['unit']}" for k in ("value", "tolerance")),
            readable(row["largest"]),
            row["at"],
            readable(row["rms"]),
            "" if row["of_1_percent"] is None else readable(row["of_1_percent"]),
        ]
        for row in rows
    ]
    console.print(grid(heads, cells, whole=("dimension", "where")))
    say(console, "")
    shown = {row["dimension"] for row in rows}
    if none := [one.name for one in found.dimensions if one.name not in shown]:
        say(console, f"No effect: {', '.join(none)}.")
    lengths = [not one.name.startswith("driver.") for one in found.dimensions]
    size = np.abs(found.at_tolerance[lengths])
    worst = float(np.nanmax(size.sum(axis=0), initial=0.0))
    usual = float(np.nanmax(np.sqrt((size**2).sum(axis=0)), initial=0.0))
    say(
        console,
        f"All but the driver at once: {readable(worst)} {found.unit} at worst, "
        f"{readable(usual)} {found.unit} as the root of the sum of squares.",
    )
    if scene.elastic:
        say(console, "Elastic links are taken as rigid.")
    if lost := int(np.isnan(found.slopes).any(axis=0).sum()):
        say(console, f"{lost} of {SAMPLES} samples stand where nothing is certain: left out.")
    if locked := found.gradient.locked:
        say(console, f"Redundant links fit at one value alone of {', '.join(locked)}.")
