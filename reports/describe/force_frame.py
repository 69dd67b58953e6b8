"""Forces as columns with units in their names, to stand beside those of a motion.

``C_rod_fx_n`` is the force of pin C on the rod [N], along x; ``C_rod_f_n`` its size.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from models.array import Array
from models.motion import Forces


def acted_on(acting: Forces) -> Iterator[tuple[str, str, str, Array]]:
    """Each pin, the body whose force is told, from what, and that force [N], (T, 2).

    Where two bodies meet, it is the one on the second, from the first; of more, it is that on each,
    from the pin.
    """
    for point, bodies in acting.pins.items():
        names = list(bodies)
        told = names[1:] if len(names) == 2 else names
        for name in told:
            yield point, name, names[0] if len(names) == 2 else "pin", bodies[name]


def force_columns(acting: Forces, *, lengths: bool = True) -> dict[str, Array]:
    """Columns by name: the driving torque or force, pins by point and body, sliders, and
    what rubs; vectors also by length."""
    columns = {"torque_n_m" if acting.drive_unit == "N m" else "drive_force_n": acting.torque}
    for point, body, _, force in acted_on(acting):
        stem = f"{point}_{body.replace(' ', '_')}"
        columns[f"{stem}_fx_n"], columns[f"{stem}_fy_n"] = force[:, 0], force[:, 1]
        if lengths:
            columns[f"{stem}_f_n"] = np.hypot(force[:, 0], force[:, 1])
    for name, slider in acting.sliders.items():
        columns[f"{name}_slider_normal_n"] = slider.normal
        columns[f"{name}_slider_moment_n_m"] = slider.moment
    for joint, series in acting.friction.items():
        is_slider = joint in acting.sliders
        columns[f"{joint}_slider_friction_n" if is_slider else f"{joint}_friction_n_m"] = series
    return columns
