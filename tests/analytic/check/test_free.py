"""What the equations of motion say of a free mechanism, against a closed form."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from analytic.check.free import centres
from analytic.free.window_chain import ChainMotion
from models.errors import CrankcheckError
from models.files import load_scene
from models.poses import centre_of, frames
from models.scene import Same
from models.window_chain import Chain
from reports.compare.beside import truth_of


@pytest.mark.parametrize("chain", [Chain(1), Chain(3, 0.5, 2.0, 3.0, -0.7)])
def test_a_chain_of_windows_falls_as_its_closed_form(chain: Chain) -> None:
    free = ChainMotion(chain)
    duration_s = 0.1 * free.period_s
    motion = free.motion(np.array([0.0, duration_s]))
    scene, (start, end) = chain.scene(), (motion.state(0), motion.state(1))
    found = centres(scene, start, duration_s, 40)
    placed = frames(scene, end)
    for name, place in found.items():
        wanted = placed[name].at(centre_of(scene, name))
        assert place == pytest.approx(wanted, abs=1e-5 * chain.length_m)


def test_what_has_no_mass_is_said() -> None:
    scene = load_scene("fourbar-lecture-1")
    links = {
        name: replace(link, mass_kg=0.0, inertia_kg_m2=0.0) for name, link in scene.links.items()
    }
    with pytest.raises(CrankcheckError, match="moves nothing that has a mass"):
        centres(replace(scene, links=links), truth_of(Same(scene)).start, 1e-3, 1)
