"""What is embedded can neither leave its script nor lose what a diagram shows."""

import base64
import hashlib
import json
import math
import re

import numpy as np
import pytest

from reports.drawing.moving import LEVELS, embedded, packed, policy, singles, size_of
from reports.output import console
from reports.output.numbers import DIGITS, NONE, count, finite, listed
from tests.reports.drawing.test_moving import unpacked

HOSTILE = "</script><script>alert(1)</script><!--\u2028\u2029&'\""


def test_hostile_text_stays_in_its_script_and_what_is_no_number_is_null() -> None:
    text = str(embedded({HOSTILE: [HOSTILE, {"deep": HOSTILE}]}))
    assert not re.search("[<>&\u2028\u2029]", text)
    assert json.loads(text) == {HOSTILE: [HOSTILE, {"deep": HOSTILE}]}
    text = str(embedded({"a": np.array([1 / 3, math.nan, math.inf, 2.0]), "b": True, "c": None}))
    assert text == '{"a":[0.333333,null,null,2],"b":true,"c":null}'
    assert finite(np.float64(-1.23456789e-9), DIGITS) == -1.23457e-9
    assert finite(np.int64(7), DIGITS) == 7


@pytest.mark.parametrize("scale", [1.0, 1e-12, 1e300, 5e-324])
def test_packed_samples_come_back_to_a_part_of_their_row(scale: float) -> None:
    rows = np.vstack([np.sin(np.linspace(0, 7, 91)), np.linspace(-1e-6, 1e-7, 91)]) * scale
    found = packed(rows)
    largest = np.max(np.abs(rows), axis=1, keepdims=True)
    room = largest / LEVELS if scale > 1e-300 else np.full_like(largest, scale)
    assert np.all(np.abs(unpacked(found) - rows) <= room)
    assert found["samples"] == 91


def test_single_samples_come_back_to_seven_digits() -> None:
    row = np.array([0.0, 123.456789, -1e-30, 1e300, np.nan])
    told = singles(row)
    found = np.frombuffer(base64.b64decode(str(told["singles"])), dtype="<f4")
    assert told["samples"] == 5
    assert found[:3] == pytest.approx(row[:3], rel=1e-7, abs=1e-38)
    assert np.isposinf(found[3])
    assert np.isnan(found[4])


def test_missing_samples_are_told_from_zero_and_the_size_of_rows_is_known_beforehand() -> None:
    found = packed(np.array([[math.nan, 0.0, math.inf, 1.0], [0.0, 0.0, 0.0, math.nan]]))
    whole = np.frombuffer(base64.b64decode(str(found["base64"])), "<i2").reshape(2, 4)
    assert whole.tolist() == [[-32768, 0, -32768, LEVELS], [0, 0, 0, -32768]]
    rows = np.random.default_rng(1).normal(size=(17, 91))
    assert size_of(17, 91) == pytest.approx(len(str(embedded(packed(rows)))), rel=0.05)


def test_the_policy_lets_the_own_scripts_run_and_nothing_else() -> None:
    script = "let a = 1;"
    found = policy([script])
    own = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    assert f"script-src 'sha256-{own}';" in found
    assert "default-src 'none'" in found
    assert "http" not in found
    assert "unsafe-eval" not in found


@pytest.mark.parametrize(
    ("way", "value", "text"),
    [
        *[("readable", value, text) for value, text in {
            0.0: "0", 0.001: "0.001", 0.01234: "0.0123", -3.016: "-3.02", 345.6: "346",
            12345.6: "12346", 1e-4: "1e-4", 1.2e-4: "1.2e-4", -4.567e-9: "-4.57e-9", 1e5: "1e5",
            math.inf: "inf", math.nan: "nan"}.items()],
        *[("error_text", value, text) for value, text in {
            2.66e-4: "2.7e-4", 0.0: "0", math.nan: NONE, None: NONE, 1.0: "1.0e0"}.items()],
        *[("duration", value, text) for value, text in {
            1.4e-3: "1.40 ms", 14.06e-3: "14.1 ms", 0.99996e-3: "1.00 ms", 4.84e-4: "484 µs",
            12.0: "12.0 s", 3e-9: "3.00 ns", None: NONE, math.inf: NONE}.items()],
    ],
)  # fmt: skip
def test_numbers_have_no_needless_exponent_errors_two_digits_and_times_three(
    way: str, value: float | None, text: str
) -> None:
    assert getattr(console, way)(value) == text


def test_things_are_counted_and_listed() -> None:
    assert [count(1, "scene"), count(2, "scene")] == ["1 scene", "2 scenes"]
    assert count(2, "axis", "axes") == "2 axes"
    assert [listed([]), listed(["a"]), listed(["a", "b", "c"])] == ["", "a", "a, b and c"]
