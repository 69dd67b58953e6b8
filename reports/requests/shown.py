"""Base of all results: printed as the command does, and in a notebook with their mechanism."""

from rich.console import Console

from reports.output.printed import as_html, as_text


class Shown:
    """A result that is printed as its table, and that a notebook shows with its mechanism.

    A result equals itself alone: its series are not compared.
    """

    def show(self, console: Console) -> None:
        """Print the result as the command does."""
        raise NotImplementedError

    def _drawn(self) -> str:
        """The mechanism as SVG; "" where there is none to draw."""
        return ""

    def __str__(self) -> str:
        return as_text(self.show)

    def __repr__(self) -> str:
        return str(self)

    def _repr_html_(self) -> str:
        return as_html(self._drawn(), self.show)

    __eq__ = object.__eq__
    __hash__ = object.__hash__
