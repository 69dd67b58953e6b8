"""The files of a judged log: its map, JSON, JUnit XML and page."""

import json
from collections.abc import Callable, Mapping
from pathlib import Path

from models.errors import CrankcheckError
from models.scene import Scene
from reports.logs.map_file import Map, map_text
from reports.output.formats import junit
from reports.output.numbers import finite
from reports.output.write import write
from reports.own_log.judged import JudgedLog, row_table
from reports.own_log.table import suite


def write_log_map(path: Path, log: Path, scene: Scene, map_: Map) -> str:
    """Write the map of a log, or a form of it to be filled in; return a description of it.

    Raises CrankcheckError for a log that no map alone can mend.
    """
    from reports.logs.columns import read_columns  # pandas, which takes a third of a second
    from reports.logs.meanings import blank_map, understood, wanted

    columns = read_columns(log, map_.layout, wanted(scene, map_))
    try:
        text = map_text(understood(columns, scene, map_), map_.file)
    except CrankcheckError:
        blank = blank_map(columns, scene, map_)
        if blank is None:
            raise
        text, lacks = blank
        write(path, text)
        return f"the columns of {log}, to be filled in: {lacks}; then judge with --map {path}"
    write(path, text)
    return f"what {log} says, as it was understood"


def contents(judged: JudgedLog, facts: Mapping[str, str]) -> dict[str, Callable[[], str]]:
    """The contents of the files, by option."""

    def page() -> str:
        from reports.page.log_page import log_page  # the drawings, which nothing else here needs

        return log_page(judged, facts)

    return {
        "--json": lambda: _json(judged, facts),
        "--junit": lambda: junit(suite(judged, facts)),
        "-o": page,
    }


def _json(judged: JudgedLog, facts: Mapping[str, str]) -> str:
    """Facts, verdict, findings, causes and errors; numbers that are not finite are null."""
    fit = judged.fit
    document = {
        "facts": facts,
        "log": judged.log.source,
        "scene": judged.scene.name,
        "verdict": judged.verdict,
        "drive": judged.drive,
        "fit": vars(fit) if fit else None,
        "samples": judged.log.time_s.size,
        "findings": [vars(finding) for finding in judged.findings],
        "causes": [{**vars(each), "correction": dict(each.correction)} for each in judged.causes],
        "not_judged": judged.not_judged,
        "not_used": dict(judged.log.unused),
        "notes": judged.notes,
        "errors": row_table(judged),
    }
    return json.dumps(finite(document), indent=2) + "\n"
