"""Mobility, Assur groups in solving order, and what is said of mechanisms that have none."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from analytic.check import newton
from analytic.check.newton import Guess
from analytic.kinematics import solve
from analytic.structure.groups import Bridge
from analytic.structure.mobility import analyse
from analytic.structure.unsolved import MOST_LOOKS, LeftOver
from models.errors import StructureError
from models.files import load_scene, parse_scene, shipped
from models.laws import ConstantSpeed
from models.scene import Driver, Scene

FOURBAR = {"crank": "AB", "coupler": "BC", "rocker": "DC"}
GROUND = {"A": (0.0, 0.0), "D": (0.3, 0.0), "G": (0.6, 0.1), "H": (0.5, 0.4)}
LENGTHS = {"crank": 0.1, "coupler": 0.25, "rocker": 0.2}

EXPECTED = {
    "slotted-lever": ["RPR B"],
    "whitworth": ["RPR B"],
    "shaper": ["RPR B", "RRP F"],
    "scotch-yoke": ["RPP B"],
    "tangent": ["PRP P"],
    "sixbar-watt": ["RRR C", "RRR F"],
    "sixbar-stephenson": ["RRR C", "RRR F"],
}


def build(
    bars: dict[str, str], ground: str = "AD", extra: str = "", branch: str = "", sliders: str = ""
) -> Scene:
    """A scene of bars between one-letter points; further letters of a bar are further points."""
    links = []
    for name, (a, b, *more) in bars.items():
        length = LENGTHS.get(name, 0.3)
        points = ", ".join(f"{p} = [{0.3 * length}, {0.1 * (i + 1)}]" for i, p in enumerate(more))
        links.append(
            f'{name} = {{ bar = ["{a}", "{b}"], length_m = {length}, points = {{ {points} }} }}'
        )
    pins = ", ".join(f"{p} = [{GROUND[p][0]}, {GROUND[p][1]}]" for p in ground)
    text = [
        'name = "made-up"\nsource = "test"',
        f"[ground]\npoints = {{ {pins} }}",
        "[links]",
        *links,
        sliders,
        '[driver]\nlink = "crank"\nspeed_rad_s = 1.0\nstart_deg = 60.0',
        f"[branch]\n{branch}",
        extra,
    ]
    return parse_scene("\n".join(text), "test")


@pytest.mark.parametrize("name", shipped())
def test_shipped_scene_has_mobility_one_and_its_groups_in_order(name: str) -> None:
    structure = analyse(load_scene(name))
    wanted = EXPECTED.get(name, ["RRP C"] if name.startswith("slider-crank") else ["RRR C"])
    assert structure.mobility == 1 == 3 * len(structure.bodies) - 2 * structure.pairs
    assert [f"{group.kind} {group.branch_key}" for group in structure.groups] == wanted
    known = {"ground", load_scene(name).driver.link}
    for group in structure.groups:  # each hangs on what is placed before it
        for letter, pair in ((group.kind[0], group.outer1), (group.kind[2], group.outer2)):
            bodies = structure.pins[pair] if letter == "R" else structure.prismatics[pair]
            assert known & set(bodies)
        known |= {group.first, group.second}
    assert known == {"ground", *structure.bodies}


def test_groups_do_not_depend_on_the_order_of_the_file() -> None:
    bars = {"lever": "GF", "rod": "EF", **dict(reversed(FOURBAR.items())), "rocker": "DCE"}
    groups = analyse(build(bars, "ADG")).groups
    assert [group.branch_key for group in groups] == ["C", "F"]
    assert [(group.first, group.second) for group in groups] == [
        ("rocker", "coupler"),
        ("lever", "rod"),
    ]


@pytest.mark.parametrize(
    ("bars", "ground", "said"),
    [
        (
            {"crank": "AB", "p": "BC", "q": "CE", "r": "ED"},
            "AD",
            r"3\*4 - 2\*5 - 0 = 2;.*Pin a loose",
        ),
        ({"crank": "AB", "p": "BC", "q": "CE", "r": "EF", "s": "FD"}, "AD", r"= 3;.*Pin a loose"),
    ],
    ids=["mobility 2", "mobility 3"],
)
def test_mobility_other_than_one_is_said_with_its_count(
    bars: dict[str, str], ground: str, said: str
) -> None:
    with pytest.raises(StructureError, match=rf"made-up: mobility W = 3 n - 2 p5 - p4 = .*{said}"):
        analyse(build(bars, ground))


def test_a_guide_that_holds_the_mechanism_rigid_is_said_with_the_count() -> None:
    guided = build(FOURBAR, sliders='[sliders.C]\non = "ground"')
    with pytest.raises(StructureError, match=r"3\*4 - 2\*6 - 0 = 0;.*Remove a link or a pin"):
        analyse(guided)


TRIAD = {"crank": "AB", "platform": "CEF", "leg1": "BC", "leg2": "DE", "leg3": "GF"}
SIX = {"crank": "AB", "plate1": "CEF", "plate2": "FKL", "leg1": "BC", "leg2": "DE", "leg3": "GK"}
SIX |= {"leg4": "HL"}
"""Two plates pinned to each other, each on two legs."""


def test_a_platform_on_three_legs_is_a_triad() -> None:
    """One leg is on the crank."""
    found = analyse(build(TRIAD, "ADG"))
    assert [(triad.central, triad.kind) for triad in found.triads] == [("platform", "RR-RR-RR")]
    assert not found.groups


def test_dyads_stand_before_and_after_a_triad() -> None:
    bars = FOURBAR | {"rocker": "DCI", "platform": "EFJK", "leg1": "IE", "leg2": "GF", "leg3": "HJ"}
    bars |= {"rod": "KL", "lever": "GL"}
    order = analyse(build(bars, "ADGH")).order
    kinds = [(part.kind, part.bodies[0]) for part in order if not isinstance(part, Bridge)]
    assert kinds == [("RRR", "coupler"), ("RR-RR-RR", "platform"), ("RRR", "rod")]


def test_a_larger_group_names_its_links() -> None:
    with pytest.raises(StructureError, match="class III or higher, order 4") as raised:
        analyse(build(SIX, "ADGH"))
    said = str(raised.value)
    links = "plate1, plate2, leg1, leg2, leg3, leg4"
    assert f"{links} form an Assur group of 6 links and 9 pairs" in said
    assert "dyads (RRR, RRP, RPR, PRP, RPP) and triads (class III, order 3) have" in said


def test_four_links_in_a_ring_are_of_class_iv() -> None:
    bars = {"crank": "AB", "one": "BCE", "two": "DFJ", "bar1": "CF", "bar2": "EJ"}
    with pytest.raises(StructureError, match=r"4 links and 6 pairs \(class IV, order 2\)"):
        analyse(build(bars))


def test_legs_that_slide_at_both_ends_leave_no_two_of_a_triad() -> None:
    slides = "".join(
        f'[sliders.S{i}]\non = "ground"\nlink = "leg{i}"\npoint = "{p}"\n'
        f'[sliders.T{i}]\non = "leg{i}"\nlink = "platform"\npoint = "{q}"\ndirection_deg = 50.0\n'
        for i, p, q in ((2, "G", "E"), (3, "H", "F"))
    )
    bars = {"crank": "AB", "platform": "CEF", "leg1": "BC", "leg2": "GI", "leg3": "HK"}
    with pytest.raises(StructureError, match="order 3, two of whose legs slide at both ends"):
        analyse(build(bars, "A", sliders=slides))


def test_what_the_driver_moves_against_each_other_is_one_link_of_a_group() -> None:
    bars = {"crank": "ACM", "arm": "ME", "two": "DFJ", "bar1": "CF", "bar2": "EJ"}
    driver = Driver("arm", ConstantSpeed(0.1, 1.0), "crank", pin="M")
    with pytest.raises(StructureError, match=r"crank \+ arm, two, bar1, bar2 form .* \(class IV"):
        analyse(replace(build(bars), driver=driver))


def pairs_of_platforms(count: int) -> Scene:
    """Groups of six links, each with one leg on the crank."""
    scene = build(SIX, "ADGH")
    links = {"crank": scene.links["crank"]}
    for name in ("leg1", "leg2", "leg3", "leg4", "plate1", "plate2"):
        for i in reversed(range(count)):
            link = scene.links[name]
            points = {p if p in "BDGH" else f"{p}{i}": at for p, at in link.points.items()}
            links[f"{name}-{i}"] = replace(link, name=f"{name}-{i}", points=points)
    return replace(scene, links=links)


def chain_of_platforms(count: int) -> Scene:
    """As `pairs_of_platforms`, and each next one hangs on the last by its first leg."""
    scene = pairs_of_platforms(count)
    links = dict(scene.links)
    for i in range(1, count):
        leg = links[f"leg1-{i}"]
        points = {f"C{i - 1}" if p == "B" else p: at for p, at in leg.points.items()}
        links[f"leg1-{i}"] = replace(leg, points=points)
    return replace(scene, links=links)


def test_a_group_of_many_alike_is_named_alone() -> None:
    with pytest.raises(StructureError, match="class III") as raised:
        analyse(pairs_of_platforms(20))
    named = "leg1-19, leg2-19, leg3-19, leg4-19, plate1-19, plate2-19"
    assert f"links {named} form an Assur group" in str(raised.value)


@pytest.mark.parametrize("count", [10, 60])
def test_the_work_of_naming_a_group_does_not_grow_with_the_links(
    monkeypatch: pytest.MonkeyPatch, count: int
) -> None:
    """All hang together, so a group is searched for among all; what is left is not listed whole."""
    looks = 0
    whole = LeftOver.pairs_of

    def counting(rest: LeftOver, group: set[str]) -> tuple[int, int]:
        nonlocal looks
        looks += len(rest.left) + len(rest.pins)
        return whole(rest, group)

    monkeypatch.setattr(LeftOver, "pairs_of", counting)
    with pytest.raises(StructureError) as raised:
        analyse(chain_of_platforms(count))
    assert looks <= MOST_LOOKS
    said = str(raised.value)
    assert f" and {6 * count - 8} more do not hang on the driver" in said
    assert len(said) < 300


def test_a_driven_pair_whose_bodies_are_joined_again_cannot_move() -> None:
    bars = {"crank": "AB", "plate": "BCE", "brace": "CEF", "rocker": "DF"}
    scene = replace(build(bars), driver=Driver("brace", ConstantSpeed(0.1, 1.0), "plate", pin="C"))
    with pytest.raises(StructureError, match=r"pin C of plate and brace cannot move: .* at E too"):
        analyse(scene)


def test_rigid_part_beside_a_loose_link_is_not_taken_for_mobility_one() -> None:
    guide = '[sliders.C]\non = "ground"'
    guided = build(FOURBAR | {"rocker": "DCE", "tail": "EF"}, sliders=guide)
    with pytest.raises(StructureError, match=r"held by 2 pairs.*rigid and another link is loose"):
        analyse(guided)


def test_redundant_link_beside_a_loose_one_is_not_taken_for_mobility_one() -> None:
    bars = FOURBAR | {"rocker": "DCE", "strut": "BC", "tail": "EF"}
    said = r"= 1, but 2 where redundant links \(strut\) are not counted.*Pin a loose link"
    with pytest.raises(StructureError, match=said):
        analyse(build(bars))


def test_two_links_with_both_pins_in_common_hang_loose() -> None:
    bars = {"crank": "AB", "coupler": "DC", "rocker": "DC"}
    with pytest.raises(StructureError, match="coupler and rocker both hang on pin D, and turn"):
        analyse(build(bars))


def test_a_block_on_a_lever_that_is_pinned_where_the_block_is_hangs_loose() -> None:
    bars = {"crank": "AB", "lever": "BE"}
    with pytest.raises(StructureError, match="lever and block B both hang on pin B, and turn"):
        analyse(build(bars, ground="A", sliders='[sliders.B]\non = "lever"'))


def test_branch_that_chooses_nothing_is_refused() -> None:
    with pytest.raises(
        StructureError, match=r"branch\.B chooses between no two assemblies; it has C"
    ):
        analyse(build(FOURBAR, branch="B = 1"))
    scene = load_scene("tangent")
    with pytest.raises(StructureError, match=r"branch\.P .* this scene has none"):
        analyse(Scene(**{**vars(scene), "branch": {"P": 1}}))


def test_three_links_at_one_pin_are_two_pairs() -> None:
    """Coupler, rocker and rod all at C: the second dyad hangs on the pin of the first."""
    scene = build(FOURBAR | {"rod": "CF", "lever": "GF"}, "ADG")
    structure = analyse(scene)
    assert structure.pins["C"] == ("coupler", "rocker", "rod")
    assert (structure.pairs, structure.mobility) == (7, 1)
    assert [g.branch_key for g in structure.groups] == ["C", "F"]
    time_s = np.linspace(0.0, 6.0, 30)
    motion = solve(scene, time_s)
    place = motion.state().position
    start = {"crank": "A", "coupler": "B", "rocker": "D", "rod": "C", "lever": "G"}
    guess = {n: (*place[p], float(motion.links[n].theta[0])) for n, p in start.items()}
    other = newton.solve(scene, time_s, Guess(guess))
    for name, link in motion.links.items():
        assert np.allclose(link.alpha, other.links[name].alpha, rtol=0, atol=1e-11)


def test_slider_on_three_sliders_is_no_group() -> None:
    """Two links that slide on known bodies and on each other can shift: no dyad of sliders."""
    sliders = """
[sliders.X]
link = "p"
point = "C"
on = "crank"
[sliders.Y]
link = "q"
point = "E"
on = "p"
direction_deg = 60.0
[sliders.Z]
link = "q"
point = "F"
on = "ground"
direction_deg = 90.0
"""
    with pytest.raises(StructureError, match="do not hang on the driver"):
        analyse(build({"crank": "AB", "p": "CI", "q": "EF"}, "A", sliders=sliders))
