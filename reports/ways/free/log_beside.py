"""A user's log of free motion, beside the motion that masses and forces give."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from models.array import Array
from models.motion import Motion, Order
from reports.compare.free.free_beside import FreeBeside
from reports.compare.free.free_truth import FreeTruth
from reports.compare.tracks import Track, tracks
from reports.logs.channel import OwnLog, Reading
from reports.logs.kinds import KINDS
from reports.logs.log_beside import LogBeside
from reports.logs.logged_motion import logged_motion
from reports.quantities.free import GEOMETRY
from sim.engine import Run


@dataclass(frozen=True)
class FreeLogBeside(LogBeside, FreeBeside):
    """A log as far as it goes, which is where the truth of it is known: ``unknown`` rows after it
    were left out.

    Geometry is that of the readings as they are, and not of what else was put on the truth at the
    same time: where the phase has run away, that is of another position.
    """

    log: OwnLog = field(kw_only=True)
    unknown: int = field(kw_only=True)

    @staticmethod
    def of_log(log: OwnLog, truth: FreeTruth, run: Run) -> FreeLogBeside:
        """The log beside the truth, and the run that it amounts to."""
        assert run.motion is not None
        return FreeLogBeside(
            truth,
            run,
            run.motion,
            step_s=run.dt_s,
            whole_run=run,
            free=truth.free,
            log=log,
            unknown=log.left_out,
        )

    @property
    def left_out(self) -> int:
        return self.unknown

    @property
    def no_geometry(self) -> str:
        driver = self.scene.driver.link
        if not (self.has_crank and self._says("link", driver, "angle")):
            return f"no geometry: the log has no angle of {driver} at the times of its rows"
        if self.free.driver_tells or self._holds((0,)):
            return ""
        return (
            f"no geometry: the angle of {driver} alone does not say where {self.scene.name} is; it "
            "takes the angles of all links, and both coordinates of all points that move"
        )

    @property
    def tells_momentum(self) -> bool:
        return self._holds((0, 1))

    @cached_property
    def at_crank(self) -> Motion:
        own = self.motion.links
        rest = {name: link for name, link in self.reference.links.items() if name not in own}
        return self.free.beside(replace(self.motion, links={**own, **rest}))

    def tracks(self, quantities: Sequence[str], reference: Motion) -> tuple[Track, ...]:
        if tuple(quantities) != (GEOMETRY.name,):
            return super().tracks(quantities, reference)

        def off(reading: Reading) -> Array:
            return reading.channel.error(reading.values, reading.channel.expected(reference))

        places = [each for each in self._at_rows if each.channel.kind.order == 0]
        log = replace(self.log, readings=tuple(places))
        run = replace(self.run, motion=logged_motion(log, lambda _: reference, off))
        every = tracks(self.scene, run, reference, quantities)
        return tuple(track for track in every if not np.all(np.isnan(track.error)))

    @cached_property
    def _at_rows(self) -> tuple[Reading, ...]:
        """The readings that belong to the times of the rows."""
        own = self.log.time_s
        return tuple(each for each in self.log.readings if np.array_equal(each.instants, own))

    def _says(self, body_kind: str, body: str, *names: str) -> bool:
        """Whether there are readings of a body of all these names, for itself."""
        held = {
            each.channel.kind.name
            for each in self._at_rows
            if (each.channel.kind.body_kind, each.channel.of) == (body_kind, body)
            and not each.channel.relative_to
        }
        return held.issuperset(names)

    def _holds(self, orders: Sequence[Order]) -> bool:
        """Whether the log says of every link and every point that moves all of some orders."""
        scene = self.scene
        points = {*scene.pins, *(slider.point for slider in scene.sliders.values())}
        names = {
            kind: [name for of, name in KINDS if of == kind and KINDS[of, name].order in orders]
            for kind in ("link", "point")
        }
        return all(self._says("link", link, *names["link"]) for link in scene.links) and all(
            self._says("point", point, *names["point"]) for point in points - {*scene.ground}
        )
