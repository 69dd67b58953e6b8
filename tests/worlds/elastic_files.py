"""Scene files of mechanisms with elastic links.

As `tests.worlds.scene_files`, which spoils them: links that may be elastic mostly, stiff enough for
their speed mostly, and numbers as a person would write them.
"""

from __future__ import annotations

from hypothesis import strategies as st

from tests.worlds.scene_files import Tree, between, drivers

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
