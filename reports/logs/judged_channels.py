"""Which channels of a log are judged, and which are lengths, further copies, or of the ground."""

from __future__ import annotations

from collections.abc import Container, Sequence

from models.errors import CrankcheckError
from models.scene import Scene
from reports.logs.channel import Channel
from reports.logs.own_columns import LENGTH


def without_lengths(
    channels: Sequence[Channel], told: Container[str]
) -> tuple[list[Channel], list[tuple[str, str]]]:
    """The channels without lengths of vectors, which are those that a map does not tell of, of a
    slider's point whose components are there, beside the slider's own."""
    parts = {(each.of, each.kind.order) for each in channels if each.kind.body_kind == "point"}
    sliders = [each for each in channels if each.kind.body_kind == "slider"]
    own = {(each.of, each.kind.order) for each in sliders if "slider" in each.column.lower()}
    lengths = [
        each
        for each in sliders
        if "slider" not in each.column.lower()
        and each.column not in told
        and (each.of, each.kind.order) in parts & own
    ]
    kept = [each for each in channels if each not in lengths]
    return kept, [(each.column, LENGTH) for each in lengths]


def judged_channels(
    channels: Sequence[Channel], scene: Scene
) -> tuple[list[Channel], list[Channel], list[tuple[str, str]]]:
    """The channels to be judged, those of further copies of a point's place, which a gap is taken
    of, and what is not judged with the reason. Raises CrankcheckError for two columns of one
    quantity."""
    first: dict[tuple[object, ...], Channel] = {}
    main: list[Channel] = []
    copies: list[Channel] = []
    spare: list[tuple[str, str]] = []
    order = {body: n for n, body in enumerate([*scene.links])}
    for each in sorted(channels, key=lambda one: (bool(one.relative_to), order.get(one.on, -1))):
        key = (each.kind, each.of, each.on, each.relative_to)
        if key in first:
            raise CrankcheckError(
                f"two columns for one quantity, {each.name}: {first[key].column!r} and "
                f"{each.column!r}; rename one, or say in a map what it is, or ignore = true"
            )
        first[key] = each
        if each.kind.body_kind == "point" and each.of in scene.ground:
            spare.append((each.column, "it is of a point of the ground, which does not move"))
            continue
        before = next((o for o in main if (o.kind, o.of) == (each.kind, each.of)), None)
        if before is not None and each.kind.body_kind == "point" and each.kind.order == 0:
            copies.append(each)
        else:
            main.append(each)
    place = {each.column: n for n, each in enumerate(channels)}
    return sorted(main, key=lambda one: place[one.column]), copies, spare
