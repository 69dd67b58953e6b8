"""What no command reads: each is refused with exit code 2 and one message, which names the place,
the limit, what was found and what would work, after few calls of functions and in as little memory
as a misspelt key. Loads that a scene can not have, or not for so long, are refused as well."""

import os
import re
import socket
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

import pytest

from models.files.reading import shipped
from reports.workers.isolated import Isolated, Limits, Lost
from tests.worlds.fuzzing import Ended, attempt
from tests.worlds.tiers import few, slowly

MOST_CALLS, LESS = 8_000_000, 60_000_000
"""Calls of functions, some 5,000 for a misspelt key, and memory [byte] beyond that of such a one. A
million takes a tenth of a second."""
SCENE = shipped()["fourbar-lecture-1"].read_text(encoding="utf-8")
STUDY = """scenes = ["fourbar-lecture-1"]
steps_per_turn = [90]
[[variants]]
engine = "mujoco"
profile = "tuned"
"""
SOLVE, SWEEP = "solve FILE", "sweep -o OUT --study FILE"
Made = bytes | Callable[[Path], object]


def sparse(path: Path) -> None:
    """A file of 3 GB that takes no room."""
    with path.open("wb") as file:
        file.truncate(3_000_000_000)


def bound(path: Path) -> None:
    with socket.socket(socket.AF_UNIX) as open_:
        open_.bind(os.path.relpath(path))  # such a name is short


def speed(value: str) -> bytes:
    """The scene with something else for its speed."""
    return SCENE.replace("speed_rad_s = ", f"speed_rad_s = {value} #").encode()


def settings(number: int, length: int) -> bytes:
    """A study with so many settings that each take so many values."""
    values = list(range(1, length + 1))
    lists = "".join(f"s{each} = {values}\n" for each in range(number))
    return f"{STUDY}[variants.settings]\n{lists}".encode()


def nested(levels: int, each: int) -> bytes:
    """YAML whose every line stands for the one before several times."""
    lines = [f"a{k}: &a{k} [{', '.join([f'*a{k - 1}'] * each)}]" for k in range(1, levels)]
    return "\n".join(["a0: &a0 [x]", *lines]).encode()


def many(form: str, count: int) -> str:
    """A text for each number, which stands in place of ``#``."""
    return "".join(form.replace("#", str(k)) for k in range(count))


SPECIAL: dict[str, tuple[Callable[[Path], object], str]] = {
    "3 GB": (sparse, "3000000000 bytes; at most 200000 are read"),
    "endless": (partial(os.symlink, "/dev/zero"), "a device, not a plain file"),
    "pipe": (os.mkfifo, "a pipe, not a plain file"),
    "socket": (bound, "a socket, not a plain file"),
    "folder": (os.mkdir, "a folder; name a plain text file of at most 200000 bytes"),
    "link to nothing": (partial(os.symlink, "nothing"), "neither a shipped scene|not there"),
}
MORE = r"unknown key.*and \d+ more"
BOTH: dict[str, tuple[str, str]] = {
    "key of 60,000 dots": ("a." * 60_000 + "a = 1", r"line 1: a key of more than 10 parts"),
    "brackets": ("a = " + "[" * 60_000, "lists or tables nested too deep, by more than 10"),
    "braces": ("a = " + "{a=" * 60_000, "lists or tables nested too deep|60001 keys"),
    "headers of many parts": (many(f"[a#{'.b' * 49}]\n", 1800),
        "line 1: a key of more than 10 parts; the deepest of scenes and studies has 4"),
    "headers of some parts": (many(f"[a#{'.b' * 9}]\n", 7700),
        "77000 keys, those of headers and the parts between dots counted; at most 20000 are read"),
    "3900 values": ("scenes = [" + "1," * 3900 + "]", "scenes.* and 3|scenes: unknown key"),
    "45001 values": ("scenes = [" + "1," * 45_001 + "]",
        "more than 40000 values, such as scenes.5"),
    "800 keys": (many("a#=1\n", 800), MORE),
    "900 tables": ("[[a]]\n" * 900, "a: unknown key"),
    "integer of 5000 digits": ("turns = " + "9" * 5000, "line 1: a number of more digits than"),
    "integer of 4000 digits": ("turns = " + "9" * 4000, "turns: a whole number of 13288 bits"),
}  # fmt: skip
YAML: dict[str, tuple[bytes, str]] = {
    "integer of 5000 digits": (b"turns: " + b"9" * 5000,
        r"line 1, column 8: found 9+\.\.\., a number of 5000 characters; use at most 100"),
    "no digits": (b"turns: 0x_", "found 0x_; it can not be read as int"),
    "degrees": (b"turns: " + b":".join([b"59"] * 60_000), "found 59:59.*a number of 179999 char"),
    "no character": (b'scenes: ["\\U00110000"]',
        "line 1, column 13: an escape that is no character"),
    "half a character": (b'scenes: ["\\ud800"]',
        r"column 10: found .ud800; it can not be read as str"),
    "version": (b"%YAML " + b"9" * 5000 + b".1\n--- a",
        "line 1, column 7: .*number of too many dig"),
    "date that is none as a key": (b"2020-13-45: 1", "2020-13-45: unknown key; known: scenes"),
    "number as a key": (b"1: 1", "1: found 1; keys should be strings"),
    "billion laughs": (nested(10, 9), "line 5, column .*: more than 5000 values, those of an al"),
    "itself": (b"scenes: &a [*a]", "line 1, column 13: an alias of the part that holds it; refer"),
    "brackets": (b"a: " + b"[" * 90_000, "line 1, column 13: values nested more than 10 deep"),
    "5001 keys": (many("a#: 1\n", 5001).encode(), "more than 5000 val"),
    "tag": (b"turns: !!python/object:os.system x", "could not determine a constructor"),
    "list as a key": (b"[a]: 1", "found unhashable key"),
    "nothing": (b"", "a table of scenes, variants and steps_per_turn is needed"),
}  # fmt: skip
OPTIONS = {
    "solve fourbar-lecture-1 --turns 1e12": "1.2e.13 samples; at most 1000000",
    "solve fourbar-lecture-1 --steps-per-turn 1000000000": "1e.09 samples; at most 1000000",
    "verify fourbar-lecture-1 --turns 1e9": "7.2e.11 steps of .*; at most 300000 are logged",
    f"sweep fourbar-lecture-1 -o OUT --set mujoco.iterations={'9' * 5000}": r"found .9+\.\.\.;",
    "sweep -o OUT --steps-per-turn " + ",".join(map(str, range(90, 20_000))): "at most 100000",
    f"history mujoco {'9' * 5000}": "not a version number",
    "tune fourbar-lecture-1 --engine mujoco --target 1e-6 --budget 1000000000": "1 to 100000",
}  # fmt: skip


def cases() -> Iterator[tuple[str, str, Made, str, str]]:
    """Name, name of the file, what is in it, command, and words of the message."""
    for ending, command in ((".toml", SOLVE), (".toml", SWEEP), (".yaml", SWEEP)):
        verb = f"{command.split()[0]} {ending}"
        for name, (make, words) in SPECIAL.items():
            yield f"{verb} {name}", f"it{ending}", make, command, words
        yield f"{verb} UTF-16", f"it{ending}", STUDY.encode("utf-16"), command, "not UTF-8 text"
    for name, (text, words) in BOTH.items():
        yield f"solve {name}", "it.toml", text.encode(), SOLVE, words
        if name in ("braces", "800 keys", "900 tables"):  # beyond the reading of TOML
            yield f"sweep {name}", "it.toml", text.encode(), SWEEP, words
    for name, (raw, words) in YAML.items():
        yield f"sweep YAML {name}", "it.yaml", raw, SWEEP, words
    for line, words in OPTIONS.items():
        yield line[:70], "it.toml", b"", line, words
    yield "1e400", "it.toml", speed("1e400"), SOLVE, "driver.speed_rad_s: found inf; input should"
    text = ("[sliders]\n" + many("s# = { on = 'x' }\n", 1001)).encode()
    yield "1001 sliders", "it.toml", text, SOLVE, "sliders: found .* at most 1000 items"
    star = many("[links.l#.points]\nA = [0.0, 0.0]\nB# = [0.1, 0.0]\n", 999)
    head = "name = 'a'\nsource = 'b'\n[ground.points]\nA = [0.0, 0.0]\n"
    driver = "[driver]\nlink = 'l0'\nspeed_rad_s = 1.0\n"
    yield "links on a pin", "it.toml", f"{head}{driver}{star}".encode(), SOLVE, "mobility W = .*999"
    words = "has 1e.08 cells: 1 scene x 1e.08 variants .*100 of s0, 100 of s1.*; a sweep has"
    yield "variants", "it.toml", settings(4, 100), SWEEP, words
    words = "at most 100000: take fewer"
    yield "variants of 60", "it.toml", settings(60, 2), SWEEP, words
    yield "study of repeats", "it.toml", STUDY.replace("[90]", f"{[90.0] * 10_000}").encode() + (
        STUDY[STUDY.index("[[") :] * 11
    ).encode(), SWEEP, "120000 cells: 1 scene x 12 variants x 10000 steps in a turn"  # fmt: skip


CASES = {name: case for name, *case in cases()}


@pytest.fixture(scope="module")
def apart() -> Iterator[Isolated[Ended]]:
    """A process that bad input is tried in, with all imported already: it may hang, or fill
    memory."""
    process: Isolated[Ended] = Isolated(Limits(time_s=600.0, memory_gb=2.0))
    for command, text in ((SOLVE, SCENE), (SWEEP, STUDY)):
        ended = process.call(attempt, text.replace("e", "ee", 1).encode(), *command.split())
        assert isinstance(ended, Ended)
        assert ended.code == 2
    yield process
    process.close()


LIKE_ANOTHER = {
    "solve 45001 values", "solve 800 keys", "sweep 800 keys", "sweep braces", "sweep 900 tables",
    "sweep YAML 5001 keys", "sweep YAML brackets", "sweep YAML degrees", "links on a pin",
    "1001 sliders", "study of repeats", *(name for name in CASES if name.startswith("tune ")),
}  # fmt: skip
"""Dear ones, beside a number, a nesting or a command of the same kind."""


@pytest.mark.parametrize(
    "name", few(CASES, CASES.keys() - LIKE_ANOTHER, "up to a second: as another of its kind")
)
def test_it_is_refused_at_once_with_one_message(name: str, apart: Isolated[Ended]) -> None:
    file, made, command, words = CASES[name]
    ended = apart.call(partial(attempt, name=file, counted=True), made, *command.split())
    assert not isinstance(ended, Lost), ended
    assert ended.faults == []
    assert ended.code == 2
    assert ended.errors.count("crankcheck: ") == 1
    assert len(ended.errors) < 9000
    assert re.search(words, ended.errors, re.DOTALL), ended.errors[:500]
    assert ended.files == ()
    assert ended.calls < MOST_CALLS
    assert ended.peak - ended.before < LESS


PRESS = shipped("forces")["toggle-press"].read_text(encoding="utf-8")
RUNS = (
    "verify FILE --engine mujoco -o OUT",
    "sweep FILE --engine mujoco -o OUT",
    slowly(
        "tune FILE --engine mujoco --target 1e-4 --budget 1",
        reason="a second, in which the search is imported: as by the others",
    ),
)


@pytest.mark.parametrize("command", RUNS)
def test_a_table_shorter_than_the_motion_is_refused_before_anything_runs(command: str) -> None:
    short = PRESS.replace("0.0499, 0.055]", "0.0499]", 1).replace("1e5, 1e5]", "1e5]", 1)
    timed = 'link = "crank"\nlaw = "table"\nover = "time"\ninterpolation = "linear"\n'
    timed = f"[loads.pull]\n{timed}at_s = [0.0, 0.1]\ntorque_n_m = [1.0, 2.0]\n"
    goes = "the table goes from"
    for text, over in (
        (short, f"work: over the displacement [m] {goes} -0.05 to 0.0499, and 0.04993"),
        (PRESS[: PRESS.index("[loads.work]")] + timed, f"pull: over the time [s] {goes} 0 to 0.1,"),
    ):
        ended = attempt(text.encode(), *command.split())
        assert ended.faults == []
        assert (ended.code, ended.output, ended.files) == (2, "", ())
        assert f"loads.{over}" in " ".join(ended.errors.split())
