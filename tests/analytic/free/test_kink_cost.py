"""What a kink of a load costs: how often the mechanism is worked out for it."""

import numpy as np
import pytest

from analytic.dyads.chunk import Chunk
from analytic.free.integration import Integration
from analytic.free.release import release
from analytic.prepared import Prepared
from models.files import load_scene


def test_a_kink_over_the_angle_asks_for_the_mechanism_about_twice(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Two rounds of Newton's method; where the kinks are is asked of the driver alone."""
    asked: list[int] = []
    windows: list[int] = []
    chunk, run = Prepared.chunk, Integration.run

    def counted(self: Prepared, *given: object) -> Chunk:
        asked.append(1)
        return chunk(self, *given)  # type: ignore[arg-type]

    def followed(self: Integration) -> object:
        before = len(asked)
        found = run(self)
        windows.append(len(found.windows))
        assert len(asked) - before < 3 * len(found.windows)
        return found

    monkeypatch.setattr(Prepared, "chunk", counted)
    monkeypatch.setattr(Integration, "run", followed)
    motion = release(load_scene("engine-flywheel"), 0.03001)
    assert min(windows) > 35
    assert np.isfinite(motion.at(np.array([0.03])).links["crank"].theta).all()
