"""An own model with all that was found, as JSON."""

from __future__ import annotations

import json
from collections.abc import Mapping

from models.files.assemble import scene_text
from reports.judge.rows import cell_row, error_row
from reports.output.numbers import finite
from reports.own_model.checked_line import CheckedLine
from reports.own_model.judged import JudgedModel
from reports.own_model.sentences import groups


def document(judged: JudgedModel, facts: Mapping[str, str]) -> str:
    """Facts, what was read, every joint, and the lines with their findings and errors; what is not
    finite is null."""
    account = judged.account
    content = {
        "provenance": dict(facts),
        "verdict": judged.verdict,
        "model": {
            "file": str(account.request.path),
            "driven": account.request.joint,
            "speed_rad_s": account.request.speed_rad_s,
            "key": account.request.key,
            "scene": scene_text(account.scene),
            "notes": list(account.notes),
            "disturbances": [vars(group) for group in groups(judged)],
            "recommended": judged.patch,
            "helps": account.helps,
        },
        "joints": [
            {
                "joint": joint.name,
                "open_m": joint.open_m,
                "gap_m": dict(joint.gap_m),
                "share_of_limit": joint.share,
            }
            for joint in judged.joints()
        ],
        "cells": [_cell(judged, one) for one in judged.lines],
    }
    return json.dumps(finite(content), indent=1) + "\n"


def _cell(judged: JudgedModel, one: CheckedLine) -> dict[str, object]:
    """A line: as a cell of any verification, with what it gains at each step and every error."""
    return cell_row(one) | {
        "settings": dict(one.settings),
        "gains": list(judged.gains(one)),
        "notes": list(one.errors.notes) if one.errors else [],
        "findings": [vars(finding) for finding in one.findings],
        "errors": [error_row(row, one.limits) for row in one.errors.rows] if one.errors else [],
    }
