"""Scene files: find and read them, and report all faults of a file at once."""

from collections.abc import Iterable, Mapping
from os import PathLike, fspath
from pathlib import Path

from models.errors import CrankcheckError, SceneError, cut, few, nearest, shown
from models.files.assemble import SceneTable, faults_of_names, scene_from_table
from models.files.driver_table import DRIVERS, SLIDES, DriverTable
from models.files.faults import validated
from models.files.inputs import UnreadableError, names_in, regular_text, tables
from models.files.load_table import LOADS, LoadTable
from models.scene import Scene
from models.scene.driver import Controlled, Released

SCENE_FOLDER = Path(__file__).parents[1] / "scenes"
"""Folder of the folders of scene files, one for each kind."""
KINEMATICS = "kinematics"
"""Default kind of scenes; all its scenes are the default scenes."""


def shipped(kind: str = KINEMATICS) -> dict[str, Path]:
    """The scenes of a kind that come with crankcheck: name to file, in alphabetical order."""
    return {path.stem: path for path in sorted((SCENE_FOLDER / kind).glob("*.toml"))}


def kinds() -> list[str]:
    """List the kinds of shipped scenes, kinematics first."""
    names = sorted(path.name for path in SCENE_FOLDER.iterdir() if any(path.glob("*.toml")))
    return sorted(names, key=lambda name: name != KINEMATICS)


def every_shipped() -> dict[str, Path]:
    """The shipped scenes of all kinds: name to file."""
    return {name: path for kind in kinds() for name, path in shipped(kind).items()}


def names_of_scenes(names: str | Iterable[str]) -> list[str]:
    """Return names and paths of scenes, each once; the name of a kind stands for all its scenes
    except `run_where_named`. Raises CrankcheckError for other values than a name or several."""
    known = kinds()
    written_out = (
        [one for one in shipped(name) if one not in run_where_named(name)]
        if name in known
        else [name]
        for name in names_in(names, "scenes")
    )
    return list(dict.fromkeys(name for each in written_out for name in each))


def reference_alone(kind: str) -> list[str]:
    """List the shipped scenes of a kind for the reference alone: their friction follows from the
    reactions, and no engine runs them."""
    return [name for name, scene in _scenes_of(kind).items() if scene.coulomb_joints]


def run_where_named(kind: str) -> list[str]:
    """List the shipped scenes of a kind that run only by their own name: scenes for the reference
    alone, and elastic links in free motion or with a controlled driver, whose reference takes
    longer than all others."""
    slow = Released | Controlled
    return [
        name
        for name, scene in _scenes_of(kind).items()
        if scene.coulomb_joints or (scene.elastic and isinstance(scene.driver.law, slow))
    ]


def _scenes_of(kind: str) -> dict[str, Scene]:
    return {name: read_scene(path) for name, path in shipped(kind).items()}


def load_scene(name_or_path: str | PathLike[str]) -> Scene:
    """Read a shipped scene by name, or a scene file by path.

    Parameters
    ----------
    name_or_path : str or path
        ``fourbar-lecture-1``, or a path, of any ending.

    Raises
    ------
    CrankcheckError
        No such scene (the message suggests the near names), or neither a name nor a path.
    SceneError
        A file with faults, all of them in one message.
    """
    return read_scene(find_scene(name_or_path))


def is_there(path: str) -> bool:
    """True if a path exists."""
    try:
        return bool(path) and Path(path).exists()
    except PermissionError:
        return True  # its folder may not be searched; reading it says so
    except (OSError, ValueError):  # a name too long for the system, or with a null byte
        return False


def find_scene(name_or_path: str | PathLike[str]) -> Path:
    """Find the file of a shipped name, or of a path. Raises CrankcheckError as `load_scene`."""
    known = every_shipped()
    try:
        name_or_path = fspath(name_or_path)
        if not isinstance(name_or_path, str):
            raise TypeError
    except TypeError:
        raise CrankcheckError(
            f"scene: found {shown(name_or_path)}; give a shipped name or the path of a scene file"
        ) from None
    if name_or_path in known:
        return known[name_or_path]
    path = Path(name_or_path)
    if is_there(name_or_path):
        return path
    if name_or_path in kinds():
        several = few(shipped(name_or_path), 12)
        raise CrankcheckError(f"scene {name_or_path!r}: a kind of scenes; name one: {several}")
    near = nearest(path.stem, known, cutoff=0.5)
    hint = f"Did you mean {' or '.join(near)}?" if near else "`crankcheck scenes` lists the names."
    raise CrankcheckError(
        f"scene {cut(name_or_path, 80)!r}: neither a shipped scene nor a file. {hint}"
    )


def find_scenes(names: str | Iterable[str]) -> list[Path]:
    """Return the files of the named scenes and kinds. Raises CrankcheckError as `load_scene`."""
    return [find_scene(name) for name in names_of_scenes(names)]


def read_scene(path: Path) -> Scene:
    """Read one scene file. Raises SceneError with every fault of the file."""
    return parse_scene(read_text(path), str(path))


def scene_texts(names: str | Iterable[str]) -> dict[str, str]:
    """Return the text of each scene's file, by the scene's own name; all of kinematics for none.
    Raises CrankcheckError as `load_scene`."""
    texts: dict[str, str] = {}
    for given in names_of_scenes(names) or shipped():
        path = find_scene(given)
        text = read_text(path)
        texts[parse_scene(text, str(path)).name] = text
    return texts


def parse_scene(text: str, place: str) -> Scene:
    """Parse a scene from TOML text; ``place`` names it in messages. Raises SceneError."""
    try:
        raw = tables(text)
    except UnreadableError as error:
        raise SceneError(place, [str(error)]) from None
    faults: list[str] = []
    table = validated(SceneTable, raw, "", faults)
    driver = _driver(raw.get("driver"), faults)
    loads = _loads(raw.get("loads"), faults)
    faults += faults_of_names(raw)
    if faults or table is None or driver is None:
        raise SceneError(place, faults)
    return scene_from_table(table, driver, loads, place)


def read_text(path: Path) -> str:
    """Read the text of a scene file. Raises SceneError with the reason if it cannot."""
    try:
        return regular_text(path)
    except UnreadableError as error:
        raise SceneError(str(path), [str(error)]) from None


def _driver(raw: object, faults: list[str]) -> DriverTable | None:
    if isinstance(raw, list):
        faults.append(
            f"driver: found a list of {len(raw)}; a scene has one driver, one [driver] table"
        )
        return None
    if not isinstance(raw, Mapping):
        return None  # already a fault of SceneTable
    law = raw.get("law", "constant")
    known = SLIDES if "slider" in raw else DRIVERS
    model = known.get(law) if isinstance(law, str) else None
    if model is None:
        faults.append(f"driver.law: found {shown(law)}; use one of {', '.join(known)}")
        return None
    if isinstance(raw.get("link"), list):
        faults.append(f"driver.link: found {shown(raw['link'])}; a scene has one driver, one link")
        return None
    return validated(model, raw, "driver.", faults)


def _loads(raw: object, faults: list[str]) -> dict[str, LoadTable]:
    loads: dict[str, LoadTable] = {}
    for name, table in (raw if isinstance(raw, Mapping) else {}).items():
        if not isinstance(table, Mapping):
            continue  # already a fault of SceneTable
        law, key = table.get("law", "constant"), f"loads.{cut(name)}"
        model = LOADS.get(law) if isinstance(law, str) else None
        if model is None:
            faults.append(f"{key}.law: found {shown(law)}; use one of {', '.join(LOADS)}")
        elif (load := validated(model, table, f"{key}.", faults)) is not None:
            loads[name] = load
    return loads
