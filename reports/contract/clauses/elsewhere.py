"""A mechanism does not know where it stands: turned, moved, mirrored or larger it errs as much."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from analytic.structure.mobility import sides_of
from models.moved_scene import mirrored, moved, rotated, scaled
from models.scene import Scene
from reports.contract.clause import Clause
from reports.contract.clauses.physics import pure_errors, unlike
from reports.contract.subject import NotTriedError, Subject

CHANGES: Mapping[str, Callable[[Scene], Scene]] = {
    "turned by 0.7 rad": lambda scene: rotated(scene, 0.7),
    "moved by (3, -2) m": lambda scene: moved(scene, (3.0, -2.0)),
    "mirrored": lambda scene: mirrored(scene, sides_of(scene)),
    "ten times as large": lambda scene: scaled(scene, 10.0),
    "a tenth as large": lambda scene: scaled(scene, 0.1),
}


def _elsewhere(subject: Subject) -> Iterator[str]:
    plain = pure_errors(subject)
    for words, change in CHANGES.items():
        try:
            yield from unlike(plain, pure_errors(subject.in_scene(change(subject.scene))), words)
        except NotTriedError as refused:
            yield f"{words}, it is refused: {refused}"


CLAUSES = (
    Clause(
        "EC61",
        "a scene that is turned, moved, mirrored or scaled errs as much",
        "A sign or a number that suits one scene alone is seen on another, or not at all.",
        "Look for signs of angles, lines that are taken as level, and tolerances in metres.",
        _elsewhere,
    ),
)
