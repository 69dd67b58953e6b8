"""A log beside the drawn reference: read as `judge` does, with the reference for its errors."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from models.array import Array
from models.errors import CrankcheckError, cut, few
from models.scene import Scene
from reports.compare.beside import Truth
from reports.logs.channel import OwnLog, Reading
from reports.logs.columns import read_columns
from reports.logs.map_file import Map
from reports.logs.meanings import understood, wanted
from reports.own_log.log_limits import LogRequest, log_kind

LOGGED = "#8e24aa"
"""The colour of everything logged."""
ELSEWHERE = 0.1
"""Largest error of a log of the scene at its start: in radians, or longest links; of rates at the
driver's largest speed."""


@dataclass(frozen=True)
class SheetLog:
    """A log of a scene, and its reference, which is known as long as the log is."""

    log: OwnLog
    truth: Truth
    driver_rad: Callable[[Array], Array]
    """The driver's angle at times [rad], by its law or its free motion."""

    @staticmethod
    def of_file(scene: Scene, path: Path, map_: Map, drawing: str) -> SheetLog:
        """Read a file for a ``drawing``, named in the plural.

        Raises
        ------
        CrankcheckError
            A scene whose links bend; a file that can not be read, or has nothing of the scene; a
            log of another motion.
        """
        if scene.elastic:
            raise CrankcheckError(
                f"--log {path}: {few(scene.elastic, 4)} of {scene.name} bends or stretches, and "
                f"{drawing} are those of rigid links; `crankcheck judge` holds such a log to the "
                "beam"
            )
        columns = read_columns(path, map_.layout, wanted(scene, map_))
        return SheetLog.of_log(understood(columns, scene, map_))

    @staticmethod
    def of_log(log: OwnLog) -> SheetLog:
        """Take a log that was read. Raises CrankcheckError for another motion, too."""
        if log.scene.is_free:
            known, truth, _ = log_kind(log.scene).truth(log, LogRequest())
            link = log.scene.driver.link
            found = SheetLog(known, truth, lambda time_s: truth.at(time_s).links[link].theta)
        else:
            law = log.scene.driver.law
            found = SheetLog(log, Truth(log.scene, bound=False), lambda time_s: law.at(time_s)[0])
        found.refuse_another()
        return found

    def refuse_another(self) -> None:
        """Refuse a log that does not begin as its scene moves: an engine begins there, however far
        it departs later. Places decide, or, without places, rates; an engine's first accelerations
        are its own affair. Raises CrankcheckError."""
        order = min((each.channel.kind.order for each in self.log.readings), default=2)
        if order == 2:
            return
        begins = [each.first(1) for each in self.log.readings if each.channel.kind.order == order]
        worst = max(begins, key=self._share)
        if not self._share(worst) <= ELSEWHERE:
            channel, scene = worst.channel, self.log.scene
            unit = ("rad" if channel.kind.body_kind == "link" else "m") + ("", "/s")[order]
            raise CrankcheckError(
                f"{self.log.source}: in its first row, t = {self.log.time_s[0]:.6g} s, "
                f"{channel.name} (column {cut(channel.column)!r}) is "
                f"{abs(float(worst.error(self.truth)[0])):.3g} {unit} off where {scene.name} has "
                "it: it is of another scene, speed, start or unit; name its own, or count times "
                "from the start of the motion"
            )

    def _share(self, begin: Reading) -> float:
        """The error of a reading in the first row, as a pure number."""
        kind, scene = begin.channel.kind, self.truth.scene
        scale = 1.0 if kind.body_kind == "link" else scene.longest_m
        scale *= scene.pace_rad_s**kind.order
        return abs(float(begin.error(self.truth)[0])) / scale
