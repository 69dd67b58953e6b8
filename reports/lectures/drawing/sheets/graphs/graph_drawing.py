"""Three graphs drawn from the reference and, beside them, from a log, and what each is off by."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from analytic.lectures.drawings.graphical import Method, ThreeGraphs, three_graphs
from models.motion import Order
from reports.lectures.drawing.sheets.graphs.graph_log import GraphLog, needed
from reports.lectures.drawing.sheets.graphs.graph_span import GraphSpan

READ: dict[Method, Order] = {"chords": 0, "tangents": 0, "integration": 2}
"""Of which order readings are drawn from."""


@dataclass(frozen=True)
class DrawnGraphs:
    """A quantity and its rates over a range in equal parts, drawn ``by`` a method: of the
    reference, and of a log where there is one. ``sizes`` are what errors are over."""

    span: GraphSpan
    by: Method
    parts: int
    reference: ThreeGraphs
    log: GraphLog | None
    logged: ThreeGraphs | None
    sizes: tuple[float, float, float]

    @property
    def derived(self) -> tuple[Order, Order]:
        """The orders that were not read, in the order of drawing."""
        return (1, 0) if self.by == "integration" else (1, 2)

    def off(self, drawn: ThreeGraphs, order: Order) -> float:
        """What a graph is off by the exact curve at most, over the size."""
        graph = drawn.graphs[order]
        exact = self.span.exact(order, graph.x)
        return float(np.abs(graph.y - exact).max()) / self.sizes[order]

    def own_part(self, order: Order) -> float:
        """What the log's graph is off that of the reference, over the size: the method is in
        both."""
        assert self.logged is not None
        one, other = self.logged.graphs[order], self.reference.graphs[order]
        return float(np.abs(one.y - other.y).max()) / self.sizes[order]


def drawn_graphs(of: GraphSpan, by: Method, parts: int, log: GraphLog | None = None) -> DrawnGraphs:
    """Draw. Raises CrankcheckError for a log that has not what the method reads."""
    x = of.divisions(parts)
    start = float(of.exact(0, x[:1])[0]), float(of.exact(1, x[:1])[0])
    reference = three_graphs(by, x, of.exact, start)
    logged = None
    if log is not None:
        needed(log, READ[by], parts)
        logged = three_graphs(by, x, log.at, start)
    return DrawnGraphs(of, by, parts, reference, log, logged, of.sizes())
