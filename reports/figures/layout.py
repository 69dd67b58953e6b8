"""Requested layout of figures: the options of every command that draws some."""

from collections.abc import Callable
from contextvars import ContextVar, copy_context
from dataclasses import dataclass, fields
from functools import wraps
from typing import Annotated, Any

from rich.console import Console

from models.errors import CrankcheckError, shown, suggestion

FONT = "DejaVu Sans"
"""Font of matplotlib: a figure looks the same wherever it is drawn."""
DOTS_PER_IN: dict[str, float | str] = {"svg": "figure", "pdf": "figure", "png": 600.0}
"""Resolution by format; the figure's own where no pixels are written."""
LEAST_MM, MOST_MM = 65.0, 500.0


@dataclass(frozen=True, kw_only=True)
class Layout:
    """Options of figures, which requests inherit; `laid_out` applies them."""

    no_title: Annotated[bool, "Figures: without their title."] = False
    no_notes: Annotated[bool, "Figures: without the notes under them."] = False
    width_mm: Annotated[float | None, "Figures: width, such as 85 for a column of a paper."] = None
    font: Annotated[str, "Figures: a font that is installed here."] = FONT
    format: Annotated[str, "Figures: svg, pdf, png, with commas."] = "svg,pdf"

    @property
    def fonts(self) -> tuple[str, ...]:
        """Fonts in the order in which a letter is searched: `FONT` has nearly all."""
        return tuple(dict.fromkeys((self.font, FONT)))

    @property
    def formats(self) -> list[str]:
        """Formats of the files, each once."""
        return list(dict.fromkeys(self.format.lower().replace(" ", "").split(",")))

    @property
    def in_words(self) -> str:
        """Endings of the files in words."""
        return " and ".join(f".{kind}" for kind in self.formats)

    def across(self, width_in: float) -> float:
        """Return the requested width in place of a figure's own [inch]."""
        return width_in if self.width_mm is None else self.width_mm / 25.4


DEFAULT = Layout()
LAYOUT = ContextVar("LAYOUT", default=DEFAULT)
"""Layout of the figures that are drawn and written now."""
Run = Callable[[Any, Console, Console], int]


def laid_out(run: Run) -> Run:
    """Apply a request's layout within its `run`. Raises CrankcheckError for a layout that can not
    be drawn, and where the request draws no figure."""

    @wraps(run)
    def with_layout(request: Any, console: Console, progress: Console) -> int:
        changed = [n.name for n in fields(Layout) if getattr(request, n.name) != n.default]
        places = [getattr(request, n) for n in ("figures", "family") if hasattr(request, n)]
        if changed and not any(places or [request.output]):
            where, option = "--figures" if places else "-o", changed[0].replace("_", "-")
            raise CrankcheckError(f"--{option}: no figure is drawn; give {where} DIR as well")
        _check(request)
        own = copy_context()
        own.run(LAYOUT.set, request)
        return own.run(run, request, console, progress)

    return with_layout


def _check(layout: Layout) -> None:
    for name in layout.formats:
        if name not in DOTS_PER_IN:
            raise CrankcheckError(f"--format: {shown(name)} is unknown; give svg, pdf or png")
    if layout.width_mm is not None and not LEAST_MM <= layout.width_mm <= MOST_MM:
        span = f"{LEAST_MM:g} to {MOST_MM:g}"
        raise CrankcheckError(f"--width-mm: found {layout.width_mm:g}; give {span}")
    if layout.font != FONT:
        from matplotlib.font_manager import get_font_names  # a second

        if layout.font not in (names := get_font_names()):
            hint = suggestion(layout.font, names, "there are")
            raise CrankcheckError(f"--font: {shown(layout.font)} is not installed here; {hint}")
