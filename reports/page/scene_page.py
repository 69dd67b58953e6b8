"""The page of a solved scene: one HTML file with its motion, and its forces where asked for, or
with its free motion, or with its elastic links."""

from __future__ import annotations

from collections.abc import Mapping

from analytic.elastic.elastic_motion import ElasticHistory
from analytic.free.free_motion import FreeMotion
from models.scene import Scene
from reports.describe.elastic_course import ElasticCourse
from reports.output.numbers import count
from reports.output.provenance import crankcheck_version
from reports.page.build import Head, assembled
from reports.page.scene_sections import elastic, forces, motion
from reports.page.scene_sections import free as free_motion


def scene_page(scene: Scene, figures: Mapping[str, bytes] | None = None) -> str:
    """The page of a scene; ``figures`` are those of its forces (SVG files by name), None for a page
    without forces.

    Raises CrankcheckError where the driver goes through no turn, or there are no forces.
    """
    sections = [motion.build(scene, with_forces=figures is not None)]
    if figures is not None:
        sections.append(forces.build(scene, figures))
    return assembled(_head(scene, "the closed form"), sections)


def free_page(free: FreeMotion, figures: Mapping[str, bytes]) -> str:
    """The page of a free motion; ``figures`` are SVG files by name."""
    words = f"free motion over {free.until_s:g} s"
    return assembled(_head(free.scene, words), [free_motion.build(free, figures)])


def elastic_page(motion: ElasticHistory, fine: ElasticCourse, figures: Mapping[str, bytes]) -> str:
    """The page of a motion with elastic links; ``fine`` is the same closely sampled, ``figures``
    are SVG files by name. Raises CrankcheckError where there is no motion."""
    links = count(len(motion.scene.elastic), "elastic link")
    return assembled(_head(motion.scene, links), [elastic.build(motion, fine, figures)])


def _head(scene: Scene, what: str) -> Head:
    counts = {"link": scene.links, "load": scene.loads, "spring": scene.springs}
    return Head(
        title=f"crankcheck: {scene.name}",
        facts=(
            what,
            *(count(len(each), noun) for noun, each in counts.items() if each),
            f"crankcheck {crankcheck_version()}",
        ),
        made="",
        first="motion",
    )
