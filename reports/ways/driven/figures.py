"""Figures of driven scenes, some of which show others as well."""

from reports.figures import convergence, error_parts, mechanism, work_precision
from reports.figures.drawing import Drawing

BOTH = ("driven", "free")
FIGURES = {
    "work-precision": Drawing(work_precision.draw, work_precision.draw_all, ("driven", "elastic")),
    "convergence": Drawing(convergence.draw, convergence.draw_all, (*BOTH, "elastic")),
    "facets": Drawing(None, convergence.draw_over_facets, ("facets",)),
    "split": Drawing(error_parts.draw),
    "mechanism": Drawing(mechanism.draw, drives=BOTH),
    "profile": Drawing(None, work_precision.draw_profile),
}
