"""A stranger's log of a linkage that is right is within 1e-3 rad, or of a length, in whatever dress
it comes. The stranger's own solution is a second opinion: it shares no line with ours, and agrees.
Of a log whose names say nothing, the map that is written is a form, and filled in it reads it; and
a fault is told with its channels."""

import ast
import json
import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import crankcheck
from analytic.kinematics import solve
from models.array import Array
from models.files.reading import load_scene
from reports.logs.map_file import read_map
from tests.reports.own_log.conftest import Judge
from tests.worlds import stranger
from tests.worlds.fuzzing import ACTING
from tests.worlds.stranger import FOURBAR, LINKAGES, course
from tests.worlds.stranger_guises import COLUMNS, GERMAN, GUISES, PER_TURN, SHORT, disguised
from tests.worlds.stranger_log import DEG, Dress, even, logged, map_text, single, uneven
from tests.worlds.tiers import few, slowly

PLAIN = "fourbar-lecture-1"
TURN = logged(FOURBAR, even(FOURBAR, 1.0, PER_TURN), SHORT)


@pytest.mark.parametrize("name", GUISES)
def test_a_healthy_log_is_within_in_every_guise(name: str, judge: Judge) -> None:
    guise = GUISES[name]
    text = guise.dress.text(guise.log(FOURBAR))
    judge(PLAIN, text, mapped=guise.map(FOURBAR), name=guise.name)


@pytest.mark.parametrize("scene", LINKAGES)
def test_a_healthy_log_is_within_in_all_guises_at_once(scene: str, judge: Judge) -> None:
    guise, linkage = disguised(scene), LINKAGES[scene]
    dress = replace(GERMAN, comments=("# made by nobody",), digits=12)
    file = 'decimal = ","\nseparator = ";"'
    mapped = map_text(linkage, guise.columns, guise.clock, file)
    judge(scene, dress.text(guise.log(linkage)), mapped=mapped)


@pytest.mark.parametrize("scene", few(LINKAGES, [PLAIN], "healthy in all guises above"))
def test_the_plain_log_of_every_linkage_is_within(scene: str, judge: Judge) -> None:
    linkage = LINKAGES[scene]
    log = logged(linkage, even(linkage, 1.5, PER_TURN), COLUMNS[scene])
    for target in (("--step", "0.001"), ("--target", "1e-6")):
        assert "WITHIN TOLERANCE" in judge(scene, Dress().text(log), target=target).stdout


@pytest.mark.parametrize("ending", ["parquet", "xlsx"])
def test_single_precision_is_within_what_it_keeps(
    ending: str, judge: Judge, tmp_path: Path
) -> None:
    path, frame = tmp_path / f"log.{ending}", pd.DataFrame(single(GUISES["dots"].log(FOURBAR)))
    frame.to_parquet(path) if ending == "parquet" else frame.to_excel(path, index=False)
    judge(PLAIN, path, target=("--target", "1e-4"))


def test_what_is_not_of_the_scene_is_left_out_and_listed(judge: Judge) -> None:
    lines = Dress().text(TURN).decode().splitlines()
    more = [f"{line},ok,,torque {n}\n" for n, line in enumerate(lines)]
    more[0] = f"{lines[0]},state,empty,motor current [A]\n"
    told = judge(PLAIN, "".join(more).encode()).stdout
    assert all(column in told for column in ("state", "empty", "motor current [A]"))


def test_another_speed_and_start_are_fitted(judge: Judge) -> None:
    scene, linkage = "slider-crank-central", LINKAGES["slider-crank-central"]
    moved = replace(linkage, speed_rad_s=9.3, start_deg=linkage.start_deg + 2.0)
    log = Dress().text(logged(moved, uneven(moved, 1.0, PER_TURN), COLUMNS[scene]))
    assert "9.3" in judge(scene, log, "--drive", "fitted").stdout


def test_a_log_that_begins_late_in_a_later_turn_is_the_same(judge: Judge) -> None:
    time_s = 4.0 + even(FOURBAR, 1.0, PER_TURN) / 3.0
    judge(PLAIN, Dress().text(logged(FOURBAR, time_s, SHORT)))


@pytest.mark.parametrize("name", ["units in brackets", "decimal commas", "names that say nothing"])
def test_the_written_map_reads_the_log_alike(name: str, judge: Judge, tmp_path: Path) -> None:
    guise = GUISES[name]
    text, mapped = guise.dress.text(guise.log(FOURBAR, 1.0)), guise.map(FOURBAR)
    written, first, again = (tmp_path / each for each in ("written.toml", "1.json", "2.json"))
    judge(PLAIN, text, "--write-map", written, mapped=mapped)
    judge(PLAIN, text, "--json", first, mapped=mapped)
    judge(PLAIN, text, "--map", written, "--json", again)
    one, other = (json.loads(each.read_text(encoding="utf-8"))["errors"] for each in (first, again))
    assert one == other


GERMAN_ROWS = Dress(";", ",", digits=9).text(TURN)
PLAIN_ROWS = Dress(digits=9).text(TURN).splitlines(keepends=True)
UNREADABLE: dict[str, bytes] = {
    "commas": GERMAN_ROWS,
    "commas below whole numbers": Dress(";", ",", digits=9).text(
        {name: TURN[name] for name in ("time_s", "crank_deg")}
    ),
    "tabs that line up": b"".join(PLAIN_ROWS).replace(b",", b"\t\t"),
    "a clock": Dress(";", ",").text({**TURN, "time_s": TURN["time_s"] + 1.7e9}),
    "a hole": b"".join([*PLAIN_ROWS[:20], *PLAIN_ROWS[23:]]),
    "sheet": b"",
}


@pytest.mark.parametrize("case", few(UNREADABLE, [*UNREADABLE][::2], "unreadable otherwise"))
def test_a_map_is_written_of_a_log_that_is_not_read_without_one(
    case: str, judge: Judge, tmp_path: Path
) -> None:
    log: bytes | Path = UNREADABLE[case]
    if case == "sheet":
        log = tmp_path / "log.xlsx"
        with pd.ExcelWriter(log) as book:
            for name in ("cover", "notes"):
                pd.DataFrame([["of", None], [None, "today"]]).to_excel(book, sheet_name=name)
            frame = pd.DataFrame(TURN).map(lambda x: f"{x:.9f}".replace(".", ","))
            frame.to_excel(book, sheet_name="it", index=False)
    written = tmp_path / "written.toml"
    judge(PLAIN, log, code=2)
    judge(PLAIN, log, "--write-map", written)
    judge(PLAIN, log, "--map", written)


def test_the_map_that_is_written_ignores_what_a_map_ignores(judge: Judge, tmp_path: Path) -> None:
    text = Dress().text({**TURN, "rocker.theta_rad": TURN["rocker_deg"]})
    written = tmp_path / "written.toml"
    mapped = '[[channel]]\ncolumn = "rocker.theta_rad"\nignore = true'
    judge(PLAIN, text, "--write-map", written, mapped=mapped)
    judge(PLAIN, text, "--map", written)


def test_rates_half_a_sample_late_are_told_and_the_map_that_is_told_mends_it(
    judge: Judge, tmp_path: Path
) -> None:
    """Every other fault is planted in tests/reports/causes."""
    file, late_s = tmp_path / "judged.json", -FOURBAR.period_s / PER_TURN / 2.0
    columns = [
        replace(each, later_s=late_s) if each.what in ("omega", "vx", "vy") else each
        for each in COLUMNS[PLAIN]
    ]
    log = Dress().text(logged(FOURBAR, even(FOURBAR, 2.0, PER_TURN), columns))
    told = judge(PLAIN, log, "--json", file, code=1).stdout
    (cause,) = json.loads(file.read_text(encoding="utf-8"))["causes"]
    assert cause["text"][:40] in " ".join(told.split())
    assert "no known cause" not in told
    assert re.search(r"belong 0\.50 samples \(\S+ ms\) earlier", cause["text"])
    late = {column.header for column in columns if column.later_s}
    assert set(cause["columns"]) == late - {"crank_omega_rad_s"}  # which is constant
    mends = [f'[[channel]]\ncolumn = "{column}"\ndelay_s = {late_s!r}' for column in late]
    judge(PLAIN, log, mapped="\n".join(mends))


RED = "rocker \x1b[31m [deg] \u202e"


@pytest.mark.parametrize(
    "name",
    [
        "rocker_deg" * 1_000,
        slowly("rocker_deg" * 10_000, reason="a second: a name ten times as long"),
        RED,
        "=cmd|'/c'!A1 rocker",
        "\x1b[31m sad",
    ],
)
def test_a_strange_name_does_no_harm(name: str, judge: Judge) -> None:
    text = Dress(quoted=True).text({**TURN, name: TURN["rocker_deg"]})
    for format_ in ("text", "md"):
        code = 2 if "rocker" in name else 0
        harmless(judge(PLAIN, text, "--format", format_, code=code).output)


@pytest.mark.parametrize("name", ["rocker" + "_" * 90_000 + "deg", RED])
def test_nor_does_that_of_a_column_that_is_out(name: str, judge: Judge) -> None:
    log = logged(FOURBAR, even(FOURBAR, 1.0, PER_TURN), [replace(SHORT[1], per=-DEG)])
    text = Dress(quoted=True).text({"time_s": log["time_s"], name: log["rocker_deg"]})
    told = f"column = {json.dumps(name)}\nof = 'rocker'\nkind = 'angle'\nunit = 'deg'"
    mapped = f"[[channel]]\n{told}" if len(name) < 400 else ""
    for format_ in ("text", "md"):
        harmless(judge(PLAIN, text, "--format", format_, mapped=mapped, code=1).output)


def harmless(output: str) -> None:
    assert not ACTING.search(output)
    assert len(output) < 6000


CLOSE = 1e-8
"""Of an angle, a length or a velocity [SI]; accelerations are ten times those."""


def near(found: Array, ours: Array, off: float = CLOSE) -> None:
    np.testing.assert_allclose(found, ours, rtol=0.0, atol=off)


def test_it_imports_nothing_of_ours() -> None:
    tree = ast.parse(Path(stranger.__file__).read_text(encoding="utf-8"))
    each = list(ast.walk(tree))
    modules = [str(one.module) for one in each if isinstance(one, ast.ImportFrom)]
    modules += [name.name for one in each if isinstance(one, ast.Import) for name in one.names]
    ours = {"models", "analytic", "sim", "reports", "crankcheck", "tests"}
    assert "numpy.typing" in modules
    assert not ours & {name.split(".")[0] for name in modules}


@pytest.mark.parametrize("name", LINKAGES)
def test_it_moves_as_the_reference_does(name: str) -> None:
    linkage = LINKAGES[name]
    motion = course(linkage, uneven(linkage, samples_per_turn=90))
    reference = solve(load_scene(name), motion.time_s, bound=False)
    assert set(linkage.bars) == set(reference.links)
    for bar, link in reference.links.items():
        theta, omega, alpha = motion.angle(bar)
        off = theta - link.theta
        assert np.ptp(off) < CLOSE
        assert abs(math.remainder(off[0], math.tau)) < CLOSE
        near(omega, link.omega)
        near(alpha, link.alpha, 10.0 * CLOSE)
    for pin in set(reference.points) - set(linkage.ground):
        ours = reference.points[pin]
        position, velocity, acceleration = motion.point(pin)
        near(position, ours.position)
        near(velocity, ours.velocity)
        near(acceleration, ours.acceleration, 10.0 * CLOSE)


TIME_S = np.linspace(0.0, 0.6, 301)
ROCKER_DEG = np.degrees(solve(load_scene(PLAIN), TIME_S).links["rocker"].theta)
TIMES, THING = "the column of the times", "the body of at least one column"
FILLED = {"# of": 'of = "rocker"', "# kind": 'kind = "angle"', "# unit": 'unit = "deg"'}


def two(times: str, angle: str) -> bytes:
    rows = [f"{t!r},{a!r}" for t, a in zip(TIME_S.tolist(), ROCKER_DEG.tolist(), strict=True)]
    return "\n".join([f"{times},{angle}", *rows, ""]).encode()


def filled(form: str, times: str) -> str:
    """The form with the column of times, and the angle of the rocker for what is left."""
    form = form.replace(f'# column = "{times}"\n', f'column = "{times}"\n', 1)
    if THING in form:
        head, mark, rest = form.rpartition("# [[channel]]")
        rest = rest.replace("# column", "column")
        for key, line in FILLED.items():
            rest = rest.replace(f'{key} = ""', line)
        form = head + mark.removeprefix("# ") + rest
    return form


@pytest.mark.parametrize(
    ("times", "angle", "lacks"),
    [
        ("time_s", "sensor 3", [THING]),
        ("Uhr", "rocker_deg", [TIMES]),
        ("Uhr", "sensor 3", [TIMES, THING]),
        ("Uhr\\t", "the # '[3]'", [TIMES, THING]),
    ],
)
def test_the_map_of_names_that_say_nothing_is_a_form_that_reads_the_log(
    times: str, angle: str, lacks: list[str], judge: Judge, tmp_path: Path
) -> None:
    path, text = tmp_path / "form.toml", two(times, angle)
    told = " ".join(judge(PLAIN, text, "--write-map", path, target=()).stdout.split())
    form = path.read_text(encoding="utf-8")
    for one in (TIMES, THING):
        assert (one in told) == (one in form) == (one in lacks)
    read_map(path)
    judge(PLAIN, text, mapped=filled(form, times.replace("\\", "\\\\")))


def test_what_a_map_says_already_stays(judge: Judge, tmp_path: Path) -> None:
    path = tmp_path / "form.toml"
    told = '[[channel]]\ncolumn = "sensor 3"\nof = "rocker"\nkind = "angle"\nunit = "deg"\n'
    told += 'sign = -1\noffset = 0.5\nwrapped = true\nrelative_to = "coupler"'
    judge(PLAIN, two("Uhr", "sensor 3"), "--write-map", path, mapped=told)
    assert told in path.read_text()


@pytest.mark.parametrize(
    ("text", "mapped"),
    [
        (two("Uhr", "sensor 3"), '[[channel]]\ncolumn = "sensor 4"\nof = "rocker"'),
        (two("Uhr", "sensor 3"), '[time]\ncolumn = "Zet"'),
        (b"time_s,rocker_deg\n0,1\n0,2\n", ""),
        (b"", ""),
    ],
)
def test_other_faults_leave_no_form(text: bytes, mapped: str, judge: Judge, tmp_path: Path) -> None:
    judge(PLAIN, text, "--write-map", tmp_path / "form.toml", mapped=mapped, code=2)
    assert not (tmp_path / "form.toml").exists()


def test_in_python_the_cure_is_an_argument() -> None:
    with pytest.raises(crankcheck.CrankcheckError, match="in Python: the argument map"):
        crankcheck.judge(PLAIN, {"t": TIME_S, "sensor 3": ROCKER_DEG}, target=1e-3)
