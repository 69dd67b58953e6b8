"""The laws of cams over a turn, and the pressure angle round their profiles."""

import math

import numpy as np

from analytic.cams.outline import touched
from models.scene.cams import Cam
from reports.page.sections.section import Section
from reports.results.overview import Report

SAMPLES = 360


def build(report: Report) -> Section | None:
    """Return the section; None where no scene has a cam."""
    cams: dict[Cam, dict[str, object]] = {}
    for scene in filter(None, report.scenes.values()):
        for pair in scene.cams.values():
            contact, points = touched(scene, pair, SAMPLES)
            law = pair.profile.law.at(np.linspace(0.0, math.tau, SAMPLES, endpoint=False))
            curves = [law.value, law.first, law.second, law.third]
            curves.append(np.degrees(np.abs(contact.pressure_rad)))
            facts = {"name": f"{scene.name}, {pair.name}", "unit": "m" if pair.slider else "rad"}
            drawn = {"x": points.real, "y": points.imag, "curves": curves}
            cams.setdefault(pair.profile, facts | drawn)
    own = {"cams": list(cams.values())}
    scripts = ("charts.js", "cams.js")
    return Section("cams", "Cams", "cams.html", own, own, scripts, plotly=True) if cams else None
