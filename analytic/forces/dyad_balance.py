"""Equilibrium of the five class II groups: reactions of a group from the forces on its bodies.

A group is statically determinate: two bodies, six equations, three pairs of two unknowns each.
Groups are solved one after the other, in the reverse of the solving order, and leave the reactions
of their outer pairs on the bodies that hold them; the driver is last. Of the six equations four
only take over the result of the other two: those of a 2 x 2 system with the determinant of the
group's kinematics (the transposed problem), which is why forces are singular where positions are.

Letters: e along a line, n = e turned by +90 deg; F the force on the first body in the inner pin, R
that in its outer pin; E and M the other forces on a body, with moments about the pin named.
"""

from collections.abc import Callable, Mapping

from analytic.dyads.plane import EPS
from analytic.forces.bounded import NOUGHT, Bounded, BoundedVec
from analytic.forces.central_balance import balance_central
from analytic.forces.free_body import Balance, PrismaticPair
from analytic.higher_pairs.follower_step import lift_at, lift_errors
from analytic.structure.gear_groups import GearGroup
from analytic.structure.groups import Bridge, Following, Group, Triad
from models.scene import GROUND


def torque_of(on: Balance) -> Bounded:
    """Solve all groups, the last one first; return the remaining torque on the driver, or force
    along its line."""
    compound = on.structure.compound
    inner = set() if compound is None else {compound.name}
    for part in reversed(on.structure.order):
        if isinstance(part, Bridge):
            continue
        if isinstance(part, GearGroup):
            _train(on, part)
            continue
        if isinstance(part, Following):
            on.standing.discard(part.body)
            _following(on, part)
            continue
        central = inner.intersection(part.bodies)
        on.standing.difference_update(part.bodies)
        if central and compound is not None:
            on.standing -= {compound.base, compound.link}
        if isinstance(part, Triad) or central:
            balance_central(on, part)
        else:
            _BALANCES[part.kind](on, part)
    return on.drive()


def _rrr(on: Balance, group: Group) -> None:
    """Solve moments about the outer pins: r1 x F + M1 = 0, r2 x F = M2."""
    one, other = on.free[group.first], on.free[group.second]
    r1 = on.span(group.first, group.outer1, group.inner)
    r2 = on.span(group.second, group.outer2, group.inner)
    m1, m2 = on.moment(group.first, group.outer1), on.moment(group.second, group.outer2)
    inverse = r2.cross(r1).inverse()
    force = r1 * (m2 * inverse) + r2 * (m1 * inverse)
    on.inner(group, force)
    on.hold(group.outer1, group.first, -(one.force + force))
    on.hold(group.outer2, group.second, force - other.force)


def _rrp(on: Balance, group: Group) -> None:
    """Solve e F = e E2 along the line, and r x F + M1 = 0 about the outer pin."""
    one, other = on.free[group.first], on.free[group.second]
    line = on.pair(group.outer2)
    r = on.span(group.first, group.outer1, group.inner)
    along = line.along.dot(other.force)
    turning = on.moment(group.first, group.outer1) + along * r.cross(line.along)
    force = line.along * along - line.across * (turning * r.dot(line.along).inverse())
    on.inner(group, force)
    on.hold(group.outer1, group.first, -(one.force + force))
    on.push(group.second, group.inner, -force)
    on.rest(group.outer2, group.second)


def _rpr(on: Balance, group: Group) -> None:
    """Solve for the force N n on the first body: with d from the second outer pin to the first,
    moments of both bodies about the second give (d e) N = M1 + M2."""
    one, other = on.free[group.first], on.free[group.second]
    line = on.pair(group.inner)
    near = line.arms[group.first] - on.arm(group.first, group.outer1)
    far = line.arms[group.second] - on.arm(group.second, group.outer2)
    m1, m2 = on.moment(group.first, group.outer1), on.moment(group.second, group.outer2)
    normal = (m1 + m2) * (far - near).dot(line.along).inverse()
    force = line.across * normal
    on.hold(group.outer1, group.first, -(one.force + force))
    on.hold(group.outer2, group.second, force - other.force)
    moment = -(m1 + normal * near.dot(line.along))
    on.sliders[line.name] = (normal, moment) if group.first == line.body else (-normal, -moment)


def _prp(on: Balance, group: Group) -> None:
    """Solve e1 F = -e1 E1, e2 F = e2 E2 along the two lines."""
    one, other = on.free[group.first], on.free[group.second]
    line1, line2 = on.pair(group.outer1), on.pair(group.outer2)
    along1, along2 = -line1.along.dot(one.force), line2.along.dot(other.force)
    force = _crossing(line1, line2, along1, along2)
    on.inner(group, force)
    on.push(group.first, group.inner, force)
    on.push(group.second, group.inner, -force)
    on.rest(group.outer1, group.first)
    on.rest(group.outer2, group.second)


def _rpp(on: Balance, group: Group) -> None:
    """Solve k R = -k E1 along the inner line, and e R = -e (E1 + E2) along the outer one."""
    one, other = on.free[group.first], on.free[group.second]
    inner, outer = on.pair(group.inner), on.pair(group.outer2)
    along1 = -inner.along.dot(one.force)
    along2 = -outer.along.dot(one.force + other.force)
    force = _crossing(inner, outer, along1, along2)
    on.hold(group.outer1, group.first, force)
    on.push(group.first, group.outer1, force)
    on.rest(group.inner, group.first)
    on.rest(group.outer2, group.second)


def _crossing(
    line1: PrismaticPair, line2: PrismaticPair, along1: Bounded, along2: Bounded
) -> BoundedVec:
    """Return the force with these components along two lines."""
    inverse = line1.along.cross(line2.along).inverse()
    return line1.across * (along2 * inverse) - line2.across * (along1 * inverse)


def _train(on: Balance, train: GearGroup) -> None:
    """Solve moments about the pins for the factor of each gear's relation, whose coefficients times
    it are the couples on the bodies; pins only take over forces.

    So does an engine's relation of angles. The forces of teeth press on the pins as well, and are
    left to `analytic.gears`.
    """
    moments: dict[str, Bounded] = {}
    for body, pin in reversed([*zip(train.bodies, train.pins, strict=True)]):
        moments[body] = on.moment(body, pin)
        on.standing.discard(body)
        on.hold(pin, body, -on.free[body].force)
    for k, gear in enumerate(train.gears):
        factor = NOUGHT
        for body, row in zip(train.bodies, train.inverse, strict=True):
            factor = factor - moments[body] * Bounded(float(row[k]), EPS * abs(float(row[k])))
        for body in train.known:
            if body != GROUND and (share := gear.relation.get(body, 0)):
                own = on.free[body]
                own.moment = own.moment + factor * Bounded(float(share))


def _following(on: Balance, part: Following) -> None:
    """Solve for the force of a cam along the way of its follower, or its moment; the couple on the
    cam has the same power. So does an engine's relation; the contact force is in `analytic.cams`.
    """
    pair, own = part.pair, on.free[part.body]
    cam, carrier = on.free[pair.cam], on.free[pair.carrier]
    lift = lift_at(pair, cam.body, carrier.body)
    certified = own.body.error is not None
    ratio = Bounded(lift.first, lift_errors(pair, cam.body, carrier.body)[1] if certified else None)
    if pair.slider:
        line = on.pair(pair.slider)
        push = -line.along.dot(own.force)
        on.rest(pair.slider, part.body)
        if pair.carrier != GROUND:
            carrier.push(line.arms[pair.carrier], -(line.along * push))
    else:
        push = -on.moment(part.body, part.joint[1])
        on.hold(part.joint[1], part.body, -own.force)
        if pair.carrier != GROUND:
            carrier.moment = carrier.moment - push
    couple = push * ratio
    cam.moment = cam.moment - couple
    if pair.carrier != GROUND:
        carrier.moment = carrier.moment + couple


_BALANCES: Mapping[str, Callable[[Balance, Group], None]] = {
    "RRR": _rrr,
    "RRP": _rrp,
    "RPR": _rpr,
    "PRP": _prp,
    "RPP": _rpp,
}
