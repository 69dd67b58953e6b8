"""Tables in files keep every digit, and what is no number for what it is."""

from __future__ import annotations

import io
import math
from pathlib import Path

import numpy as np
import openpyxl
import pandas as pd
import pytest

from reports.output.frame_file import workbook, write_frame

HARD = [
    0.1 + 0.2,
    1e-300,
    5e-324,
    -1.7976931348623157e308,
    1 / 3,
    2.0**-1074 * 3,
    -0.0,
    123456789.1,
]
READERS = {".csv": pd.read_csv, ".parquet": pd.read_parquet, ".xlsx": pd.read_excel}


@pytest.mark.parametrize("ending", READERS)
def test_every_number_is_read_back_to_the_last_bit(tmp_path: Path, ending: str) -> None:
    chance = np.random.default_rng(1)
    numbers = [*HARD, *(chance.standard_normal(500) * 10.0 ** chance.integers(-30, 30, 500))]
    frame = pd.DataFrame({"value_m": numbers, "count": range(len(numbers))})
    path = tmp_path / f"table{ending}"
    write_frame(path, frame, "log", {"scene": "=1+1"})
    found = READERS[ending](path)
    np.testing.assert_array_equal(found["value_m"], frame["value_m"])
    assert found["count"].tolist() == frame["count"].tolist()


def test_a_workbook_says_where_it_comes_from_and_holds_no_formula() -> None:
    frame = pd.DataFrame({"=x\x00": [1.5, math.nan], "text": ["=1+1", "b"]})
    book = openpyxl.load_workbook(io.BytesIO(workbook(frame, "log", {"scene": "=2+2"})))
    assert book.sheetnames == ["log", "source"]
    rows = list(book["source"].iter_rows(values_only=True))
    assert rows[1] == ("scene", "=2+2")
    assert rows[-1][0] == "crankcheck"
    assert book["source"]["B2"].data_type == "s"
    assert book["log"]["A2"].value == 1.5
    assert book["log"]["A2"].data_type == "n"
