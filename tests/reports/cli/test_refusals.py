"""What no command can be asked: each line is refused with exit code 2 and a message that names
place, fault and cure, before anything is written."""

import re
from collections.abc import Sequence
from pathlib import Path

import pytest

from models.files.assemble import scene_text
from models.files.reading import load_scene, shipped
from tests.analytic.dyads.test_redundant import parallelogram
from tests.worlds.command_line import crank_alone, refused
from tests.worlds.loading import massless

HERE = Path(__file__)
V, ONCE = "verify fourbar-lecture-1", "verify fourbar-lecture-1 --steps-per-turn 360 --turns 1"
PISTON, COUPLER = "slider-crank-by-piston", "fourbar-by-coupler"
FAMILY = "solve fourbar-lecture-1 --family BC=0.25,0.3 -o f.xlsx"
SHORT = "--steps-per-turn 90 --turns 1"
RECIPE = "recipe forces --engine mujoco"
GRAPH = "graph fourbar-lecture-1 --of rocker"
POLYGON = "polygon fourbar-lecture-1"
EXCESS = "stability grashof-excess --engine mujoco --profile tuned"
ADVISE = "advise --speed 10 --target 1e-3"
MISTAKES: dict[str, str | Sequence[str]] = {
    "verify fourbar-lectur-1": ["'fourbar-lectur-1'", "fourbar-lecture-1"],
    f"{V} --engine mujco": ["'mujco'", "did you mean mujoco"],
    f"{V} --drive belt": ["'belt'", "prescribed or servo"],
    f"{V} --tol angle:1e-4": ["--tol 'angle:1e-4'", "angle=1e-4"],
    f"{V} --dt nan": ["--dt nan", "above 0"],
    f"{V} --dt 0.1": ["--dt 0.1", "6.28 steps in a turn", "at least 8", "at most 0.07854 s"],
    f"{V} --turns 0.1": ["--turns 0.1: 72 steps of fourbar-lecture-1", "at least 80",
                         "take 0.111 turns or more"],
    f"{ONCE} -o . --csv verify.json": "--csv and -o: both name verify.json",
    f"{ONCE} --dt 1e-3": ["--dt and --steps-per-turn", "one of them"],
    f"{ONCE} -o {HERE}": ["-o", "is a file; name a folder"],
    "verify fourbar-swing --turns 2": "--turns: free motion has no turns; give --dt",
    "verify fourbar-swing --drive servo": "--drive servo: fourbar-swing is in free motion",
    f"{V} --duration 2": ["--duration: this option is for free motion", "--free"],
    f"{V} --tol phase=1": "--tol phase: it is for free motion",
    "verify fourbar-swing --tol drive=1": "--tol drive: it is for a drive",
    "verify fourbar-swing --tol reaction=1": "--tol reaction: forces are judged with --forces only",
    "verify fourbar-swing --dt 1": ["10 steps of fourbar-swing", "80 at least"],
    "verify --free slider-crank-self-locking": ["friction that grows", "remove it"],
    "verify slider-crank-self-locking --forces":
        "mujoco gets no such friction (friction.piston)",
    "sweep fourbar-lecture-1 --dt 1e-3 -o out": "--dt: this option is for free motion",
    "sweep fourbar-swing -o out": "a scene of free motion, whose driver follows no law",
    "sweep --free --dt 1;2 -o out": "--dt '1;2': write numbers with commas",
    "solve locks.toml --at-deg 180": ["180", "can stand at"],
    "solve tangent --at-deg 41": ["--at-deg 41", "swings from -40 to 40 deg"],
    "solve tangent --along P": ["--along P", "such as C:30"],
    "solve shaper --along Q:0": ["--along Q:0", "A, C, B, E, F"],
    "solve tangent --clockwise": ["--clockwise", "give --at-deg"],
    "solve tangent --at-deg 0 --turns 1": ["--at-deg 0 with --turns", "one of them"],
    "solve tangent --steps-per-turn 0": "--steps-per-turn 0",
    f"solve tangent --turns 1e300 --steps-per-turn 1{310 * '0'}": "samples; at most 1000000",
    "sensitivity shaper --of levr": ["--of levr", "did you mean lever"],
    "sensitivity shaper --by crnk": ["no dimension, mass or inertia crnk", "did you mean crank"],
    "sensitivity shaper --tolerance-mm 0": ["--tolerance-mm: found 0", "above 0"],
    "sensitivity shaper -o out.txt": ["-o out.txt", "'.txt'", ".svg, .pdf, .png, .csv"],
    "solve tangent -o out.txt": ["-o out.txt", "'.txt'", ".csv, .parquet, .xlsx"],
    "export fourbar-lecture-1 --close Q": ["close = Q", "not a pin that can close a loop"],
    "view tangent -o t.mp4": ["'.mp4'", ".gif, .png"],
    "view fourbar-elastic-pulse -o a.gif": "elastic",
    "view tangent --engine pymunk --magnify 1e30 -o a.gif": ["1e+30", "at most, or auto"],
    "solve flat.toml --forces --at-deg 180": ["crank at 180 deg", "dead point"],
    "solve slider-crank-self-locking --forces --at-deg 90":
        ["crank at 90 deg", "locks itself: friction in piston grows"],
    "sweep massless.toml --engine mujoco --forces -o out": "no link or slider has a mass",
    "solve massless.toml --forces": ["no link or slider has a mass", "mass_kg"],
    "solve pulsed.toml --forces --at-deg 90": ["loads.pulse follows time",
                                               "request a motion over time"],
    "solve shaper --figures figs": ["--figures", "give --forces"],
    "solve shaper --forces --figures figs --at-deg 90": ["--at-deg 90", "they belong to a turn"],
    "solve shaper -o out.html --at-deg 90": ["-o out.html", "leave out --at-deg"],
    "solve shaper --forces --figures flat.toml": "--figures",
    **{
        f"solve fourbar-swing {option}": f"leave {option.split()[0]} out, and give --duration"
        for option in ("--turns 2", "--along C:30")
    },
    "solve fourbar-swing --duration nan": "--duration nan: give seconds above 0",
    "solve fourbar-lecture-1 --duration 2":
        ["--duration 2: fourbar-lecture-1 is driven, not in free motion", '(law = "free")'],
    "view fourbar-swing --forces -o OUT.png": "free motion is drawn without forces",
    "solve fourbar-elastic --at-deg 90": "--at-deg: fourbar-elastic has elastic links (coupler)",
    "solve fourbar-elastic --modes 99": "--modes 99: at most 20",
    "solve fourbar-elastic --axial-modes 2": "--axial-modes 2: no elastic link of",
    "solve fourbar-elastic --steps-per-turn 9 -o OUT.html": "a page has its own samples",
    "solve fourbar-elastic-pulse --shape periodic": "driver of fourbar-elastic-pulse is in free "
                                                    "motion",
    "solve fourbar-lecture-1 --modes 3": "--modes: fourbar-lecture-1 has no elastic links",
    "solve law.toml --shape periodic": "is not periodic",
    f"solve {PISTON} --at-deg 30": "give its displacement by --at-m",
    "solve tangent --at-m 1": "give its angle by --at-deg",
    f"solve {PISTON} --at-m 0.3 --at-deg 1": "one place; give one",
    f"solve {PISTON} --at-m 0.45": "goes from 0.21 to 0.39 m",
    f"polygon {PISTON}": "a vector polygon needs a driver that is a link",
    f"centres {COUPLER}": "this scene's is pin B of crank and coupler",
    "centres triad-platform": "a group of class III about plate",
    f"flywheel {COUPLER} --delta 0.1": "needs a driver that is a link",
    f"solve {PISTON} --family crank=0.1,0.11 -o a.html": "--family needs",
    f"graph {PISTON} --of rod --over angle": "slider C, which has no angle; use --over time",
    FAMILY.replace("lecture-1", "elastic"): "has elastic links",
    f"{FAMILY} --at-deg 3": "--family with --at-deg",
    f"{FAMILY} --steps 9": "--steps 9: fourbar-lecture-1 is driven",
    f"{FAMILY} --turns 100": "36001 rows of 2 members; at most 20000",
    f"{FAMILY} --family BC=0.25,nan": "write a name and numbers",
    f"{FAMILY} --family BC=0.25,0.01": "BC=0.01: this member cannot be",
    f"{FAMILY} -o f.csv": "found '.csv'; use .xlsx, .html, .svg, .pdf",
    "solve slotted-lever --family R=0.1,0.12": "-o FILE.xlsx, FILE.html, FILE.svg, FILE.pdf",
    "run fourbar-swing --turns 1": "--turns: fourbar-swing is in free motion, without turns",
    "run shaper --duration 1": "--duration: for free motion, and shaper is driven",
    f"run shaper {SHORT} --every 91 -o l.csv": "--every 91: the run of shaper has 90 steps",
    f"{RECIPE} --scene tangent": "driver",
    f"{RECIPE} --steps-per-turn 1e300": ["1e+300", "300000 at most"],
    f"{GRAPH} --divisions 3": "a period has 4 to 1440 parts",
    f"{GRAPH} --divisions 24,12": "each above the one before",
    f"{GRAPH} --by ruler": "use chords, tangents, integration",
    f"{GRAPH} --over crank": "use time or angle",
    f"{GRAPH} --map map.toml": "give --log as well",
    f"{GRAPH} --of crank --divisions 12,24 -o orders.svg": "no errors to draw",
    f"{POLYGON} --k nan": "--k nan: give a number",
    f"{POLYGON} --k 50": "larger paper, or a smaller --k",
    f"{POLYGON} --turn": "give -o FILE.gif",
    "polygon fourbar-swing --at-s -1": "moves from t = 0 on",
    f"{POLYGON} --at-s 1 --at-deg 3": "each sets the instant",
    f"{POLYGON} --log x.csv -o x.html": "a log is drawn at one instant",
    "polygon fourbar-elastic-pulse --at-s 1": "elastic and in free motion",
    "structure fourbar-lecture-1 --at-m 1": "which turns",
    "chains --links 10 --sliders 1": "up to 8 links",
    "chains --links 8 --inversions -o x.svg": "--paper A3 would do",
    "rotatability fourbar-lecture-1 --position x": "give degrees",
    "rotatability triad-platform --position 30": "circuits are found for class II mechanisms",
    "mobility four-bar -o x.toml": "add --replace",
    "equilibria fourbar-lecture-1": "rests anywhere",
    "equilibria fourbar-elastic": "coupler is elastic",
    "equilibria fourbar-pulse": "follows time, and nothing rests under it",
    "mobility --replace": "name a scheme",
    "mobility sarrus --replace": "sarrus: a spatial scheme",
    "stability grashof-exces": ["grashof-exces", "did you mean grashof-excess"],
    "stability --at 1e-3": ["needs one case", "name one"],
    f"{EXCESS} --at nan": "not a finite number",
    f"{EXCESS} --at -0.5": ["not above 0", "Grashof margin", "0.01 to 1e-6 m"],
    f"{EXCESS} --at 5": ["too far off", "0.01 to 1e-6 m"],
    f"{EXCESS} --limit-s 0": "--limit-s 0: give a number above 0",
    "stability long-fourbar --at 2.5": ["not a whole number", "turns"],
    "stability wrong-branch --at 5": "has only the value -1",
    f"{EXCESS} --at 1e-3 -o x": "--at and -o",
    "stability coarse-step --elastic": "no elastic link in it; those are elastic",
    "stability --free --elastic": "no case belongs to both",
    "stability --profile tund": "did you mean tuned",
    "selftest --fault gravity-left": ["'gravity-left'", "did you mean gravity-left-on"],
    "selftest --fault first-order --engine mujoco": "planted in pymunk only",
    "selftest --forces --free": ["--forces with --free", "give one of them"],
    f"{ADVISE} --dt 0": "--dt 0: give a number above 0",
    f"{ADVISE} --dt 1 --study .": "no store of a sweep there",
}  # fmt: skip
PULSE = """
[loads]
pulse = { link = "crank", law = "sine", over = "time", period_s = 0.1, torque_n_m = 2.0 }
"""


@pytest.fixture(scope="module")
def place(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of scenes that can not be asked everything."""
    fourbar = shipped()["fourbar-lecture-1"].read_text(encoding="utf-8")
    law = 'law = "from-rest"\nspeed_rad_s = 7.3686\nrise_s = 0.5'
    elastic = re.sub(r"speed_rad_s = 7.3686", law, scene_text(load_scene("fourbar-elastic")))
    folder = tmp_path_factory.mktemp("scenes")
    for name, text in {
        "locks": fourbar.replace("0.25", "0.17"),
        "pulsed": fourbar + PULSE,
        "flat": scene_text(parallelogram(1)),
        "massless": scene_text(massless(load_scene("fourbar-lecture-1"))),
        "law": elastic.replace('shape = "periodic"', ""),
    }.items():
        (folder / f"{name}.toml").write_text(text, encoding="utf-8")
    return folder


@pytest.mark.parametrize("line", MISTAKES, ids=lambda line: line[:80])
def test_a_mistake_ends_with_2_and_a_message_that_names_place_fault_and_cure(
    line: str, place: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(place)
    before, words = sorted(place.rglob("*")), MISTAKES[line]
    refused(crank_alone(*line.split()), *([words] if isinstance(words, str) else words))
    assert sorted(place.rglob("*")) == before
