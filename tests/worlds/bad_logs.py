"""Texts, Parquet files and workbooks that are no log, and files that are no text, with words of the
message that refuses each.
"""

import io
import os
import zipfile
import zlib
from collections.abc import Callable
from datetime import time
from functools import partial
from pathlib import Path

import numpy as np
import openpyxl
import pyarrow as pa
import pyarrow.parquet as pq

from tests.worlds.stranger import FOURBAR
from tests.worlds.stranger_log import DEG, MM, Column, Dress, even, logged

Made = bytes | Callable[[Path], object]
"""What is in a file, or what makes it."""
COLUMNS = [
    Column("crank_deg", "crank", "angle", DEG),
    Column("rocker_deg", "rocker", "angle", DEG),
    Column("C_x_mm", "C", "x", MM),
]
LOG = logged(FOURBAR, even(FOURBAR, 1.0, 60), COLUMNS)
HEADER, *ROWS = Dress(digits=9).text(LOG).decode().splitlines()
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
        text(*(row.split(",", 2)[2] for row in ROWS), header=HEADER.split(",", 2)[2]),
        "no column of times; found .*rocker_deg.*time_s.* angle of crank, none are needed"),
    **{f"{name}, which may be the times": (header("time_s", name), f"no column of times; .*{name}")
       for name in ("pulse", "counter_ms")},
    "times that go back": (
        text(*ROWS[:9], ROWS[7], *ROWS[10:]),
        r"row 11, column 'time_s': time goes back, from 0\.08.* s to 0\.07.* s.*sort"),
    "times that repeat": (text(*ROWS[:9], ROWS[8], *ROWS[9:]), "row 11, .*stands still.* sort"),
    "an empty cell": (cell(4, 2, ""), "row 6, column 'rocker_deg': the cell is empty; fill it"),
    "a hole": (text(*ROWS[:20], *ROWS[26:]), r"row 22.*gap.* 6 of them missing after t = .*fill"),
    "NaN": (cell(7, 2, "nan"), "row 9, column 'rocker_deg': found nan"),
    "infinite": (cell(7, 3, "-inf"), "row 9, column 'C_x_mm': found -inf"),
    "a word": (cell(7, 2, "stalled"), "row 9, column 'rocker_deg': found 'stalled', not a number"),
    "a column of truths": (
        text(*(f"{row.split(',')[0]},{row.split(',')[1]},true,1" for row in ROWS)),
        "row 2, column 'rocker_deg': found 'true', not a number"),
    "a word below remarks and blank lines": (
        text("# a", *ROWS[:3], "", "  ", "# b", *ROWS[3:7], "0.1,x,2,3"),
        "row 13, column 'crank_deg': found 'x', not a number"),
    "two lines of names": (
        text("t,theta,theta,x", *ROWS, header="time,crank,rocker,C"),
        "line 2 holds words and no numbers, below the names in line 1: .*join them, or put #"),
    "a title": (
        text(HEADER, *ROWS, header="Results of today"), "line 2 holds words.*put # before a title"),
    "tabs that line columns up": (
        text(*ROWS).replace(b",", b"\t\t"), "line 1: column 2 has no name; .*separator = ' '"),
    "remarks of 300 kB": (b"# a solver\n" * 30_000 + text(*ROWS), "within the first .* leave out"),
    "hexadecimal": (cell(7, 2, "0x1p3"), "row 9, column 'rocker_deg': found '0x1p3', not a number"),
    "digits in groups": (cell(7, 2, "1_000"), "row 9, column 'rocker_deg': found '1_000', not a"),
    "decimal commas": (
        text(
            *(row.replace(",", ";").replace(".", ",") for row in ROWS),
            header=HEADER.replace(",", ";")),
        "row 2|row 3.*decimal comma|decimal = ','"),
    "two columns for one quantity": (
        doubled("rocker.theta_rad"),
        "two columns for one quantity, angle of rocker: 'rocker_deg' and 'rocker.theta_rad'; "),
    "two columns of times": (doubled("time_ms"), "two columns of times, 'time_s' and 'time_ms'"),
    "units that contradict each other": (
        header("rocker_deg", "rocker_deg [rad]"),
        r"column 'rocker_deg \[rad\]': units that contradict each other, deg and rad; rename it"),
    "a unit of time that is none": (header("time_s", "time [deg]"), "time.*deg"),
    "empty": (b"", "empty; a log has a header and rows of numbers"),
    "only a byte order mark": (b"\xef\xbb\xbf", "empty.*; a log has a header and rows"),
    "only a header": (text(), "a header and no rows"),
    "one row": (text(ROWS[0]), "1 row; a motion has at least"),
    "no header": (text(*ROWS[1:], header=ROWS[0]), "line 1 holds numbers and no names; put a head"),
    "a column without a name": (header("rocker_deg", ""), "line 1: column 3 has no name; give it"),
    "two columns of one name": (
        header("rocker_deg", "crank_deg"),
        "two columns are called 'crank_deg'; give each a name of its own"),
    "a row that is too short": (text(*ROWS[:5], "0.05,30", *ROWS[6:]), "row 7: 2 fields, the head"),
    "a quote that never closes": (cell(7, 2, '"7'), "row 9|quote"),
    "nothing of the scene": (
        header("crank_deg,rocker_deg,C_x_mm", "a,b,c"),
        "no column belongs to scene fourbar-lecture-1, which has crank.*found .*write-map"),
    "binary": (bytes(range(256)) * 99, "no text|not UTF-8 text|null bytes"),
    "a workbook called .csv": (b"PK\x03\x04" + bytes(999), "null bytes"),
    "UTF-16": (text(*ROWS).decode().encode("utf-16")[:-1], "UTF-16 text that is cut; save the"),
    "Latin 1": (header("rocker_deg", "rocker [°]").decode().encode("latin-1"), "not UTF-8 text; s"),
    "lines that end in \\r": (text(*ROWS).replace(b"\n", b"\r"), "lines end in|save the file with"),
    "100,000 columns": (
        text(",".join(["1"] * 100_000), header=",".join(f"c{k}" for k in range(100_000))),
        "100000 columns; at most|first line is longer than"),
    "20,000 short columns": (
        text("1," * 20_000, header="".join(f"{k}," for k in range(20_000))),
        "2000. columns; at most 2000 are read"),
}  # fmt: skip


def rows_of(count: int, row: bytes, path: Path) -> None:
    with path.open("wb") as file:
        file.write(b"time_s,crank_deg\n")
        file.writelines(row * 100_000 for _ in range(count // 100_000))


def large(before: bytes, part: bytes, times: int, after: bytes, path: Path) -> None:
    """A file of several megabytes, made where it is needed."""
    path.write_bytes(before + part * times + after)


def sparse(path: Path) -> None:
    """A file of 30 GB that takes no room."""
    with path.open("wb") as file:
        file.truncate(30_000_000_000)


LARGE: dict[str, tuple[Made, str]] = {
    "a quote over 9 MB": (
        partial(large, cell(7, 2, '"7'), b"1,2,3,4\n", 1_200_000, b""), "row 9|quote"),
    "null bytes behind a good beginning": (
        partial(large, text(*ROWS), "\n".join([*ROWS, ""]).encode(), 99, bytes(999)), "row|null"),
    "a header of 10 MB": (
        partial(large, b"", b"x", 10_000_000, text(*ROWS)), "its first line is longer than"),
    "a line of 9 MB": (partial(large, text(*ROWS[:3]), b"1", 9_000_000, b"\n1,2,3,4\n"), "row 5"),
    "10 million rows": (partial(rows_of, 10_000_000, b"1,2\n"), "10000000 rows; at most .* are re"),
}  # fmt: skip
SPECIAL: dict[str, tuple[Made, str]] = {
    "30 GB": (sparse, "30000000000 bytes; at most .* are read"),
    "a pipe": (os.mkfifo, "a pipe, not a plain file"),
    "endless": (partial(os.symlink, "/dev/zero"), "a device, not a plain file"),
    "a folder": (os.mkdir, "a folder"),
    "a link to nothing": (partial(os.symlink, "nothing"), "not there"),
    "nothing": (Path.exists, "not there"),  # which makes none
}


def table(path: Path, **columns: object) -> None:
    """The log as Parquet, with something else in some columns."""
    numbers = np.array([[float(x) for x in row.split(",")] for row in ROWS])
    held = {name: numbers[:, k] for k, name in enumerate(HEADER.split(","))}
    pq.write_table(pa.table({**held, **columns}), path)


def bare(path: Path, **columns: object) -> None:
    """Parquet of these columns alone."""
    pq.write_table(pa.table(columns), path)


def cut_short(make: Callable[[Path], object], path: Path) -> None:
    make(path)
    path.write_bytes(path.read_bytes()[:-99])


PARQUET: dict[str, tuple[Made, str]] = {
    "nested": (
        partial(table, rocker_deg=[[1.0, 2.0]] * 61),
        r"row 1, column 'rocker_deg': found .*1\.0.*not a number"),
    "nulls": (partial(table, rocker_deg=[1.0, None] * 30 + [2.0]), "row 2, .*the cell is empty"),
    "dates": (
        partial(table, rocker_deg=pa.array([1] * 61, pa.timestamp("ms"))),
        "column 'rocker_deg': found .*1970.*not a number",
    ),
    "NaN": (partial(table, C_x_mm=np.full(61, np.nan)), "row 1, column 'C_x_mm': found nan .61 su"),
    "no rows": (partial(bare, time_s=pa.array([], pa.float64())), "no rows"),
    "no columns": (bare, "no columns|no rows|empty"),
    "text that is none": (text(*ROWS), "not readable as Parquet"),
    "cut short": (partial(cut_short, table), "not readable as Parquet"),
    "empty": (b"", "empty"),
}  # fmt: skip


def book(path: Path, *, merged: str = "", first: str = "", **cells: object) -> None:
    """The log as a workbook with other cells, merged ones, or an empty sheet in front."""
    made = openpyxl.Workbook()
    sheet = made.active
    sheet.append(HEADER.split(","))
    for row in ROWS:
        sheet.append([float(x) for x in row.split(",")])
    for place, value in cells.items():
        sheet[place] = value
    if merged:
        sheet.merge_cells(merged)
    if first:
        made.create_sheet(first, 0)
    made.save(path)


def notes_first(path: Path) -> None:
    """The log behind a sheet of remarks."""
    made = openpyxl.Workbook()
    made.active.append(["made today"])
    made.create_sheet("log").append(HEADER.split(","))
    made.save(path)


def empty_book(path: Path) -> None:
    openpyxl.Workbook().save(path)


def bomb(path: Path) -> None:
    """A workbook of one megabyte whose sheet is a gigabyte when it is unpacked: ten of zeros, which
    are packed once and stand there a hundred times."""
    packer = zlib.compressobj(9, zlib.DEFLATED, -15)
    part = packer.compress(bytes(PART)) + packer.flush(zlib.Z_FULL_FLUSH)
    raw = part * 100 + packer.flush()
    sheet_of(path, "")
    with zipfile.ZipFile(path, "a") as file:
        (old,) = (each for each in file.filelist if "sheet1" in each.filename)
        file.filelist.remove(old)
        new = zipfile.ZipInfo(old.filename)
        new.CRC, new.compress_type, new.compress_size = 0, zipfile.ZIP_DEFLATED, len(raw)
        new.file_size, new.header_offset = 100 * PART, file.start_dir
        file.fp.seek(file.start_dir)
        file.fp.write(new.FileHeader(zip64=False) + raw)
        file.start_dir = file.fp.tell()
        file.filelist.append(new)
        file._didModify = True  # type: ignore[attr-defined]


def sheet_of(path: Path, inside: str) -> None:
    plain = io.BytesIO()
    openpyxl.Workbook().save(plain)
    with zipfile.ZipFile(plain) as old, zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as new:
        for name in old.namelist():
            new.writestr(name, inside if "sheet1" in name else old.read(name))


PART = 10_000_000
MAIN = "http://schemas.openxmlformats.org/spreadsheetml/2006/main"
FAR = (
    f'<worksheet xmlns="{MAIN}"><dimension ref="A1:B2"/><sheetData>'
    '<row r="1"><c r="A1" t="inlineStr"><is><t>time_s</t></is></c>'
    '<c r="B1" t="inlineStr"><is><t>crank_deg</t></is></c></row>'
    '<row r="300000"><c r="ALL300000"><v>1</v></c></row></sheetData></worksheet>'
)
LAUGHS = (
    "<!DOCTYPE a ["
    + '<!ENTITY l0 "ha">'
    + "".join(f'<!ENTITY l{k} "{f"&l{k - 1};" * 10}">' for k in range(1, 12))
    + f']><worksheet xmlns="{MAIN}"><sheetData><row r="1"><c r="A1" t="inlineStr"><is><t>'
    "&l11;</t></is></c></row></sheetData></worksheet>"
)
WORKBOOKS: dict[str, tuple[Made, str]] = {
    "a formula without its number": (partial(book, C9="=A9*2"), "row 9, column 'rocker_deg'"),
    "an empty cell": (partial(book, C9=None), "row 9, column 'rocker_deg': the cell is empty"),
    "merged cells": (partial(book, merged="C9:C12"), "row 10, column 'rocker_deg': the cell is em"),
    "a sheet of remarks": (
        notes_first, "sheet 'Sheet': a header and no rows; .*set sheet = .log. in .file."),
    "numbers for names": (
        partial(book, A1=0.5, B1=1.5, C1=2.5, D1=3.5), "sheet 'Sheet': row 1 holds numbers and no"),
    "hours": (partial(book, A2=time(0, 0, 1)), "row 2, column 'time_s': found '00:00:01'.*seconds"),
    "an empty sheet": (partial(book, first="first"), "sheet 'first' is empty"),
    "no sheet of numbers": (empty_book, "is empty"),
    "a bomb": (bomb, "bytes when it is unpacked; at most .* are read|no workbook"),
    "a cell far away": (
        partial(sheet_of, inside=FAR), "cells up to row 300000 and column 1000; at most"),
    "laughs": (partial(sheet_of, inside=LAUGHS), "not readable as a workbook"),
    "text that is none": (text(*ROWS), "not readable as a workbook"),
    "cut short": (partial(cut_short, book), "not readable as a workbook"),
}  # fmt: skip
