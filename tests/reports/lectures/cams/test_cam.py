"""`crankcheck cam`: designs of tasks, files of the profile, drawings, and what is refused."""

import json
import math
import re
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree as Xml

import numpy as np
import pytest

from models.lectures.shipped_tables import shipped_in
from models.lectures.tasks import TASKS
from models.lectures.tasks.cams import load_cam_task
from reports.lectures.cams.cam_drawings import draw_cam
from reports.lectures.cams.cam_request import designed
from reports.lectures.drawing.sheets.paper import Paper
from tests.worlds.command_line import crank, flat, refused, told
from tests.worlds.tiers import few
from tests.worlds.without_pdf import without_pdf

SHIPPED = shipped_in(TASKS / "cam")
ROLLER = SHIPPED["valve-roller"].read_text(encoding="utf-8")
FLAT = SHIPPED["flat-tappet"].read_text(encoding="utf-8")
SHARP = ROLLER.replace("= 120.0", "= @").replace("= 60.0", "= 120.0").replace("@", "60.0")
"""Rise and return over 60 deg."""
SHEETS = ("cam", "diagrams", "checks")


def written(folder: Path, text: str) -> Path:
    path = folder / "task.toml"
    path.write_text(text, encoding="utf-8")
    return path


def test_tasks_are_listed_and_their_numbers_are_those_of_closed_forms() -> None:
    assert set(SHIPPED) <= set(flat(told("cam")).split())
    found = json.loads(told("cam flat-tappet --json"))["numbers"]
    # Harmonic, 90 deg: s + s'' is least at the top, h - 2 h; with 8 mm to spare.
    assert found["base_radius_m"] == pytest.approx(0.012 + 0.008, rel=1e-12)
    assert found["convex_radius_m"] == pytest.approx(0.008, rel=1e-9)
    # There the spring holds 40 + 72 N, and s'' is 2 h: omega*^2 = 112 / (0.15 * 0.024).
    assert found["lift_off_rad_s"] == pytest.approx(math.sqrt(112 / (0.15 * 0.024)), rel=1e-12)
    # C_v = pi/2 of the harmonic law, at 60 rad/s over pi/2.
    assert found["peak_velocity_m_s"] == pytest.approx(0.012 * 60.0, rel=1e-12)
    assert found["peak_jerk_m_s3"] == "infinite"
    found = json.loads(told("cam rocker-arm --json"))["numbers"]
    assert found["pressure_rise_deg"] == pytest.approx(35.0, rel=1e-9)


def test_tables_name_jumps_peaks_and_limits(tmp_path: Path) -> None:
    said = flat(told("cam valve-roller"))
    assert "jerk jumps, all before it is continuous" in said
    assert "within all limits" in said
    assert "4.88812 61.426" in said
    text = ROLLER.replace("speed_rad_s = 10.0", "speed_rad_s = 70.0").replace("3-4-5", "harmonic")
    said = flat(told("cam", written(tmp_path, text.replace("= 30.0", "= 12.0")), code=1))
    assert "pressure angle of the rise" in said
    assert "acceleration jumps" in said
    assert re.search(r"the follower leaves at 5\d\.\d+ rad/s, and the cam turns with 70", said)


@pytest.mark.parametrize("name", few(SHIPPED, ["valve-roller"], "two seconds each"))
def test_files_hold_the_profile_and_sheets_are_drawn(name: str, tmp_path: Path) -> None:
    with without_pdf():
        told("cam --points 720", name, "-o", tmp_path)
    heads, *lines = (tmp_path / "profile.csv").read_text(encoding="utf-8").splitlines()
    rows = np.array([[float(x) for x in line.split(",")] for line in lines])
    assert rows.shape == (720, len(heads.split(",")))
    points = rows[:, 1:3]
    base = json.loads((tmp_path / "cam.json").read_text(encoding="utf-8"))["numbers"][
        "base_radius_m"
    ]
    assert np.hypot(*points.T).min() == pytest.approx(base, rel=1e-9)
    dxf = (tmp_path / "profile.dxf").read_text(encoding="utf-8").split("\n")
    pairs = list(zip(map(int, dxf[:-1:2]), dxf[1::2], strict=True))
    on = [float(value) for code, value in pairs if code in (10, 20)][: 2 * 720]
    assert np.allclose(np.reshape(on, (-1, 2)), 1e3 * points, rtol=0, atol=1e-8)
    assert pairs[0] == (0, "SECTION")
    assert pairs[-1] == (0, "EOF")
    svg = Xml.fromstring((tmp_path / "profile.svg").read_text(encoding="utf-8"))
    drawn = svg.find("{http://www.w3.org/2000/svg}polygon[@id='profile']")
    assert drawn is not None
    places = np.array([p.split(",") for p in drawn.attrib["points"].split()], dtype=float)
    assert np.allclose(places * (1.0, -1.0), 1e3 * points, rtol=0, atol=1e-5)
    assert svg.attrib["width"] == f"{svg.attrib['viewBox'].split()[2]}mm"
    for sheet in SHEETS:
        Xml.fromstring((tmp_path / f"{sheet}.svg").read_text(encoding="utf-8"))
        assert (tmp_path / f"{sheet}.pdf").read_bytes().startswith(b"%PDF")


def test_the_profile_has_the_contact_force_as_its_colour() -> None:
    task, _ = load_cam_task("valve-roller")
    found = designed(task)
    cam, load = found.cam, found.load
    assert load is not None
    sheet = draw_cam("valve-roller", "", found, {}, Paper.of("A4"))
    (curve,) = (each for axes in sheet.layers for each in axes.collections)
    forces = curve.get_array()
    assert forces is not None
    phi, step = math.radians(20.0), 1e-4  # in the rise; 1441 places of a turn, a quarter degree
    before, lift, after = (cam.law.at_one(phi + by)[0] for by in (-step, 0.0, step))
    rate, bend = (after - before) / (2 * step), (after - 2 * lift + before) / step**2
    high = cam.base_m + cam.follower.roller_m + lift
    along = load.inertia * bend * task.speed_rad_s**2 + load.stiffness * lift
    along += load.preload + load.weight  # which presses on the cam
    assert forces[80] == pytest.approx(along * math.hypot(1.0, rate / high), rel=1e-6)
    free = draw_cam("valve-roller", "", replace(found, load=None), {}, Paper.of("A4"))
    (curve,) = (each for axes in free.layers for each in axes.collections)
    alpha = math.degrees(math.atan2(rate, high))
    assert curve.get_array()[80] == pytest.approx(alpha, rel=1e-6)


def test_faulty_tasks_are_refused_in_one_message(tmp_path: Path) -> None:
    for old, new, said in (
        ("lift_m = -0.02", "lift_m = -0.019", "does not close: after a turn its lift is 0.001"),
        ("span_deg = 60.0", "span_deg = 150.0", "540 deg, 180 over 360"),
        ("radius_m = 0.04\n", "radius_m = 0.005\n", "from a base radius of"),
        ("roller_m = 0.01", "roller_m = 0.3", "the roller's 0.3 m; from a base radius of"),
        ("roller_m = 0.01", "roller_m = 0.01\narm_m = 0.1", "arm_m: a translating follower"),
        ("roller_m = 0.01", "", "a radius above 0"),
        ("roller_m = 0.01", "roller_m = 0.01\noffset_m = 0.06", "give a smaller offset"),
        ("3-4-5", "trapezoid", "no kind of motion 'trapezoid'"),
        ("3-4-5", "uniform", "where only a knife edge follows"),
        ("preload = 10.0", "preload = -10.0", "give a preload above"),
        ("[base]\nradius_m = 0.04\npressure_deg = 30.0", "[base]", "give radius_m, pressure_deg"),
        ("pressure_deg", "return_pressure_deg", "give pressure_deg of the rise"),
    ):
        assert old in ROLLER
        text = SHARP if "from a base" in said else ROLLER
        refused(crank("cam", written(tmp_path, text.replace(old, new))), said)
    refused(crank("cam", "valve-rolle"), "valve-roller")


def test_shipped_tasks_say_where_they_are_from() -> None:
    for name in SHIPPED:
        task, path = load_cam_task(name)
        assert task.name == name == path.stem
        assert task.source
