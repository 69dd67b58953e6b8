"""Texts that are no log, and files that are no text, with words of the message for each."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import partial
from pathlib import Path

from tests.worlds.stranger import FOURBAR
from tests.worlds.stranger_log import DEG, MM, Column, Dress, even, logged

Made = bytes | Callable[[Path], object]
"""What is in a file, or what makes it."""
HEADER, *ROWS = (
    Dress(digits=9)
    .text(
        logged(
            FOURBAR,
            even(FOURBAR, 1.0, 60),
            [
                Column("crank_deg", "crank", "angle", DEG),
                Column("rocker_deg", "rocker", "angle", DEG),
                Column("C_x_mm", "C", "x", MM),
            ],
        )
    )
    .decode()
    .splitlines()
)
"""A log that is right: time_s, crank_deg, rocker_deg, C_x_mm."""


def text(*rows: str, header: str = HEADER) -> bytes:
    return "\n".join([header, *rows, ""]).encode()


def cell(row: int, column: int, value: str) -> bytes:
    """The log with something else in one cell; row 0 is the first of numbers."""
    rows = list(ROWS)
    fields = rows[row].split(",")
    fields[column] = value
    rows[row] = ",".join(fields)
    return text(*rows)


def header(old: str, new: str) -> bytes:
    return text(*ROWS, header=HEADER.replace(old, new))


def doubled(name: str) -> bytes:
    """The log with its rocker once more, under that name."""
    rows = [f"{row},{row.split(',')[2]}" for row in ROWS]
    return text(*rows, header=f"{HEADER},{name}")


TEXTS: dict[str, tuple[bytes, str]] = {
    "no column of times": (
        text(*(row.split(",", 1)[1] for row in ROWS), header=HEADER.split(",", 1)[1]),
        "no column of times; found .*crank_deg.*time_s",
    ),
    "times that go back": (
        text(*ROWS[:9], ROWS[7], *ROWS[10:]),
        r"row 11, column 'time_s': time goes back, from 0\.08.* s to 0\.07.* s.*sort",
    ),
    "times that repeat": (text(*ROWS[:9], ROWS[8], *ROWS[9:]), "row 11, .*stands still.* sort"),
    "an empty cell": (cell(4, 2, ""), "row 6, column 'rocker_deg': the cell is empty; fill it"),
    "a cell of spaces": (cell(4, 2, "  "), "row 6, column 'rocker_deg': the cell is empty; fill"),
    "an empty time": (cell(4, 0, ""), "row 6, column 'time_s': the cell is empty"),
    "an empty last cell": (cell(60, 3, ""), "row 62, column 'C_x_mm': the cell is empty"),
    "a hole": (text(*ROWS[:20], *ROWS[26:]), r"row 22.*gap.* 6 of them missing after t = .*fill"),
    "NaN": (cell(7, 2, "nan"), "row 9, column 'rocker_deg': found nan"),
    "NaN in capitals": (cell(7, 2, "NaN"), "row 9, column 'rocker_deg': found nan"),
    "N/A": (cell(7, 2, "N/A"), "row 9, column 'rocker_deg': found .*N/A"),
    "infinite": (cell(7, 3, "-inf"), "row 9, column 'C_x_mm': found -inf"),
    "too large": (cell(7, 3, "1e999"), "row 9, column 'C_x_mm': found .*inf|1e999"),
    "an infinite time": (cell(60, 0, "inf"), "row 62, column 'time_s': found inf"),
    "a word": (cell(7, 2, "stalled"), "row 9, column 'rocker_deg': found 'stalled', no number"),
    "a word in the first row": (cell(0, 2, "off"), "row 2, column 'rocker_deg': found 'off'"),
    "a number with its unit": (cell(7, 2, "12 deg"), "row 9, column 'rocker_deg': found '12 deg'"),
    "a truth": (cell(7, 2, "true"), "row 9, column 'rocker_deg': found 'true', no number"),
    "a column of truths": (
        text(*(f"{row.split(',')[0]},{row.split(',')[1]},true,1" for row in ROWS)),
        "row 2, column 'rocker_deg': found 'true', no number",
    ),
    "hexadecimal, whole": (cell(7, 2, "0x10"), "row 9, column 'rocker_deg': found '0x10', no numb"),
    "digits in threes": (
        cell(7, 2, '"1,000.5"'), "row 9, .*found '1,000.5', no number; write numbers without marks",
    ),
    "a word below remarks and blank lines": (
        text("# a", *ROWS[:3], "", "  ", "# b", *ROWS[3:7], "0.1,x,2,3"),
        "row 13, column 'crank_deg': found 'x', no number",
    ),
    "a short row below remarks and blank lines": (
        text("# a", *ROWS[:3], "", "  ", "# b", *ROWS[3:7], "0.1"), "row 13: 1 fields, the header",
    ),
    "two lines of names": (
        text("t,theta,theta,x", *ROWS, header="time,crank,rocker,C"),
        "line 2 holds words and no numbers, below the names in line 1: .*join them, or put #",
    ),
    "a title": (
        text(HEADER, *ROWS, header="Results of today"), "line 2 holds words.*put # before a title",
    ),
    "tabs that line columns up": (
        text(*ROWS).replace(b",", b"\t\t"), "line 1: column 2 has no name; .*separator = ' '",
    ),
    "remarks of 300 kB": (b"# a solver\n" * 30_000 + text(*ROWS), "within the first .* leave out"),
    "hexadecimal": (cell(7, 2, "0x1p3"), "row 9, column 'rocker_deg': found '0x1p3', no number"),
    "digits in groups": (cell(7, 2, "1_000"), "row 9, column 'rocker_deg': found '1_000', no num"),
    "times of a clock on the wall": (
        text(*(f"2026-01-01 00:00:{n:02}.5,1,2,3" for n in range(50))),
        "row 2, column 'time_s': found '2026-01-01 00:00:00.5', no number; write sec",
    ),
    "decimal commas": (
        text(*(row.replace(",", ";").replace(".", ",") for row in ROWS),
             header=HEADER.replace(",", ";")),
        "row 2|row 3.*decimal comma|decimal = ','",
    ),
    "decimal commas between commas": (
        text(*(row.replace(".", ",") for row in ROWS[1:])),
        "line 2 has . fields, the header 4.*decimal",
    ),
    "one decimal comma": (
        text(*(row.replace(",", ";") for row in ROWS[:9]), "0,0942477796;144;140,1;2",
             header=HEADER.replace(",", ";")),
        "row 11, column 'time_s': found '0,0942477796', no number; write decimal points",
    ),
    "two columns for one quantity": (
        doubled("rocker.theta_rad"),
        "two columns for one quantity, angle of rocker: 'rocker_deg' and 'rocker.theta_rad'; ",
    ),
    "two columns of times": (doubled("time_ms"), "two columns of times, 'time_s' and 'time_ms'"),
    "units that contradict each other": (
        header("rocker_deg", "rocker_deg [rad]"),
        r"column 'rocker_deg \[rad\]': units that contradict each other, deg and rad; rename it",
    ),
    "a unit of something else": (
        header("rocker_deg", "rocker angle [mm]"),
        r"'rocker angle \[mm\]': mm is a unit of length, and its name says angle",
    ),
    "a unit of time that is none": (header("time_s", "time [deg]"), "time.*deg"),
    "empty": (b"", "empty; a log has a header and rows of numbers"),
    "only line ends": (b"\n\n\n", "empty.*; a log has a header and rows"),
    "only a byte order mark": (b"\xef\xbb\xbf", "empty.*; a log has a header and rows"),
    "only remarks": (b"# a\n# b\n", "empty but for remarks; a log has a header and rows"),
    "only a header": (text(), "a header and no rows"),
    "a header and units": (b"time,crank\ns,deg\n", "no rows"),
    "one row": (text(ROWS[0]), "1 row; a motion has at least"),
    "no header": (text(*ROWS[1:], header=ROWS[0]), "line 1 holds numbers and no names; put a head"),
    "a column without a name": (header("rocker_deg", ""), "line 1: column 3 has no name; give it"),
    "two columns of one name": (
        header("rocker_deg", "crank_deg"),
        "two columns are called 'crank_deg'; give each a name of its own",
    ),
    "a row that is too short": (text(*ROWS[:5], "0.05,30", *ROWS[6:]), "row 7: 2 fields, the head"),
    "a row that is too long": (
        text(*ROWS[:5], ROWS[5] + ",1", *ROWS[6:]), "row 7: 5 fields, the header 4",
    ),
    "a quote that never closes": (cell(7, 2, '"7'), "row 9|quote"),
    "nothing of the scene": (
        header("crank_deg,rocker_deg,C_x_mm", "a,b,c"),
        "no column is of scene fourbar-lecture-1, which has crank.*found .*write-map",
    ),
    "another scene's": (
        header("crank_deg,rocker_deg,C_x_mm", "lever_deg,rod_deg,F_x_mm"),
        "no column is of scene fourbar-lecture-1, which has crank",
    ),
    "binary": (bytes(range(256)) * 99, "no text|not UTF-8 text|null bytes"),
    "a picture": (b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR" + bytes(999), "null bytes|not UTF-8 text"),
    "a workbook called .csv": (b"PK\x03\x04" + bytes(999), "null bytes"),
    "UTF-16": (text(*ROWS).decode().encode("utf-16"), "UTF-16 text; save the file as UTF-8"),
    "Latin 1": (header("rocker_deg", "rocker [°]").decode().encode("latin-1"), "not UTF-8 text; s"),
    "lines that end in \\r": (text(*ROWS).replace(b"\n", b"\r"), "lines end in|save the file with"),
    "100,000 columns": (
        text(",".join(["1"] * 100_000), header=",".join(f"c{k}" for k in range(100_000))),
        "100000 columns; at most|first line is longer than",
    ),
    "20,000 short columns": (
        text("1," * 20_000, header="".join(f"{k}," for k in range(20_000))),
        "2000. columns; at most 2000 are read",
    ),
    "numbers of 1 MB": (cell(7, 2, "1" * 1_000_000), "row 9, column 'rocker_deg'"),
}  # fmt: skip


def rows_of(count: int, row: bytes, path: Path) -> None:
    """Many rows, all alike."""
    with path.open("wb") as file:
        file.write(b"time_s,crank_deg\n")
        for _ in range(count // 100_000):
            file.write(row * 100_000)


def nothing(path: Path) -> None:
    """No file."""


def large(before: bytes, part: bytes, times: int, after: bytes, path: Path) -> None:
    """A file of several megabytes, made where it is needed."""
    path.write_bytes(before + part * times + after)


def sparse(path: Path) -> None:
    """A file of 30 GB that takes no room."""
    with path.open("wb") as file:
        file.truncate(30_000_000_000)


LARGE: dict[str, tuple[Made, str]] = {
    "a quote over 9 MB": (
        partial(large, cell(7, 2, '"7'), b"1,2,3,4\n", 1_200_000, b""), "row 9|quote",
    ),
    "null bytes behind a good beginning": (
        partial(large, text(*ROWS), "\n".join([*ROWS, ""]).encode(), 99, bytes(999)), "row|null",
    ),
    "a header of 10 MB": (
        partial(large, b"", b"x", 10_000_000, text(*ROWS)), "its first line is longer than",
    ),
    "a header of 10 MB in names": (
        partial(large, b"", b"rocker_deg,", 900_000, b"x\n1\n"), "its first line is longer than",
    ),
    "a line of 9 MB": (
        partial(large, text(*ROWS[:3]), b"1", 9_000_000, b"\n1,2,3,4\n"), "row 5",
    ),
    "10 million rows": (partial(rows_of, 10_000_000, b"1,2\n"), "10000000 rows; at most .* are re"),
}  # fmt: skip
SPECIAL: dict[str, tuple[Made, str]] = {
    "30 GB": (sparse, "30000000000 bytes; at most .* are read"),
    "a pipe": (os.mkfifo, "a pipe, no plain file"),
    "endless": (partial(os.symlink, "/dev/zero"), "a device, no plain file"),
    "a folder": (os.mkdir, "a folder"),
    "a link to nothing": (partial(os.symlink, "nothing"), "not there"),
    "nothing": (nothing, "not there"),
}
