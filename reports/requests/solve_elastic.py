"""`crankcheck solve` of a scene with elastic links, driven or let go: how they bend over time."""

from __future__ import annotations

from rich.console import Console

from analytic.elastic.sampled import ElasticHistory
from models.array import Array
from models.errors import CrankcheckError, harmless
from models.scene import Scene
from reports.describe.elastic_course import (
    closely_sampled,
    drawn_course,
    elastic_course,
    elastic_frame,
    energy_columns,
)
from reports.describe.elastic_words import certainty
from reports.output.console import say, say_whole
from reports.output.frame_file import write_frame
from reports.output.write import check_folder, write
from reports.requests.elastic_choice import ElasticChoice
from reports.requests.elastic_text import show_elastic
from reports.requests.options import given
from reports.requests.solve_free import free_instants, refuse_turns
from reports.requests.solve_lengths import PAGE, instants_of, refuse_times
from reports.requests.solve_options import SolveOptions


def run_solve_elastic(
    scene: Scene, request: SolveOptions, asked: ElasticChoice, console: Console
) -> None:
    """Show or write the motion. Raises CrankcheckError for what can not be asked of it."""
    _check(scene, request)
    time_s = (free_instants if scene.is_free else instants_of)(scene, request)
    motion = asked.motion(scene, float(time_s[-1]))
    if request.output is None and request.figures is None:
        shown = elastic_course(motion, time_s)
        fine = elastic_course(motion, closely_sampled(scene, motion.until_s))
        show_elastic(console, motion, shown, fine, certainty(motion), forces=request.forces)
        more = "Points, and more digits: -o out.csv, .parquet or .xlsx; moving: -o out.html"
        say(console, more, "dim")
        return
    for line in _written(motion, time_s, request):
        say_whole(console, harmless(line))


def _check(scene: Scene, request: SolveOptions) -> None:
    """Refuse what is asked of rigid links alone. Raises CrankcheckError."""
    (refuse_turns if scene.is_free else refuse_times)(scene, request)
    for option in given(request, "at_deg", "at_m", "clockwise", "along"):
        raise CrankcheckError(
            f"{option}: {scene.name} has elastic links ({', '.join(scene.elastic)}), whose "
            f"places depend on how they came there; leave {option} out, and give --turns and "
            "--steps-per-turn"
        )
    is_page = request.output is not None and request.output.suffix.lower() == PAGE
    for option in given(request, "steps_per_turn", "steps") if is_page else ():
        raise CrankcheckError(
            f"-o {request.output}: a page has its own samples; leave out {option}"
        )
    if request.figures is not None:
        from reports.figures.elastic.course_figures import elastic_figure_files

        check_folder(request.figures, "--figures", elastic_figure_files())


def _written(motion: ElasticHistory, time_s: Array, request: SolveOptions) -> list[str]:
    """Write what was asked for; what was written, a line each."""
    told, scene, output = [], motion.scene, request.output
    if request.figures is not None:
        from reports.figures.elastic.writing import written_elastic_figures

        course = drawn_course(motion, closely_sampled(scene, motion.until_s))
        told.append(written_elastic_figures(course, request.figures))
    if output is not None and output.suffix.lower() == PAGE:
        from reports.requests.scene_report import elastic_page_of

        write(output, elastic_page_of(motion))
        told.append(f"{output}: {scene.name} with elastic links over {motion.until_s:.6g} s")
    elif output is not None:
        frame = elastic_frame(elastic_course(motion, time_s), with_forces=request.forces)
        frame = frame.assign(**energy_columns(motion, time_s))
        write_frame(output, frame, "motion", {"scene": scene.name, "source": scene.source})
        told.append(f"{output}: {time_s.size} samples of {scene.name} with elastic links")
    return told
