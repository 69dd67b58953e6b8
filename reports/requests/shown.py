"""What all results have: the text that the command prints, and a picture of it for notebooks."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console


class Shown:
    """A result that is printed as its table, and that a notebook shows with its mechanism.

    It is one thing, equal to itself alone: its series are not compared.
    """

    def show(self, console: Console) -> None:
        """Print it as the command does."""
        raise NotImplementedError

    def _drawn(self) -> str:
        """The mechanism as SVG; "" where there is none to be drawn."""
        return ""

    def __str__(self) -> str:
        from reports.requests.notebook import as_text

        return as_text(self.show)

    def __repr__(self) -> str:
        return str(self)

    def _repr_html_(self) -> str:
        from reports.requests.notebook import as_html

        return as_html(self._drawn(), self.show)

    __eq__ = object.__eq__
    __hash__ = object.__hash__
