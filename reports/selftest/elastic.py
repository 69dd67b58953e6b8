"""Faults of elastic links: in the chain of segments that an engine is given, in its steps, and in
what it logs. The pins of the scene move as they should to a millionth: only the bending tells."""

from __future__ import annotations

from functools import partial

import numpy as np

from reports.selftest.clock import late
from reports.selftest.elastic_runs import BENT
from reports.selftest.engines import TIMES, after_a_third
from reports.selftest.fault import Fault, in_engine
from reports.selftest.node_changes import (
    at_next_node,
    bent_by,
    in_chain_log,
    of_beam,
    of_exact_chain,
)
from reports.selftest.segment_changes import (
    as_corrected,
    at_its_ends,
    damped,
    heavier,
    heavy_rocker,
    in_chain,
    in_elastic_scene,
    longer,
    middle_spring,
    modulus_and_mass,
    node_moved,
    of_as_many_springs,
    prebent,
    reversed_spring,
    segments,
    springs,
    started,
    stiffer,
)
from reports.selftest.stepping import after_look, explicit, now_and_then

_chain = partial(Fault, "segments", scenes=(BENT,), rule="CC132")
_inside = partial(Fault, "vibration", scenes=(BENT,), rule="CC132")
_log = partial(Fault, "deflection", scenes=(BENT,), rule="CC132")
FAULTS = (
    _chain(
        name="springs-of-fewer",
        what="springs as of n - 1 segments, not n",
        plant=in_chain(springs(of_as_many_springs)),
    ),
    _chain(
        name="springs-corrected",
        what="corrected springs, not plain ones",
        plant=in_chain(springs(as_corrected)),
    ),
    _chain(
        name="modulus-off",
        what="the modulus is too large",
        plant=in_chain(springs(stiffer)),
        size=1e-2,
        unit="of it",
    ),
    _chain(
        name="spring-missing",
        what="the middle spring is soft, or gone",
        plant=in_chain(middle_spring(lambda one, n, share: stiffer(one, n, -share))),
        size=1.0,
        unit="of it",
    ),
    _chain(
        name="bending-reversed",
        what="it pushes the wrong way",
        plant=in_chain(middle_spring(reversed_spring)),
    ),
    _chain(
        name="spring-prebent",
        what="it is slack at another angle",
        plant=in_chain(middle_spring(prebent)),
        size=1e-3,
        unit="rad",
    ),
    _chain(
        name="spring-damping",
        what="the springs damp",
        plant=in_chain(springs(damped)),
        size=1e-3,
        unit="s",
    ),
    _chain(
        name="inertia-at-ends",
        what="segments' mass is at their ends",
        plant=in_chain(segments(at_its_ends)),
        size=1.0,
        unit="of it",
    ),
    _chain(
        name="segments-heavy",
        what="segments are too heavy",
        plant=in_chain(segments(heavier)),
        size=1e-2,
        unit="of it",
    ),
    _chain(
        name="rocker-heavy",
        what="what it moves is too heavy",
        plant=in_chain(heavy_rocker),
        size=10.0,
        unit="of it",
    ),
    _chain(
        name="node-moved",
        what="a node is elsewhere on the link",
        plant=node_moved,
        size=0.1,
        unit="of it",
    ),
    _chain(
        name="elastic-other",
        what="softer, heavier, moves as it should",
        plant=in_elastic_scene(modulus_and_mass),
        size=1e-2,
        unit="of it",
    ),
    _chain(
        name="elastic-long",
        what="the elastic link is too long",
        plant=in_elastic_scene(longer),
        size=1e-2,
        unit="of it",
        rule="CC103",
    ),
    _chain(
        name="start-straight",
        what="starts straight, and rings",
        plant=started("straight"),
    ),
    _chain(
        name="start-unswung",
        what="starts as if it did not swing",
        plant=started("quasi-static"),
    ),
    _inside(
        name="vibration-damped",
        what="something damps all joints",
        plant=after_look(lambda tools, session, size: tools.damp(session, size)),
        size=1.0,
        unit="1/s",
    ),
    _inside(
        name="bending-explicit",
        what="explicit steps: it is flung out",
        plant=explicit,
        size=1.0,
        unit="of it",
    ),
    _inside(
        name="vibration-fed",
        what=f"speeds made larger, {TIMES} times",
        plant=in_engine(
            now_and_then, lambda tools, session, _o, size, _: tools.quicken(session, size)
        ),
        size=1e-2,
        unit="of it",
    ),
    _inside(
        name="weight-later",
        what="gravity is switched on in mid-run",
        plant=after_a_third(lambda tools, session, size: tools.pull(session, size)),
        size=1.0,
        unit="m/s^2",
    ),
    _log(
        name="deflection-sign",
        what="the deflection has the other sign",
        plant=in_chain_log(bent_by(lambda off, _: np.negative(off))),
    ),
    _log(
        name="deflection-scaled",
        what="the deflection is too large",
        plant=in_chain_log(bent_by(lambda off, share: (1.0 + share) * off)),
        size=1e-2,
        unit="of it",
    ),
    _log(
        name="other-node",
        what="the next node's deflection",
        plant=in_chain_log(at_next_node),
    ),
    _log(
        name="bend-later",
        what="every sample is a later one",
        plant=late,
        size=1.0,
        unit="sample",
        whole=True,
        rule="CC102",
    ),
    _log(
        name="linear-given",
        what="the linear theory, handed in",
        plant=in_chain_log(of_beam(stiffened=False)),
    ),
    _log(
        name="beam-given",
        what="the beam, handed back",
        plant=in_chain_log(of_beam(stiffened=True)),
    ),
    _log(
        name="chain-given",
        what="the exact chain, handed back",
        plant=in_chain_log(of_exact_chain),
        rule="CC111",
    ),
)
