"""Mobility, Assur groups in solving order, classes by the driver, and what is said without them."""

from dataclasses import replace

import pytest

from analytic.lectures.chains.assur_groups import StructureByDriver, by_drivers
from analytic.structure.groups import Bridge
from analytic.structure.mobility import analyse
from models.errors import StructureError
from models.files.reading import load_scene, parse_scene, shipped
from models.scene import Driver, Scene
from models.scene.laws import ConstantSpeed

FOURBAR = {"crank": "AB", "coupler": "BC", "rocker": "DC"}
GROUND = {"A": (0.0, 0.0), "D": (0.3, 0.0), "G": (0.6, 0.1), "H": (0.5, 0.4)}
LENGTHS = {"crank": 0.1, "coupler": 0.25, "rocker": 0.2}

EXPECTED = {"slotted-lever": ["RPR B"], "whitworth": ["RPR B"], "shaper": ["RPR B", "RRP F"]}
EXPECTED |= {"scotch-yoke": ["RPP B"], "tangent": ["PRP P"]}
EXPECTED |= {f"sixbar-{name}": ["RRR C", "RRR F"] for name in ("watt", "stephenson")}


def build(bars: dict[str, str], ground: str = "AD", sliders: str = "") -> Scene:
    """A scene of bars between one-letter points; further letters of a bar are further points."""
    links = []
    for name, (a, b, *more) in bars.items():
        length = LENGTHS.get(name, 0.3)
        points = ", ".join(f"{p} = [{0.3 * length}, {0.1 * (i + 1)}]" for i, p in enumerate(more))
        bar = f'bar = ["{a}", "{b}"], length_m = {length}'
        links.append(f"{name} = {{ {bar}, points = {{ {points} }} }}")
    pins = ", ".join(f"{p} = [{GROUND[p][0]}, {GROUND[p][1]}]" for p in ground)
    head = f'name = "made-up"\nsource = "test"\n[ground]\npoints = {{ {pins} }}\n[links]'
    driver = '[driver]\nlink = "crank"\nspeed_rad_s = 1.0\nstart_deg = 60.0'
    return parse_scene("\n".join([head, *links, sliders, driver]), "test")


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


def test_groups_stand_in_solving_order_whatever_that_of_the_file() -> None:
    bars = {"lever": "GF", "rod": "EF", **dict(reversed(FOURBAR.items())), "rocker": "DCE"}
    groups = analyse(build(bars, "ADG")).groups
    assert [group.branch_key for group in groups] == ["C", "F"]
    assert [(group.first, group.second) for group in groups] == [
        ("rocker", "coupler"),
        ("lever", "rod"),
    ]
    # Dyads before and after a triad.
    bars = FOURBAR | {"rocker": "DCI", "platform": "EFJK", "leg1": "IE", "leg2": "GF", "leg3": "HJ"}
    bars |= {"rod": "KL", "lever": "GL"}
    order = analyse(build(bars, "ADGH")).order
    kinds = [(part.kind, part.bodies[0]) for part in order if not isinstance(part, Bridge)]
    assert kinds == [("RRR", "coupler"), ("RR-RR-RR", "platform"), ("RRR", "rod")]
    # Coupler, rocker and rod all at C, two pairs: the second dyad hangs on the pin of the first.
    scene = build(FOURBAR | {"rod": "CF", "lever": "GF"}, "ADG")
    structure = analyse(scene)
    assert structure.pins["C"] == ("coupler", "rocker", "rod")
    assert (structure.pairs, structure.mobility) == (7, 1)
    assert [g.branch_key for g in structure.groups] == ["C", "F"]


SIX = {"crank": "AB", "plate1": "CEF", "plate2": "FKL", "leg1": "BC", "leg2": "DE", "leg3": "GK"}
SIX |= {"leg4": "HL"}
"""Two plates pinned to each other, each on two legs."""
SLIDES = "".join(
    f'[sliders.S{i}]\non = "ground"\nlink = "leg{i}"\npoint = "{p}"\n'
    f'[sliders.T{i}]\non = "leg{i}"\nlink = "platform"\npoint = "{q}"\ndirection_deg = 50.0\n'
    for i, p, q in ((2, "G", "E"), (3, "H", "F"))
)
THREE_SLIDERS = """[sliders]
X = { link = "p", point = "C", on = "crank" }
Y = { link = "q", point = "E", on = "p", direction_deg = 60.0 }
Z = { link = "q", point = "F", on = "ground", direction_deg = 90.0 }
"""
TWO_SLIDE = {"crank": "AB", "platform": "CEF", "leg1": "BC", "leg2": "GI", "leg3": "HK"}
GUIDE = '[sliders.C]\non = "ground"'
BRACED = {"crank": "AB", "plate": "BCE", "brace": "CEF", "rocker": "DF"}
IN_A_RING = {"crank": "AB", "one": "BCE", "two": "DFJ", "bar1": "CF", "bar2": "EJ"}
ON_AN_ARM = {"crank": "ACM", "arm": "ME", "two": "DFJ", "bar1": "CF", "bar2": "EJ"}


def by_pin(bars: dict[str, str], link: str, base: str, pin: str) -> Scene:
    return replace(build(bars), driver=Driver(link, ConstantSpeed(0.1, 1.0), base, pin=pin))


REFUSED = {
    "mobility 2": (build({"crank": "AB", "p": "BC", "q": "CE", "r": "ED"}),
        r"made-up: mobility W = 3 n - 2 p5 - p4 = 3\*4 - 2\*5 - 0 = 2;.*Pin a loose"),
    "a guide holds it rigid": (build(FOURBAR, sliders=GUIDE),
        r"3\*4 - 2\*6 - 0 = 0;.*Remove a link or a pin"),
    "a larger group": (build(SIX, "ADGH"),
        "plate1, plate2, leg1, leg2, leg3, leg4 form an Assur group of 6 links and 9 pairs "
        r"\(class III or higher, order 4\).*dyads \(RRR, RRP, RPR, PRP, RPP\) and triads "
        r"\(class III, order 3\) have"),
    "four links in a ring": (build(IN_A_RING),
        r"4 links and 6 pairs \(class IV, order 2\)"),
    "two legs that slide at both ends": (build(TWO_SLIDE, "A", SLIDES),
        "order 3, two of whose legs slide at both ends"),
    "what the driver moves against each other is one link": (by_pin(ON_AN_ARM, "arm", "crank", "M"),
        r"crank \+ arm, two, bar1, bar2 form .* \(class IV"),
    "a driven pair whose bodies are joined again": (by_pin(BRACED, "brace", "plate", "C"),
        r"pin C of plate and brace cannot move: .* at E too"),
    "rigid beside a loose link": (build(FOURBAR | {"rocker": "DCE", "tail": "EF"}, sliders=GUIDE),
        r"held by 2 pairs.*rigid and another link is loose"),
    "redundant beside loose": (build(FOURBAR | {"rocker": "DCE", "strut": "BC", "tail": "EF"}),
        r"= 1, but 2 where redundant links \(strut\) are not counted.*Pin a loose link"),
    "both pins in common": (build({"crank": "AB", "coupler": "DC", "rocker": "DC"}),
        "coupler and rocker are both pinned at D alone, and turn"),
    "three sliders": (build({"crank": "AB", "p": "CI", "q": "EF"}, "A", THREE_SLIDERS),
        "are not joined to the driver"),
    "a branch of no assemblies": (replace(build(FOURBAR), branch={"B": 1}),
        r"branch\.B separates no assemblies; it has C"),
    "a branch of a scene without assemblies": (replace(load_scene("tangent"), branch={"P": 1}),
        r"branch\.P .* this scene has none"),
}  # fmt: skip


@pytest.mark.parametrize("name", REFUSED)
def test_what_has_no_solution_is_refused_with_the_reason(name: str) -> None:
    scene, said = REFUSED[name]
    with pytest.raises(StructureError, match=said):
        analyse(scene)


def chain_of_platforms(count: int) -> Scene:
    """Groups of six links, the first with a leg on the crank, each next one with it on the last."""
    scene = build(SIX, "ADGH")
    links = {"crank": scene.links["crank"]}
    for name in ("leg1", "leg2", "leg3", "leg4", "plate1", "plate2"):
        for i in reversed(range(count)):
            link = scene.links[name]
            points = {p if p in "BDGH" else f"{p}{i}": at for p, at in link.points.items()}
            links[f"{name}-{i}"] = replace(link, name=f"{name}-{i}", points=points)
    for i in range(1, count):
        leg = links[f"leg1-{i}"]
        points = {f"C{i - 1}" if p == "B" else p: at for p, at in leg.points.items()}
        links[f"leg1-{i}"] = replace(leg, points=points)
    return replace(scene, links=links)


def test_what_hangs_on_a_driver_in_too_many_ways_is_not_searched_for_a_group() -> None:
    """And what is left is not listed whole."""
    with pytest.raises(StructureError) as raised:
        analyse(chain_of_platforms(60))
    said = str(raised.value)
    assert " and 352 more are not joined to the driver" in said
    assert len(said) < 300


def classes(scene: Scene) -> dict[str, StructureByDriver]:
    return {one.joint.words: one for one in by_drivers(scene, analyse(scene))}


def test_joints_of_a_six_bar_and_a_slider_in_a_ring_of_four_have_their_classes() -> None:
    found = {
        words: one.class_number for words, one in classes(load_scene("sixbar-stephenson")).items()
    }
    second = {"A of ground and crank", "B of crank and coupler", "C of coupler and rocker"}
    second |= {"D of ground and rocker"}
    third = {"E of coupler and rod", "F of rod and lever", "G of ground and lever"}
    assert found == {f"pin {words}": 2 if words in second else 3 for words in second | third}
    bars = {"crank": "AB", "bar": "BC", "plate": "CEK", "swing": "DK"}
    ring = classes(build(bars, sliders='[sliders.E]\non = "crank"\ndirection_deg = 20.0'))
    (group,) = ring["pin D of ground and swing"].groups
    assert (group.class_number, group.order) == (4, 2)
    assert set(group.links) == {"crank", "bar", "plate", "block E"}


def test_groups_by_a_joint_are_those_of_the_scene_that_it_drives() -> None:
    for name in ("shaper", "sixbar-watt"):
        scene = load_scene(name)
        (own,) = (one for one in classes(scene).values() if one.is_own)
        assert [each.links for each in own.groups] == [one.bodies for one in analyse(scene).groups]
    scene = load_scene("slider-crank-central")
    found = next(one for one in classes(scene).values() if one.joint.slider == "C")
    driver = Driver("block C", scene.driver.law, slider="C")
    driven = replace(scene, driver=driver, branch={})
    assert [one.links for one in found.groups] == [one.bodies for one in analyse(driven).groups]
