"""What is recommended was seen to gain: contacts off, the integrator, or nothing at all."""

from __future__ import annotations

import io

import pytest
from rich.console import Console

from reports.own_model.judged import JudgedModel
from reports.own_model.sentences import NO_HELP, verdict_text
from reports.own_model.table import show
from reports.page.model_page import model_page
from tests.worlds.own_four_bar import CLOSED, planted
from tests.worlds.own_models import FACTS, judged

SOFT = (
    ' tolerance="1e-16"', "",
    '<equality solref="0.005 0.6" solimp="0.9999 0.9999 0.001 0.5 2"/>', "",
)  # fmt: skip
RK4 = ' integrator="RK4"'
PENDULUM = (
    '<body name="beside" pos="0 3 0"><joint damping="50"/><geom fromto="0 0 0 0.1 0 0"/></body>'
)


def of(*edits: str) -> JudgedModel:
    return judged(planted(*SOFT, *edits), "A")


def printed(one: JudgedModel) -> str:
    stream = io.StringIO()
    show(Console(file=stream, width=200), one, FACTS)
    return stream.getvalue()


def test_the_integrator_stays_where_another_one_diverges() -> None:
    """RK4 can not hold a body beside the linkage that implicitfast damps."""
    one = of(
        RK4, ' integrator="implicitfast"', ' gravity="0 0 0"', "",
        "</worldbody>", PENDULUM + "</worldbody>",
    )  # fmt: skip
    assert not one.account.recommended.advised.integrator
    assert 'integrator="RK4"' not in one.patch
    assert one.lines[-1].status == "ok"
    assert one.gains(one.lines[-1])[0] > 1.0


@pytest.mark.parametrize(
    ("soft", "off"), [('solref="100 1" solimp="1e-4 1e-4 1"', False), ('solref="0.02 1"', True)]
)
def test_contacts_are_off_only_where_that_gains(soft: str, off: bool) -> None:
    """A ball in the way of the rocker that pushes it, or gives way."""
    ball = (
        '<geom name="ball" type="sphere" size="0.02" pos="0.3 0 0.2" contype="1" conaffinity="1" '
        f'priority="1" {soft}/>'
    )
    one = of(
        "<worldbody>", f"<worldbody>{ball}",
        'name="rocker-bar"', 'name="rocker-bar" contype="1" conaffinity="1"',
    )  # fmt: skip
    assert "contacts" in {each.kind for each in one.account.disturbances}
    assert one.account.recommended.advised.contacts_off == off
    assert ('contact="disable"' in one.patch) == off


def test_where_nothing_helps_nothing_is_recommended() -> None:
    """RK4 is refused beside a flag, and the loops are as stiff as they can be."""
    stiff = CLOSED.replace("/>", ' solref="0.005 0.6" solimp="0.9999 0.9999 0.001 0.5 2"/>')
    flags = '<flag fwdinv="enable" invdiscrete="enable"/>'
    option = f' gravity="0 0 0" tolerance="1e-16" iterations="99">{flags}</option>'
    one = of(CLOSED, stiff, RK4, "", ' gravity="0 0 0"/>', option)
    assert not one.account.helps
    assert one.patch == ""
    assert verdict_text(one).endswith(NO_HELP)
    text = printed(one)
    assert "Recommended" not in text
    assert NO_HELP.capitalize() in text
    page = model_page(one, FACTS)
    assert "No settings help" in page
    assert "With them the model" not in page


@pytest.mark.parametrize("solver", ['solver="CG" iterations="1"', 'solver="PGS" iterations="2"'])
def test_the_solver_is_newton_with_iterations_enough(solver: str) -> None:
    again = CLOSED.replace('name="C"', 'name="again"')
    one = of(' gravity="0 0 0"/>', f' gravity="0 0 0" {solver}/>', CLOSED, CLOSED + again)
    assert one.lines[-1].verdict == "within"
    assert 'solver="Newton" iterations="100"' in one.patch
