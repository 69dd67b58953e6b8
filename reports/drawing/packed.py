"""What a page carries inside: JSON that can not end its script, series at two or four bytes a
sample."""

from __future__ import annotations

import base64
import hashlib
import json

import numpy as np
from markupsafe import Markup

from models.array import Array
from reports.output.numbers import DIGITS, finite

LEVELS = 32767
MISSING = -32768
"""What stands for a sample that is not finite."""
ESCAPES = {
    "<": "\\u003c",
    ">": "\\u003e",
    "&": "\\u0026",
    "\u2028": "\\u2028",
    "\u2029": "\\u2029",
}


def embedded(value: object) -> Markup:
    """A value as JSON that may stand inside a script element: no ``</script>``, no ``<!--``."""
    text = json.dumps(finite(value, DIGITS), allow_nan=False, separators=(",", ":"))
    for character, escape in ESCAPES.items():
        text = text.replace(character, escape)
    return Markup(text)


def packed(rows: Array) -> dict[str, object]:
    """Rows of samples (R, T) as one text: 16-bit integers, little-endian, in base64.

    Every row has a scale of its own: sample = scale * integer, so that each is known to 1/65534 of
    the row's largest. Samples that are not finite are `MISSING`.
    """
    rows = np.atleast_2d(np.asarray(rows, dtype=np.float64))
    there = np.isfinite(rows)
    filled = np.where(there, rows, 0.0)
    scales = np.max(np.abs(filled), axis=1, initial=0.0) / LEVELS
    safe = np.where(scales > 0.0, scales, 1.0)
    # A row of subnormal numbers has too coarse a scale: its integers may come out beyond 16 bits.
    levels = np.clip(np.round(filled / safe[:, None]), -LEVELS, LEVELS)
    whole = np.where(there, levels, MISSING).astype("<i2")
    return {
        "samples": rows.shape[1],
        "scales": scales,
        "base64": base64.b64encode(whole.tobytes()).decode("ascii"),
    }


def singles(row: Array) -> dict[str, object]:
    """Samples (T,) as one text: 32-bit floats, little-endian, in base64, for what is read off to
    its last digits; what is not finite stays so."""
    with np.errstate(over="ignore"):  # beyond 3.4e38 it has no end
        numbers = np.asarray(row, dtype=np.float64).astype("<f4")
    return {"samples": numbers.size, "singles": base64.b64encode(numbers.tobytes()).decode("ascii")}


def size_of(series: int, samples: int) -> int:
    """How many characters ``series`` packed rows of ``samples`` take."""
    return series * (samples * 8 // 3 + 12)


def policy(scripts: list[str]) -> str:
    """The content security policy of a page that runs these scripts alone, and loads nothing.

    Plotly writes styles as it draws, and makes pictures of diagrams out of blobs.
    """
    hashes = " ".join(f"'sha256-{_hash(script)}'" for script in scripts)
    return (
        f"default-src 'none'; script-src {hashes}; style-src 'unsafe-inline'; "
        "img-src data: blob:; media-src data:; base-uri 'none'; form-action 'none'"
    )


def _hash(script: str) -> str:
    return base64.b64encode(hashlib.sha256(script.encode()).digest()).decode("ascii")
