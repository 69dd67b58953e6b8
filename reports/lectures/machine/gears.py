"""`crankcheck gears`: ratios, speeds, torques and teeth of the gear train of a scene."""

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np
from rich.console import Console

from analytic.gears.assembly import check_planets, planet_stages
from analytic.gears.involute import TeethPair
from analytic.gears.torques import MeshLoad, TrainTorques, torques
from analytic.gears.trains import ElementaryTrain, Train, elementary_trains
from models.errors import CrankcheckError, few, shown
from models.files.reading import load_scene
from models.scene import Scene
from models.scene.characteristics import Constant
from reports.output.console import say, say_each, say_whole, show_rows
from reports.requests.options import SceneName, option

COLUMNS = {
    "members": "body speed_rad_s ratio torque_n_m power_w",
    "elementary_trains": "carrier gears basic_ratio of to",
    "meshes": "gear tangential_n radial_n rolling_w loss_w module_mm pressure_angle_deg",
    "teeth": "gear teeth pitch_mm base_mm tip_mm root_mm thickness_mm contact_ratio",
    "planets": "planet numbers",
}
"""Columns of the tables by name."""
Rows = Iterable[tuple[object, ...]]


@dataclass(frozen=True)
class GearsRequest:
    """Arguments of `gears`, as given."""

    scene: SceneName
    speed: Annotated[
        Sequence[str],
        option("Speed of a body; repeatable (default: the driver's).", "BODY=RAD_S"),
    ] = ()
    torque: Annotated[
        Sequence[str],
        option("Torque on a body; repeatable (default: constant ones of the scene).", "BODY=N_M"),
    ] = ()
    shift: Annotated[
        Sequence[str],
        option("Profile shift of a body's teeth, in modules; repeatable.", "BODY=X"),
    ] = ()
    planets: Annotated[
        int | None, option("Check that so many equal planets can be assembled.", min=1)
    ] = None
    json: Annotated[bool, "Print JSON, not tables."] = False

    def run(self, console: Console, progress: Console) -> int:
        """Show the train. Raises CrankcheckError for a faulty request or train."""
        scene = load_scene(self.scene)
        document = _document(scene, self)
        if self.json:
            say_whole(console, json.dumps(document, indent=1))
            return 0
        kept, mobility = document["efficiency"], document["mobility"]
        share = "" if kept is None else f", efficiency {kept:.6g}"
        say(console, f"{scene.name}: gear train of mobility {mobility}{share}")
        for key, columns in COLUMNS.items():
            if document[key]:
                show_rows(console, document[key], columns.split())
        say_each(console, document["notes"])
        return 0


def _document(scene: Scene, request: GearsRequest) -> dict[str, Any]:
    """The whole answer, as JSON has it."""
    if not scene.gears:
        raise CrankcheckError(f"{scene.name}: no gears; give the scene a [gears.NAME] table")
    train = Train(tuple(scene.gears.values()))
    stages = planet_stages(train.gears, scene.points_of)
    check_planets(stages)
    if request.planets is not None:
        if not stages:
            raise CrankcheckError("--planets: no planet of the scene meshes with two central gears")
        for stage in stages:
            stage.check(request.planets)
    pairs = _pairs(scene, request.shift)
    inputs = _inputs(scene, train, _values(request.speed, "--speed", train.bodies))
    given = _values(request.torque, "--torque", train.bodies)
    loads = given or _constant_loads(scene, train, inputs)
    found = torques(train, inputs, loads)
    source = next((body for body, speed in inputs.items() if speed), next(iter(inputs)))
    ratios = train.influence((source, *(body for body in inputs if body != source)))
    members = (
        (body, speed, str(ratios[body][0]), found.torques_n_m[body], found.powers_w[body])
        for body, speed in found.speeds_rad_s.items()
    )
    return {
        "scene": scene.name,
        "mobility": train.mobility,
        "inputs_rad_s": inputs,
        "ratio_to": source,
        "efficiency": found.efficiency if loads else None,
        **_table("members", members),
        **_table("elementary_trains", map(_basic_ratio, elementary_trains(train.gears))),
        **_table("meshes", (_mesh(scene, mesh) for mesh in found.meshes if loads)),
        **_table("teeth", (row for pair in pairs for row in _teeth(pair))),
        **_table("planets", ((stage.planet, stage.counts) for stage in stages)),
        "notes": _notes(train, found, source, bool(loads), request.planets),
    }


def _table(name: str, rows: Rows) -> dict[str, list[dict[str, object]]]:
    """Return a table by its name, its rows by column."""
    return {name: [dict(zip(COLUMNS[name].split(), row, strict=True)) for row in rows]}


def _values(texts: Sequence[str], name: str, bodies: Sequence[str]) -> dict[str, float]:
    """Parse BODY=NUMBER. Raises CrankcheckError for other text, a body twice or unknown."""
    found: dict[str, float] = {}
    for text in texts:
        body, equals, number = text.partition("=")
        try:
            value = float(number)
        except ValueError:
            value = math.nan
        if not equals or not math.isfinite(value):
            raise CrankcheckError(f"{name} {shown(text)}: give BODY=NUMBER, such as {bodies[0]}=10")
        if body not in bodies:
            raise CrankcheckError(f"{name} {shown(text)}: no such body; use {few(bodies, 12)}")
        if body in found:
            raise CrankcheckError(f"{name} {shown(text)}: {body} is given twice; give it once")
        found[body] = value
    return found


def _inputs(scene: Scene, train: Train, given: dict[str, float]) -> dict[str, float]:
    """Add the driver's speed, where one is missing: that of its law at time 0, else its largest."""
    driver = scene.driver
    turns = driver.is_crank and driver.link in train.bodies and driver.link not in given
    if turns and len(given) < train.mobility:
        start = float(driver.law.at(np.zeros(1))[1][0])
        return {driver.link: start or driver.law.peak_speed_rad_s or 1.0, **given}
    return given


def _constant_loads(scene: Scene, train: Train, inputs: Mapping[str, float]) -> dict[str, float]:
    """Sum constant torques of the scene by body; the inputs close the balance."""
    found: dict[str, float] = {}
    for load in scene.loads.values():
        plain = load.point is None and isinstance(load.characteristic, Constant)
        if plain and load.body in train.bodies and load.body not in inputs:
            size = float(load.magnitude(np.zeros(1))[0])
            found[load.body] = found.get(load.body, 0.0) + size
    return found


def _pairs(scene: Scene, shift: Sequence[str]) -> list[TeethPair]:
    """Check and return the teeth of pairs that have a module. Raises CrankcheckError."""
    toothed = [gear for gear in scene.gears.values() if gear.module_m is not None]
    bodies = list(dict.fromkeys(body for gear in toothed for body in gear.bodies))
    if shift and not bodies:
        raise CrankcheckError("--shift: no gears of the scene have a module; give module_m")
    shifts = _values(shift, "--shift", bodies)
    pairs = []
    for gear in toothed:
        first, second = (shifts.get(body, 0.0) for body in gear.bodies)
        pairs.append(TeethPair(gear, gear.module_m or 0.0, (first, second)))
        pairs[-1].check(gear.distance_m(scene.points_of))
    return pairs


def _basic_ratio(train: ElementaryTrain) -> tuple[object, ...]:
    """Return the ratio of the last gear to the first, with the carrier at rest."""
    first, *_, last = train.values
    return train.carrier, list(train.gears), str(train.values[last]), last, first


def _teeth(pair: TeethPair) -> Rows:
    radii = pair.pitch_radii_m, pair.base_radii_m, pair.tip_radii_m, pair.root_radii_m
    sizes = 1e3 * np.array([*(2.0 * each for each in radii), pair.thicknesses_m])
    for body, teeth, own in zip(pair.pair.bodies, pair.pair.teeth, sizes.T.tolist(), strict=True):
        yield f"{pair.pair.name}: {body}", teeth, *own, pair.contact_ratio


def _mesh(scene: Scene, mesh: MeshLoad) -> tuple[object, ...]:
    powers, module = (mesh.rolling_w, mesh.loss_w), mesh.gear.module(scene.points_of)
    if module is None:
        return mesh.gear.name, None, None, *powers, None, None
    force, angle = mesh.tangential_n(module), mesh.gear.pressure_angle_rad
    forces = force, force * math.tan(angle)
    return mesh.gear.name, *forces, *powers, 1e3 * module, math.degrees(angle)


def _notes(
    train: Train, found: TrainTorques, source: str, loaded: bool, planets: int | None
) -> list[str]:
    notes = [f"ratios are those to {source}, other inputs at rest"] * (train.mobility > 1)
    if train.passive:
        notes.append(f"{train.passive} relations are passive: equal planets share their loads")
    if not loaded:
        notes.append("no torques: give --torque BODY=N_M; the inputs close the balance")
    for name, times in found.circulating.items():
        notes.append(f"power circulates: {times:.4g} times the input power rolls through {name}")
    if planets is not None and planets > 1:  # the scene's one planet stands for them
        notes.append(f"{planets} planets share the loads of each mesh that is listed for one")
    return notes
