"""Scene files of every shape: mechanisms as a user may write them, with all that may be wrong.

A crank with dyads that mostly close, and then up to four things wrong with it: a number at an end
of its range, two numbers that are the same, a point by the name of another, or what is no scene at
all: a date for a number, a table for a name, a key too many.

Mechanisms are driven, let go for a moment, or have elastic links, stiff enough for their speed
mostly; numbers are as a person would write them.
"""

import datetime
import json
import math
import re
from collections.abc import Iterator, Mapping, Sequence

from hypothesis import strategies as st

Tree = dict[str, object]
Path = tuple[str | int, ...]

PLAIN = ("A", "B", "C", "D", "E", "F", "G", "H", "crank", "rod", "lever", "P-1", "x_2", "L" * 40)
NASTY = (
    "", " ", "ground", "world", "block A", "../../etc/passwd", "/tmp/x", "a.b", "con", "-o", "1A",
    "L" * 41, "x" * 10_000, "<script>alert(1)</script>", "a&b", "]]>", "--", '"', "'", "\\", "=1+1",
    "\u202egnp", "\u2066x", "\u0645\u0631\u062d\u0628\u0627", "\u96e8", "\U0001f980", "\u0000",
    "\u001b[2J", "a\nb", "\ufeff", "\u00c5", "\u0391", "[bold]", "{0}", "%s", "$HOME",
)  # fmt: skip
EXTREME = st.sampled_from(
    [
        0.0, -0.0, 1e-15, -1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 1e3, 1e6, 1e9, 1e12, 1e15, -1e15, 5e-324,
        2.2e-308, 1e-300, -0.1, 0, 1, -1, 2, 10**15, 999999999999999.9, 0.1 + 1e-16, math.pi, 360.0,
    ]
)  # fmt: skip
ABSURD: st.SearchStrategy[object] = st.sampled_from(
    [
        1e300, -1e300, 1e308, math.nan, math.inf, -math.inf, 10**16, 10**400, -(10**400), 2**63,
        True, False, "", "0.1", "long", [], {}, [0.1], [0.1, 0.2], [0.1, 0.2, 0.3], [[0.1, 0.2]],
        {"x": 1}, {"A": [0.0, 0.0]}, [{}], ["A", "B"], datetime.date(2024, 2, 29),
        datetime.time(23, 59, 59), datetime.datetime(1, 1, 1),
        datetime.datetime(9999, 12, 31, tzinfo=datetime.UTC),
    ]
)  # fmt: skip


@st.composite
def scene_files(draw: st.DrawFn, made: st.SearchStrategy[Tree] | None = None) -> str:
    """The text of a scene file, of driven `mechanisms` where no others are ``made``."""
    tree = draw(mechanisms() if made is None else made)
    for _ in range(draw(st.sampled_from([0, 1, 1, 1, 2, 2, 4]))):
        draw(st.sampled_from([_stretch, _stretch, _twin, _tie, _tie, _spoil]))(draw, tree)
    return toml(tree)


@st.composite
def mechanisms(draw: st.DrawFn) -> Tree:
    """The tables of a crank and what hangs on it; many can be assembled, and turn."""
    ground: Tree = {"A": [0.0, 0.0]}
    links: Tree = {"crank": {"bar": ["A", "B"], "length_m": draw(between(0.02, 0.1))}}
    sliders: Tree = {}
    carried = ["B"]
    most = draw(st.sampled_from([0, 1, 1, 1, 2, 2, 3, 50]))
    for k in range(draw(st.integers(min(most, 1), most))):
        carried.append(_dyad(draw, k, carried, ground, links, sliders))
    tree: Tree = {"name": "fuzzed", "source": "a test", "ground": {"points": ground}}
    tree |= {"links": links, "sliders": sliders, "driver": draw(drivers())}
    if draw(st.integers(0, 2)) == 0:
        choices = st.sampled_from(carried[1:] + ["B", "Z"][: draw(st.integers(0, 2))] or ["B"])
        tree["branch"] = draw(st.dictionaries(choices, st.sampled_from([1, -1]), max_size=3))
    if draw(st.integers(0, 4)) == 0:
        tree["gravity_m_s2"] = [0.0, draw(between(-9.81, 9.81))]
    if draw(st.integers(0, 4)) == 0:
        names = st.sampled_from(["angle", "position", "gap", "velocity", "angel", "drive"])
        tree["tolerance"] = draw(st.dictionaries(names, between(1e-6, 1.0), max_size=2))
    return tree


def between(low: float, high: float) -> st.SearchStrategy[float]:
    """A number as a person would write it."""
    return st.floats(low, high).map(lambda number: round(number, 4))


def _place(draw: st.DrawFn, x: float = 0.3, y: float = 0.1) -> list[float]:
    return [draw(between(x - 0.1, x + 0.1)), draw(between(y - 0.1, y + 0.1))]


def _dyad(
    draw: st.DrawFn, k: int, carried: Sequence[str], ground: Tree, links: Tree, sliders: Tree
) -> str:
    """Hang two bodies on what is there already; the name of the new point."""
    start, new, far = draw(st.sampled_from(carried)), f"C{k}", f"D{k}"
    kinds = ["RRR", "RRR", "RRR", "RRP", "RRP", "RPR", "RPR", "yoke", "plate", "loose"]
    kind = draw(st.sampled_from(kinds))
    rod: Tree = {"bar": [start, new], "length_m": draw(between(0.25, 0.6))}
    if draw(st.integers(0, 3)) == 0:
        rod |= _masses(draw)
    line: Tree = {"on": "ground"}
    if draw(st.booleans()):
        line["mass_kg"] = draw(between(0.1, 2.0))
    if kind == "RPR":
        ground[far] = _place(draw)
        links[f"lever{k}"] = {"bar": [far, new], "length_m": draw(between(0.3, 0.6))}
        sliders[start] = line | {"on": f"lever{k}"}
        return new
    if kind == "yoke":
        links[f"yoke{k}"] = {"points": {new: _place(draw), far: _place(draw, 0.0, 0.4)}}
        sliders[start] = line | {"on": f"yoke{k}", "direction_deg": draw(between(60.0, 120.0))}
        own: Tree = {"link": f"yoke{k}", "on": "ground", "point": new}
        sliders[f"S{k}"] = own | {"direction_deg": draw(between(-20.0, 20.0))}
        return new
    links[f"rod{k}"] = rod
    if kind in ("RRR", "plate"):
        ground[far] = _place(draw)
        links[f"rocker{k}"] = {"bar": [far, new], "length_m": draw(between(0.25, 0.5))}
        if kind == "plate":  # points of its own, the last of which others may hang on
            more: Tree = {f"E{k}": _place(draw), f"F{k}": _place(draw, -0.2, 0.3)}
            links[f"rocker{k}"] = {"points": {far: [0.0, 0.0], new: _place(draw), **more}}
            return draw(st.sampled_from([new, *more]))
    elif kind == "RRP":
        on = draw(st.sampled_from(["ground"] * 4 + ["crank", *links]))
        direction = {"through_m": _place(draw, 0.0, 0.0), "direction_deg": draw(between(-30, 30))}
        sliders[new] = line | {"on": on} | (direction if draw(st.booleans()) else {})
    return new


def _masses(draw: st.DrawFn) -> Tree:
    """Some of the mass data of a link."""
    given: Tree = {"mass_kg": draw(between(0.1, 2.0)), "inertia_kg_m2": draw(between(0.001, 0.1))}
    given["centre_m"] = _place(draw)
    keys = draw(st.lists(st.sampled_from(list(given)), unique=True))
    return {key: given[key] for key in keys}


@st.composite
def drivers(draw: st.DrawFn) -> Tree:
    law = draw(st.sampled_from(["", "", "", "constant", "oscillating", "from-rest"]))
    start = draw(between(-180.0, 180.0))
    if law == "oscillating":
        found: Tree = {"centre_deg": start, "amplitude_deg": draw(between(1.0, 90.0))}
        found |= {"frequency_rad_s": draw(between(0.5, 20.0)), "phase_deg": start}
    else:
        speed = draw(st.sampled_from([1.0, -1.0])) * draw(between(0.5, 20.0))
        found = {"speed_rad_s": speed, "start_deg": start}
    if law == "from-rest":
        found["rise_s"] = draw(between(0.1, 2.0))
    return {"link": "crank"} | ({"law": law} if law else {}) | found


def _stretch(draw: st.DrawFn, tree: Tree) -> None:
    """A number at an end of its range, or beyond."""
    if numbers := _numbers(tree):
        path = draw(st.sampled_from(numbers))
        _put(_at(tree, path[:-1]), path[-1], draw(EXTREME))


def _twin(draw: st.DrawFn, tree: Tree) -> None:
    """Two numbers that are the same: parallelograms, kites, points that meet."""
    if numbers := _numbers(tree):
        path, other = draw(st.sampled_from(numbers)), draw(st.sampled_from(numbers))
        _put(_at(tree, path[:-1]), path[-1], _at(tree, other))


def _tie(draw: st.DrawFn, tree: Tree) -> None:
    """A point, link or guide by the name of another: joints where none should be."""
    names = sorted({key for path in _paths(tree) for key in path[-1:] if isinstance(key, str)})
    tied = [p for p in _paths(tree) if isinstance(_at(tree, p), str) or p[-2:-1] == ("points",)]
    if not tied:
        return
    path, name = draw(st.sampled_from(tied)), draw(st.sampled_from([*names, "ground"]))
    holder, key = _at(tree, path[:-1]), path[-1]
    if isinstance(_at(tree, path), str):
        _put(holder, key, name)
    elif isinstance(holder, dict):
        holder[name] = holder.pop(key)


def _numbers(tree: Tree) -> list[Path]:
    return [path for path in _paths(tree) if isinstance(_at(tree, path), float)]


def _spoil(draw: st.DrawFn, tree: Tree) -> None:
    """One thing wrong, anywhere."""
    paths = list(_paths(tree))
    if not paths:
        return
    path = draw(st.sampled_from(paths))
    holder, key = _at(tree, path[:-1]), path[-1]
    how = draw(st.sampled_from(["absurd", "name", "name", "drop", "rename", "add", "copy"]))
    if how == "copy":
        _put(holder, key, _at(tree, draw(st.sampled_from(paths))))
    elif how == "drop":
        del holder[key]  # type: ignore[attr-defined]  # a list or a dict
    elif how in ("rename", "add") and isinstance(holder, dict):
        new = draw(st.sampled_from([*NASTY, *PLAIN, "speed", "points", "bar", "link", "on"]))
        holder[new] = holder.pop(key) if how == "rename" else draw(ABSURD)
    elif how == "name":
        _put(holder, key, draw(st.sampled_from([*NASTY, *PLAIN, "crank", "ground", "jerky"])))
    else:
        _put(holder, key, draw(ABSURD))


def _paths(tree: object, here: Path = ()) -> Iterator[Path]:
    if isinstance(tree, Mapping):
        parts: list[tuple[str | int, object]] = list(tree.items())
    else:
        parts = list(enumerate(tree)) if isinstance(tree, list) else []
    for key, value in parts:
        yield (*here, key)
        yield from _paths(value, (*here, key))


def _at(tree: object, path: Path) -> object:
    for key in path:
        tree = tree[key]  # type: ignore[index]  # a list or a dict
    return tree


def _put(holder: object, key: str | int, value: object) -> None:
    if len(repr(value)) < 100_000:  # a copy of a copy of a whole tree grows without end
        holder[key] = _copied(value)  # type: ignore[index]  # a list or a dict


def _copied(value: object) -> object:
    if isinstance(value, dict):
        return {key: _copied(each) for key, each in value.items()}
    return [_copied(each) for each in value] if isinstance(value, list) else value


def toml(tree: Mapping[str, object]) -> str:
    """The tree as TOML, its tables of the first level under their heads."""
    plain = [f"{_key(k)} = {_value(v)}" for k, v in tree.items() if not isinstance(v, dict)]
    for key, table in tree.items():
        if isinstance(table, dict):
            plain += [f"\n[{_key(key)}]", *(f"{_key(k)} = {_value(v)}" for k, v in table.items())]
    return "\n".join(plain) + "\n"


def _key(key: str) -> str:
    return key if re.fullmatch("[A-Za-z0-9_-]+", key) else _string(key)


def _string(text: str) -> str:
    return json.dumps(text, ensure_ascii="\x7f" in text).replace("\x7f", "\\u007f")


def _value(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return _string(value)
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{_key(k)} = {_value(v)}" for k, v in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(_value, value)) + "]"
    if isinstance(value, datetime.date | datetime.time):
        return value.isoformat()
    return repr(value)


UNIT = {"time": "s", "angle": "deg", "omega": "rad_s", "speed": "m_s", "displacement": "m"}


@st.composite
def free_mechanisms(draw: st.DrawFn) -> Tree:
    """The tables of a mechanism that is in free motion for a moment."""
    tree = draw(mechanisms())
    driver: Tree = {"link": "crank", "law": "free", "start_deg": draw(between(-180.0, 180.0))}
    driver["duration_s"] = draw(between(0.01, 0.05))
    if draw(st.booleans()):
        driver["speed_rad_s"] = draw(between(-20.0, 20.0))
    tree["driver"] = driver
    tree["gravity_m_s2"] = [0.0, draw(st.sampled_from([0.0, -9.81]))]
    tree["ground"]["points"]["G"] = [0.1, 0.5]  # type: ignore[index]
    points = sorted(_ends(tree["links"]) - set(tree["ground"]["points"]))  # type: ignore[index]
    for kind, one in (("springs", _spring), ("loads", _load)):
        count = draw(st.sampled_from([0, 1, 1, 2]))
        tree[kind] = {f"{kind[0]}{k}": one(draw, tree, points) for k in range(count)}
    if draw(st.integers(0, 4)) == 0:
        tree["friction"] = {"A": {"torque_n_m": draw(between(0.0, 0.01))}}
    if draw(st.integers(0, 4)) == 0:
        speed = driver.get("speed_rad_s", 0.0)
        tree["start"] = {"rates_rad_s": {"crank": draw(st.sampled_from([speed, speed, 1.0]))}}
    return tree


def _ends(links: object) -> set[str]:
    assert isinstance(links, dict)
    return {
        point for one in links.values() for point in (*one.get("bar", ()), *one.get("points", ()))
    }


def _spring(draw: st.DrawFn, tree: Tree, points: list[str]) -> Tree:
    """A spring, a damper, or both, anywhere."""
    rate, damping = draw(between(0.1, 100.0)), draw(between(0.0, 1.0))
    free = draw(between(0.0, 0.4))
    kind = draw(st.sampled_from(["points", "points", "pin", "slider"]))
    if kind == "pin":
        own: Tree = {"pin": draw(st.sampled_from(["B", *points])), "rate_n_m_rad": rate}
        return own | {"damping_n_m_s": damping, "free_deg": 100.0 * free}
    where = _slider(draw, tree) if kind == "slider" else {}
    ends = [draw(st.sampled_from(["G"] * 4 + points)), draw(st.sampled_from(points))]
    where = where or {"points": ends}
    return where | {"rate_n_m": rate, "damping_n_s_m": damping, "free_m": free}


def _slider(draw: st.DrawFn, tree: Tree) -> Tree:
    names = sorted(tree["sliders"])  # type: ignore[call-overload]
    return {"slider": draw(st.sampled_from(names))} if names else {}


def _load(draw: st.DrawFn, tree: Tree, points: list[str]) -> Tree:
    """A torque on the crank, by one of the laws, over one of what they go over; some of them have
    no period, or no slider, and are refused."""
    size, over = draw(between(-1.0, 1.0)), draw(st.sampled_from(list(UNIT)))
    laws: dict[str, Tree] = {
        "pulse": {"period_s": draw(between(0.01, 0.1))},
        "steps": {"torque_n_m": [size, -size], "at_s": [0.0, draw(between(0.01, 0.04))]},
        "fourier": {f"period_{UNIT[over]}": 90.0, "cosines": [0.1], "sines": [0.1, 0.2]},
        "polynomial": {"torque_n_m": [size, -0.01]},
        "table": {
            "interpolation": draw(st.sampled_from(["linear", "pchip"])),
            f"at_{UNIT[over]}": [-400.0, 0.0, 400.0],
            "torque_n_m": [size, 0.0, -size],
        },
    }
    law = draw(st.sampled_from(["", *laws]))
    found: Tree = {"link": "crank", "torque_n_m": size} | ({"law": law} if law else {})
    if law in ("fourier", "polynomial", "table"):
        found["over"] = over
        found |= _slider(draw, tree) if over in ("speed", "displacement") else {}
    return found | laws.get(law, {})


SHAPES = ("periodic", "quasi-static", "quasi-static", "straight")


@st.composite
def elastic_mechanisms(draw: st.DrawFn) -> Tree:
    """The tables of a four-bar or a slider-crank, of whose links one or two are elastic."""
    fourbar = draw(st.booleans())
    ground: Tree = {"A": [0.0, 0.0]}
    links: Tree = {"crank": {"bar": ["A", "B"], "length_m": draw(between(0.02, 0.06))}}
    links["rod"] = {"bar": ["B", "C"], "length_m": draw(between(0.25, 0.35))}
    tree: Tree = {"name": "fuzzed", "source": "a test", "ground": {"points": ground}}
    tree |= {"links": links, "sliders": {}, "driver": draw(_drivers()), "elastic": {}}
    if fourbar:
        ground["D"] = [draw(between(0.25, 0.35)), draw(between(-0.05, 0.05))]
        links["rocker"] = {"bar": ["D", "C"], "length_m": draw(between(0.2, 0.3))}
    else:
        line: Tree = {"on": "ground", "mass_kg": draw(between(0.0, 1.0))}
        line |= {"through_m": [0.0, draw(between(-0.02, 0.02))]}
        tree["sliders"] = {"C": line | {"direction_deg": draw(between(-180.0, 180.0))}}
    _put_on(draw, tree, links)
    return tree


def _put_on(draw: st.DrawFn, tree: Tree, links: Tree) -> None:
    """Elastic links, the shape that they start with, and what acts."""
    names = st.sampled_from([*[name for name in links if name != "crank"] * 15, "crank", "nothing"])
    for name in draw(st.lists(names, min_size=1, max_size=2, unique=True)):
        tree["elastic"][name] = _elastic(draw)  # type: ignore[index]
    if draw(st.booleans()):
        tree["start"] = {"shape": draw(st.sampled_from(SHAPES))}
    if draw(st.integers(0, 2)) == 0:
        tree["gravity_m_s2"] = [0.0, -9.81]
    if draw(st.integers(0, 4)) == 0:
        body = draw(st.sampled_from([*links]))
        tree["loads"] = {"push": {"link": body, "torque_n_m": draw(between(-0.1, 0.1))}}
    if draw(st.integers(0, 4)) == 0:
        tree["springs"] = {"hold": {"points": ["A", "C"], "rate_n_m": draw(between(0.1, 10.0))}}


@st.composite
def _drivers(draw: st.DrawFn) -> Tree:
    """As those of rigid scenes, and let go for a moment."""
    if draw(st.integers(0, 7)):
        return draw(drivers())
    return {"link": "crank", "law": "free", "speed_rad_s": 5.0, "duration_s": 0.02}


def _elastic(draw: st.DrawFn) -> Tree:
    """How a link bends, stretches, or both."""
    found: Tree = {"flexural_n_m2": draw(st.sampled_from([0.5, 5.0, 5.0, 50.0, 1e6]))}
    if draw(st.booleans()):
        found = {"modulus_pa": draw(st.sampled_from([7e10, 2e11, 2e9]))}
        found |= {"width_m": draw(between(0.005, 0.03)), "height_m": draw(between(0.001, 0.02))}
        if draw(st.booleans()):
            found["density_kg_m3"] = draw(between(1000.0, 8000.0))
    if draw(st.integers(0, 3)) == 0:
        found |= {"stretches": True}
        if "modulus_pa" not in found:
            found["axial_n"] = draw(st.sampled_from([1e4, 1e6]))
    if draw(st.integers(0, 3)) == 0:
        found["bends"] = draw(st.booleans())
    if draw(st.booleans()):
        found["damping_s"] = draw(st.sampled_from([0.0, 1e-4, 1e-3, 10.0]))
    return found
