"""Scene files of mechanisms that are let go, with springs, dampers, motors and all else that acts.

As `tests.worlds.scene_files`, which spoils them: names of points and bodies that are there mostly,
numbers as a person would write them.
"""

from __future__ import annotations

from hypothesis import strategies as st

from tests.worlds.scene_files import Tree, between, mechanisms

OVER = ("time", "angle", "omega", "speed", "displacement")
UNIT = {"time": "s", "angle": "deg", "omega": "rad_s", "speed": "m_s", "displacement": "m"}


@st.composite
def free_mechanisms(draw: st.DrawFn) -> Tree:
    """The tables of a mechanism that is let go for a moment."""
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
    """The points of links."""
    assert isinstance(links, dict)
    return {
        point for one in links.values() for point in (*one.get("bar", ()), *one.get("points", ()))
    }


def _spring(draw: st.DrawFn, tree: Tree, points: list[str]) -> Tree:
    """A spring, a damper, or both, anywhere."""
    rate, damping, free = (
        draw(between(0.1, 100.0)),
        draw(between(0.0, 1.0)),
        draw(between(0.0, 0.4)),
    )
    kind = draw(st.sampled_from(["points", "points", "pin", "slider"]))
    if kind == "pin":
        own: Tree = {"pin": draw(st.sampled_from(["B", *points])), "rate_n_m_rad": rate}
        return own | {"damping_n_m_s": damping, "free_deg": 100.0 * free}
    start = draw(st.sampled_from(["G"] * 4 + points))
    where: Tree = {"points": [start, draw(st.sampled_from(points))]}
    if kind == "slider" and tree["sliders"]:
        where = {"slider": draw(st.sampled_from(sorted(tree["sliders"])))}  # type: ignore[call-overload]
    return where | {"rate_n_m": rate, "damping_n_s_m": damping, "free_m": free}


def _load(draw: st.DrawFn, tree: Tree, points: list[str]) -> Tree:
    """A torque on the crank, by one of the laws, over one of what they go over."""
    size, over = draw(between(-1.0, 1.0)), draw(st.sampled_from(OVER))
    found: Tree = {"link": "crank"}
    law = draw(st.sampled_from(["constant", "pulse", "steps", "fourier", "polynomial", "table"]))
    if law == "constant":
        return found | {"torque_n_m": size}
    if law == "pulse":
        return found | {"law": law, "torque_n_m": size, "period_s": draw(between(0.01, 0.1))}
    if law == "steps":
        times = [draw(between(0.0, 0.02)), draw(between(0.02, 0.04))]
        return found | {"law": law, "torque_n_m": [size, -size], "at_s": times}
    if over in ("speed", "displacement") and not tree["sliders"]:
        over = "omega"
    if over in ("speed", "displacement"):
        found["slider"] = draw(st.sampled_from(sorted(tree["sliders"])))  # type: ignore[call-overload]
    if law == "fourier" and over in ("omega", "speed"):  # which has no period
        law = "polynomial"
    found |= {"law": law, "over": over}
    if law == "fourier":
        over_period = {f"period_{UNIT[over]}": draw(between(0.05, 90.0))}
        return found | {"torque_n_m": size, "cosines": [0.1], "sines": [0.1, 0.2], **over_period}
    if law == "polynomial":
        return found | {"torque_n_m": [size, -0.01]}
    reach = draw(st.sampled_from([1.0, 400.0]))
    table = {"interpolation": draw(st.sampled_from(["linear", "pchip"]))}
    rows = {f"at_{UNIT[over]}": [-reach, 0.0, reach], "torque_n_m": [size, 0.0, -size]}
    return found | table | rows
