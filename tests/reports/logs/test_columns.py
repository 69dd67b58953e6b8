"""Files of columns: separators, headers and units are found, and what can not be read is told."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from models.errors import CrankcheckError
from reports.logs import text_lines
from reports.logs.columns import Columns, columns_of, read_columns
from reports.logs.map_file import FileTable

ROWS = [(0.0, 1.5), (0.1, -2.25), (0.2, 3e-7)]


def written(tmp_path: Path, text: str, name: str = "log.csv") -> Path:
    path = tmp_path / name
    path.write_bytes(text.encode())
    return path


def assert_rows(found: Columns, rows: object = ROWS, names: Sequence[str] = ("t", "a b")) -> None:
    assert list(found.raw) == list(names)
    assert np.array_equal(np.column_stack([found.numbers(name) for name in names]), rows)


@pytest.mark.parametrize(
    "text",
    [
        "t,a b\n0,1.5\n0.1,-2.25\n0.2,3e-7\n",
        "t\ta b\n0\t1.5\n0.1\t-2.25\n0.2\t3e-7",
        "# made by a solver, today\n# 2 columns\nt,a b\n0,1.5\n0.1,-2.25\n0.2,3e-7\n",
        '\ufeff"t","a b"\n0,1.5\n0.1,-2.25\n\n0.2,3e-7\n',
        "t;a b;\r\n0;1.5;\r\n0.1;-2.25;\r\n0.2;3e-7;\r\n",
        "# t,a b\n0,1.5\n0.1,-2.25\n0.2,3e-7\n",
        "% a solver, of today, in s\n%t;a b\n0;1.5\n0.1;-2.25\n0.2;3e-7\n",
        "sep=;\nt;a b\n0;1.5\n0.1;-2.25\n0.2;3e-7\n",
        't "a b"\n0 1.5\n0.1  -2.25\n0.2 3e-7\n',
        '# don"t\nt,a b\n# "\n0,1.5\n# don"t\n0.1,-2.25\n# "\n0.2,3e-7\n',
        "t,a b\n#0,9\n0,1.5\n#0.05,9\n0.1,-2.25\n0.2,3e-7\n",
        "t,a b,\n0,1.5,\n# half, of it,\n0.1,-2.25,\n0.2,3e-7,\n",
        "# t,a b\n#\n# made today\n0,1.5\n0.1,-2.25\n# on\n0.2,3e-7\n",
    ],
)
def test_the_separator_is_found_and_remarks_are_passed_over(tmp_path: Path, text: str) -> None:
    assert_rows(read_columns(written(tmp_path, text)))


LINED = "  t     ab \n 0.0   1.5\n 0.1  -2.25\n"
OTHERS: list[tuple[str, list[str], object]] = [
    (LINED, ["t", "ab"], [(0.0, 1.5), (0.1, -2.25)]),
    ("# time_s ab\n0.0 1.5\n0.1 -2.25\n", ["time_s", "ab"], [(0.0, 1.5), (0.1, -2.25)]),
    ("t,rocker,\ns,deg,\n0,1,\n1,1,\n", ["t [s]", "rocker [deg]"], [(0, 1), (1, 1)]),
    ('t,"junk""x","in ""s"""\n0,1,2\n1,1,2\n', ["t", 'junk"x', 'in "s"'], [(0, 1, 2), (1, 1, 2)]),
    ("t,rocker,x\n[ms],deg,-\n0,1,2\n", ["t [ms]", "rocker [deg]", "x"], [(0, 1, 2)]),
    ("t,rocker,M\ns,deg,Nm\n0,1,2\n", ["t [s]", "rocker [deg]", "M [Nm]"], [(0, 1, 2)]),
    ("t,rocker\n# s,deg\n0,1\n", ["t [s]", "rocker [deg]"], [(0, 1)]),
    ("t [s] rocker [deg]\n0 1\n", ["t [s]", "rocker [deg]"], [(0, 1)]),
    ("# t s\n0 1\n", ["t", "s"], [(0, 1)]),
    *((f"{head}{mark}t,of,a,frame\n{rows}", ["t", "a"], [(0, 1), (1, 2)])
      for mark, head in (("%", ""), ("# ", "# made, by, a, 3\n"), ("//", "# by, a, robot, of 3\n"))
      for rows in ("0,rocker,1,\n1,rocker,2,\n", "0,on,1,\n# half\n1,,2,x\n",
                   "0,on,1,4\n1,7,2,4\n")),
    ("# by, a solver\nt,2\n0,1\n", ["t", "2"], [(0, 1)]),
]  # fmt: skip


@pytest.mark.parametrize(("text", "names", "rows"), OTHERS)
def test_columns_that_spaces_line_up_quotes_and_rows_of_units_are_read(
    tmp_path: Path, text: str, names: list[str], rows: object
) -> None:
    name = "log.txt" if text == LINED else "log.csv"
    found = read_columns(written(tmp_path, text, name))
    assert_rows(replace(found, raw={n: found.raw[n] for n in found.raw if n in names}), rows, names)


def test_decimal_commas_are_read_and_points_refused_where_the_map_says_so(tmp_path: Path) -> None:
    found = read_columns(written(tmp_path, "t;a\n0,5;1,25\n"), FileTable(decimal=","))
    assert_rows(found, [(0.5, 1.25)], ["t", "a"])
    found = read_columns(written(tmp_path, "t;a\n0,5;1.25\n"), FileTable(decimal=","))
    with pytest.raises(CrankcheckError, match=r"row 2, column 'a': found '1\.25', .* comma"):
        found.numbers("a")


BETWEEN = ("", "  ", "#", "# a", "% b, c", "// d", " # e", '# "', "#1,2", "#1\t2", "\t# t")


@pytest.mark.parametrize("seed", range(16))
def test_a_number_is_told_by_its_line_whatever_stands_between(tmp_path: Path, seed: int) -> None:
    rng = np.random.default_rng(seed)
    separator = str(rng.choice([",", ";", "\t", " "]))
    end, last = str(rng.choice(["\n", "\r\n"])), separator if rng.random() < 0.3 else ""
    values = rng.integers(-99, 99, (rng.integers(1, 9), rng.integers(2, 5))) / 8
    rows = [["n1", "n2", "n3", "n4"][: values.shape[1]], *values.tolist()]
    lines: list[str] = []
    at = []
    for row in rows:
        lines += rng.choice(BETWEEN, rng.integers(0, 3)).tolist()
        at.append(len(lines) + 1)
        lines.append(separator.join(map(str, row)) + last)
    lines += rng.choice(BETWEEN, rng.integers(0, 3)).tolist()
    found = read_columns(written(tmp_path, end.join(lines) + end * int(rng.integers(0, 2))))
    assert_rows(found, values.tolist(), rows[0])
    for row, line in enumerate(at[1:]):
        assert found.at("n1", row).endswith(f"row {line}, column 'n1'")


@pytest.mark.parametrize("first", ["#1", "a1"])
def test_a_row_whose_first_name_begins_as_a_remark_is_a_row(tmp_path: Path, first: str) -> None:
    text = f"id,t,a\n{first},0,1.5\n# half\n#2,1,2.5\n#3,2,3.5\n# all, done\n"
    found = read_columns(written(tmp_path, text), wanted=lambda name: name != "id")
    assert found.numbers("a").tolist() == [1.5, 2.5, 3.5]


def test_a_line_within_quotes_is_no_remark(tmp_path: Path) -> None:
    found = read_columns(written(tmp_path, 't,a,note\n0,1,"on\n# going"\n1,2,"off"\n'))
    assert found.numbers("a").tolist() == [1, 2]
    assert found.raw["note"].tolist() == ["on\n# going", "off"]


def test_decimal_commas_in_text_cells_of_a_sheet_are_read_too(tmp_path: Path) -> None:
    path = tmp_path / "log.xlsx"
    rows = [["t", "a"], ["s", "deg"], ["0,5", "1,25"], [1.5, 2.5]]
    pd.DataFrame(rows).to_excel(path, index=False, header=False, startrow=2)
    found = read_columns(path, FileTable(decimal=","))
    assert found.numbers("a [deg]").tolist() == [1.25, 2.5]
    assert found.at("a [deg]", 0).endswith("row 5, column 'a [deg]'")


@pytest.mark.parametrize("ending", ["parquet", "xlsx"])
def test_other_kinds_of_files_hold_the_same(tmp_path: Path, ending: str) -> None:
    frame = pd.DataFrame(ROWS, columns=["t", "a b"])
    path = tmp_path / f"log.{ending}"
    frame.to_parquet(path) if ending == "parquet" else frame.to_excel(path, index=False)
    assert_rows(read_columns(path))


def test_every_digit_is_kept(tmp_path: Path) -> None:
    values = np.random.default_rng(1).normal(size=500) * 10.0 ** np.arange(-250, 250)
    text = "t,a\n" + "".join(f"{n},{each!r}\n" for n, each in enumerate(values.tolist()))
    assert np.array_equal(read_columns(written(tmp_path, text)).numbers("a"), values)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("t,a\ns,deg\n", "a header and units, and no rows"),
        ("t,a\n0,1,2\n", "line 2 has 3 fields, the header 2"),
        ("t,a,\n0,1,\n# b\n1,2,3\n", "row 4: found '3' in column 3, which has no name"),
        ("t,a b\n0 1\n", "line 2 has 2 numbers between spaces, and line 1 not as many names"),
        ("t,x,x\n,x,y\n0,1,2\n", "line 2 holds words and no numbers, below the names in line 1"),
        ("t;a\n0,5;1,25\n", "row 2, column 't': found '0,5', a decimal comma"),
        ("t,a,b\n0,5,1,25,3,5\n", "decimal commas between commas"),
        ('t,"a\n0,1\n', "a quote that is not closed"),
        ("# 0,1\n0,1\n", "line 2 holds numbers and no names"),
    ],
)
def test_what_is_no_log_is_told(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(CrankcheckError, match=words):
        read_columns(written(tmp_path, text))


@pytest.mark.parametrize(
    ("cell", "words"),
    [
        ("1;5", "row 3, column 'a': found '1;5', not a number"),
        ('"1,000"', "row 3, column 'a': found '1,000', not a number; write decimal points, or set"),
        ("1'000.5", "row 3, column 'a': found .*not a number; write numbers without marks"),
        ("00:01", "row 3, column 'a': found '00:01', not a number; write seconds"),
        ("1.5D-3", "row 3, column 'a': found '1.5D-3', .*write e for"),
    ],
)
def test_what_is_no_number_is_told_by_row_and_column(tmp_path: Path, cell: str, words: str) -> None:
    found = read_columns(written(tmp_path, f"t,a\n0,1\n1,{cell}\n2,1\n"))
    assert found.numbers("t").tolist() == [0, 1, 2]
    with pytest.raises(CrankcheckError, match=words):
        found.numbers("a")


def test_rows_beyond_the_most_are_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(text_lines, "MOST_ROWS", 2)
    with pytest.raises(CrankcheckError, match="3 rows; at most 2 are read"):
        read_columns(written(tmp_path, "t,a\n0,1\n1,1\n2,1\n"))


@pytest.mark.parametrize(
    ("values", "words"),
    [
        (pd.to_timedelta([0, 1], unit="s"), r"column 't': found durations .*give .* seconds"),
        (pd.to_datetime([0, 1], unit="s"), r"column 't': found dates .*give .* seconds"),
        ([True, False], "column 't': found True, not a number"),
        ([1j, 2.0], "column 't': found 1j, not a number"),
        ([1.5, None], "the frame, row 1, column 't': found nan"),
    ],
)
def test_what_only_looks_like_numbers_is_told(values: object, words: str) -> None:
    with pytest.raises(CrankcheckError, match=words):
        columns_of(pd.DataFrame({"t": values})).numbers("t")
