"""A fault in the log of a stranger is out, and the command names it with its channels: every other
fault is planted in tests/reports/causes."""

import json
from dataclasses import replace
from pathlib import Path

import pytest

from tests.reports.own_log.conftest import Judge
from tests.worlds.stranger import LINKAGES
from tests.worlds.stranger_guises import COLUMNS, PER_TURN
from tests.worlds.stranger_log import Dress, even, logged
from tests.worlds.tiers import few


@pytest.mark.parametrize(
    "scene", few(LINKAGES, ["fourbar-lecture-1"], "channels of a block and of a second loop")
)
def test_rates_half_a_sample_late_are_told_and_the_map_that_is_told_mends_it(
    scene: str, judge: Judge, tmp_path: Path
) -> None:
    linkage, file = LINKAGES[scene], tmp_path / "judged.json"
    late_s = -linkage.period_s / PER_TURN / 2.0
    columns = [
        replace(each, later_s=late_s) if each.what in ("omega", "vx", "vy") else each
        for each in COLUMNS[scene]
    ]
    log = Dress().text(logged(linkage, even(linkage, 2.0, PER_TURN), columns))
    told = judge(scene, log, "--json", file, code=1).stdout
    (cause,) = json.loads(file.read_text(encoding="utf-8"))["causes"]
    assert cause["text"][:40] in " ".join(told.split())
    assert "none that is known" not in told
    assert "belong 0.50 samples" in cause["text"]
    assert "earlier" in cause["text"]
    late = {column.header for column in columns if column.later_s}
    assert set(cause["columns"]) == late - {"crank_omega_rad_s"}  # which is constant
    mends = [f'[[channel]]\ncolumn = "{column}"\ndelay_s = {late_s!r}' for column in late]
    judge(scene, log, mapped="\n".join(mends))
