"""The map of a log whose column of times, or whose bodies, can not be told from names: a form."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from models.errors import CrankcheckError
from models.scene import Scene
from reports.logs.columns import Columns
from reports.logs.map_file import HEAD, Map, file_lines, told_lines, toml_text
from reports.logs.meanings import wanted
from reports.logs.names import meaning
from reports.logs.scene_names import SceneNames
from reports.logs.time_columns import time_of


def blank_map(columns: Columns, scene: Scene, map_: Map) -> tuple[str, str] | None:
    """A form of the map of a log, all its columns in it, with what is to be filled in yet.

    None where the names, and the map that it is read by, tell the times and something of the scene:
    what is wrong then is another fault, and where the map names a column that is not there.
    """
    told = {one.column: one for one in map_.channel}
    if not {*told, map_.time.column or next(iter(columns.raw))} <= set(columns.raw):
        return None
    left_out = {one.column for one in map_.channel if one.ignore}
    times = {map_.time.column} if map_.time.column else _times(columns.raw, left_out)
    others = [name for name in columns.raw if name not in times]
    is_wanted = wanted(scene, map_)
    bodies = [name for name in others if is_wanted(name)]
    if times and bodies:
        return None
    lacks = [
        *([] if times else ["the column of the times, in [time]"]),
        *([] if bodies else ["of at least one column what it is of, in a [[channel]]"]),
    ]
    named = SceneNames(scene)
    lines = [
        *HEAD,
        f"# Still to be filled in: {'; '.join(lacks)}.",
        f"# The scene has {', '.join(map(toml_text, _bodies(scene)))}.",
        "",
        *(file_lines(map_.file) or ["# [file]", '# decimal = ","', ""]),
        *_time_lines(map_, times, columns.raw),
    ]
    for name in others:
        lines.append("")
        if name in told:
            lines += told_lines(told[name])
        elif name in bodies:
            lines.append(f"# {toml_text(name)} is taken as its name says")
        else:
            lines += [
                f"# {_why_not(name, named)}",
                "# [[channel]]",
                f"# column = {toml_text(name)}",
            ]
            lines += ['# of = ""', '# kind = ""', '# unit = ""']
    return "\n".join(lines) + "\n", "; ".join(lacks)


def _times(names: Iterable[str], left_out: Iterable[str]) -> set[str]:
    """The columns that are of times by their names; one that contradicts itself is none."""
    found: set[str] = set()
    for name in set(names).difference(left_out):
        try:
            if time_of(name):
                found.add(name)
        except CrankcheckError:
            continue
    return found


def _time_lines(map_: Map, times: set[str], names: Iterable[str]) -> Sequence[str]:
    """The table of times; with remarks for what is to be filled in."""
    told = map_.time.model_dump(exclude_defaults=True)
    lines = ["[time]", *(f"{key} = {toml_text(value)}" for key, value in told.items())]
    if not times:
        lines += [f"# column = {toml_text(name)}" for name in names]
        lines.append('# unit = "s"')
    return lines


def _bodies(scene: Scene) -> Sequence[str]:
    """All that a column can be of."""
    points = (name for name in scene.pins if name not in scene.ground)
    return list(dict.fromkeys([*scene.links, *points, *scene.sliders]))


def _why_not(name: str, named: SceneNames) -> str:
    """Why nothing is made of a column, in a line."""
    try:
        found = meaning(name, named)
    except CrankcheckError as error:
        return " ".join(str(error).split())
    text = found if isinstance(found, str) else "it is of a point of the ground"
    return " ".join(text.split())
