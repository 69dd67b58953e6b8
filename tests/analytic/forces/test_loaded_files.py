"""Every file with loads or friction gives forces or a message, whatever stands in it."""

from __future__ import annotations

import random

import numpy as np
import pytest

from analytic.forces.kinetostatics import forces
from models.errors import CrankcheckError
from models.files import parse_scene
from tests.analytic.forces.test_self_locking import STEEP
from tests.models.test_friction import RUBBING
from tests.models.test_loads import PRESS
from tests.worlds.mutation import MUTATIONS
from tests.worlds.tiers import slowly


@pytest.mark.parametrize("files", [40, slowly(600, reason="changes at random")])
@pytest.mark.parametrize("sound", [PRESS, RUBBING, STEEP], ids=["loads", "friction", "locking"])
def test_a_changed_file_gives_forces_or_a_message(sound: str, files: int) -> None:
    """Warnings are errors here, so that no number overflows unseen either."""
    solved = refused = 0
    for number in range(files):
        rng = random.Random(number)
        text = sound
        for _ in range(rng.choice((1, 1, 2, 3))):
            text = rng.choices(list(MUTATIONS), list(MUTATIONS.values()))[0](rng, text)
        try:
            scene = parse_scene(text, "changed")
            period = scene.driver.law.period_s
            found = forces(scene, np.linspace(0.01, 0.99, 5) * period, skip_dead_points=True)
            assert not np.isnan(found.bound.torque).any()
            solved += 1
        except CrankcheckError:
            refused += 1
    assert min(solved, refused) > 0.2 * files, (solved, refused)
