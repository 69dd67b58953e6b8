"""Errors with other facts of the scene, the forces or the motion."""

from dataclasses import fields, replace

from reports.compare.errors import Errors

GROUPS = ("of_scene", "of_forces", "of_motion", "of_links")


def with_facts(errors: Errors, **changed: object) -> Errors:
    for group in GROUPS:
        facts = getattr(errors, group)
        own = {each.name: changed.pop(each.name) for each in fields(facts) if each.name in changed}
        errors = replace(errors, **{group: replace(facts, **own)})
    return replace(errors, **changed)  # type: ignore[arg-type]  # names are given as texts
