"""Profile of a cam as DXF, SVG and CSV, for machine tools and drawing programs, in millimetres."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from analytic.cams.profile import CamContact, Plane, touch
from models.scene.cams import Cam, OscillatingFollower
from reports.output.write import clean

MM = 1000.0
COLUMNS = "phi_deg,x_m,y_m,pitch_x_m,pitch_y_m,lift,radius_m,pressure_deg"
"""Columns of the CSV, in the frame of the cam; the pitch curve of a flat face is its profile; the
lift is in m, or in rad of an oscillating follower."""
Curves = Mapping[str, Plane]
"""Closed curves by layer, in the frame of the cam [m]."""


def profile_files(name: str, cam: Cam, points: int) -> dict[str, str]:
    """Return all files by name, with so many points that are evenly spaced over the cam's angle."""
    contact = touch(cam, np.linspace(0.0, math.tau, points, endpoint=False))
    curves = {"PROFILE": contact.on_cam(contact.contact)}
    if contact.pitch is not None and cam.follower.roller_m:
        curves["PITCH"] = contact.on_cam(contact.pitch)
    return {
        "profile.dxf": _dxf(cam, curves),
        "profile.svg": _svg(name, cam, curves),
        "profile.csv": _csv(contact, curves),
    }


def _csv(contact: CamContact, curves: Curves) -> str:
    """The points with lift, radius of curvature and pressure angle."""
    profile, pitch = curves["PROFILE"], curves.get("PITCH", curves["PROFILE"])
    columns = [
        np.degrees(contact.phi), profile.real, profile.imag, pitch.real, pitch.imag,
        contact.lift.value, contact.radius_m, np.degrees(contact.pressure_rad),
    ]  # fmt: skip
    rows = (",".join(f"{x:.15g}" for x in row) for row in np.array(columns).T.tolist())
    return "\n".join([COLUMNS, *rows, ""])


def _dxf(cam: Cam, curves: Curves) -> str:
    """Curves and base circle as entities of AutoCAD's release 12 (DXF reference, 1992: POLYLINE,
    VERTEX, CIRCLE)."""
    pairs: list[tuple[int, object]] = [(0, "SECTION"), (2, "ENTITIES")]
    for layer, curve in curves.items():
        pairs += [(0, "POLYLINE"), (8, layer), (66, 1), (70, 1)]
        for x, y in (MM * np.array([curve.real, curve.imag])).T.tolist():
            pairs += [(0, "VERTEX"), (8, layer), (10, f"{x:.9f}"), (20, f"{y:.9f}")]
        pairs += [(0, "SEQEND"), (8, layer)]
    pairs += [(0, "CIRCLE"), (8, "BASE"), (10, 0.0), (20, 0.0), (40, f"{MM * cam.base_m:.9f}")]
    pairs += [(0, "ENDSEC"), (0, "EOF")]
    return "".join(f"{code:>3}\n{value}\n" for code, value in pairs)


def _svg(name: str, cam: Cam, curves: Curves) -> str:
    """The curves and the base circle at their size, a user unit a millimetre."""
    reach = MM * max(float(np.abs(curve).max()) for curve in curves.values()) + 5.0
    size, looks, paths = f"{2.0 * reach:.3f}", {"PROFILE": "0.35", "PITCH": "0.18"}, []
    for layer, curve in curves.items():
        places = " ".join(f"{MM * p.real:.6f},{-MM * p.imag:.6f}" for p in curve.tolist())
        paths.append(
            f'<polygon id="{layer.lower()}" points="{places}" stroke-width="{looks[layer]}"/>'
        )
    paths.append(f'<circle id="base" r="{MM * cam.base_m:.6f}" stroke-width="0.18"/>')
    paths.append('<path id="centre" d="M-3,0H3M0,-3V3" stroke-width="0.18"/>')
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{size}mm" height="{size}mm" '
        f'viewBox="{-reach:.3f} {-reach:.3f} {size} {size}" fill="none" stroke="black">\n'
        f"<title>{clean(name)}: profile</title>\n" + "\n".join(paths) + "\n</svg>\n"
    )


def unit_of(cam: Cam) -> str:
    """Return the unit of its lift."""
    return "rad" if isinstance(cam.follower, OscillatingFollower) else "m"
