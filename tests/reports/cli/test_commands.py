"""The list of commands that `crankcheck --help` prints."""

from reports.cli.commands import COMMANDS, PANELS
from tests.worlds.command_line import crank


def test_every_command_stands_in_a_panel_with_one_line() -> None:
    for words, command in COMMANDS.items():
        assert command.panel in PANELS, words
        first, *more = command.help.strip().splitlines()
        assert (len(first) <= 70, first[-1], more[:1] in ([], [""])) == (True, ".", True), words


def test_panels_stand_in_the_order_of_what_one_wants() -> None:
    shown = crank("--help").output
    places = [shown.index(f"─ {panel} ─") for panel in PANELS]
    assert places == sorted(places)
    assert all(f"│ {words.split()[0]} " in shown for words in COMMANDS)
