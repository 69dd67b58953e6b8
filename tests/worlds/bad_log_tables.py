"""Parquet files and workbooks that are no log, with words of the message that refuses each."""

from __future__ import annotations

import io
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

from tests.worlds.bad_log_texts import HEADER, ROWS, Made, text


def table(path: Path, **columns: object) -> None:
    """The log as Parquet, with something else in some columns."""
    numbers = np.array([[float(x) for x in row.split(",")] for row in ROWS])
    held = {name: numbers[:, k] for k, name in enumerate(HEADER.split(","))}
    pq.write_table(pa.table({**held, **columns}), path)


def bare(path: Path, **columns: object) -> None:
    """Parquet of these columns alone."""
    pq.write_table(pa.table(columns), path)


def cut_short(make: Callable[[Path], object], path: Path) -> None:
    """A file that lacks its last bytes."""
    make(path)
    path.write_bytes(path.read_bytes()[:-99])


PARQUET: dict[str, tuple[Made, str]] = {
    "nested": (
        partial(table, rocker_deg=[[1.0, 2.0]] * 61),
        r"row 1, column 'rocker_deg': found .*1\.0.*no number",
    ),
    "a table in a column": (
        partial(table, rocker_deg=[{"a": 1.0}] * 61),
        "row 1, column 'rocker_deg': found .*, no number",
    ),
    "text": (partial(table, rocker_deg=["x"] * 61), "row 1, column 'rocker_deg': found 'x', no nu"),
    "truths": (partial(table, rocker_deg=[True] * 61), "column 'rocker_deg': found True, no num"),
    "nulls": (partial(table, rocker_deg=[1.0, None] * 30 + [2.0]), "row 2, .*the cell is empty"),
    "all nulls": (partial(table, rocker_deg=pa.nulls(61)), "row 1, .*the cell is empty"),
    "bytes": (partial(table, rocker_deg=[b"1"] * 61), "column 'rocker_deg': found .*no number"),
    "dates": (
        partial(table, rocker_deg=pa.array([1] * 61, pa.timestamp("ms"))),
        "column 'rocker_deg': found .*1970.*no number",
    ),
    "NaN": (partial(table, C_x_mm=np.full(61, np.nan)), "row 1, column 'C_x_mm': found nan .61 su"),
    "no rows": (partial(bare, time_s=pa.array([], pa.float64())), "no rows"),
    "no columns": (bare, "no columns|no rows|empty"),
    "text that is none": (text(*ROWS), "no Parquet that can be read"),
    "cut short": (
        partial(cut_short, table),
        "no Parquet that can be read",
    ),
    "empty": (b"", "empty"),
}


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
    sheet = made.active
    sheet.append(["made today"])
    made.create_sheet("log").append(HEADER.split(","))
    made.save(path)


def empty_book(path: Path) -> None:
    openpyxl.Workbook().save(path)


def archive(path: Path) -> None:
    """A zip of something else."""
    with zipfile.ZipFile(path, "w") as file:
        file.writestr("a", "b")


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
    """A workbook whose sheet is this XML."""
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
    "an error": (partial(book, C9="#DIV/0!"), "row 9, column 'rocker_deg'.*"),
    "text": (partial(book, C9="x"), "row 9, column 'rocker_deg': found 'x', no number"),
    "an empty cell": (partial(book, C9=None), "row 9, column 'rocker_deg': the cell is empty"),
    "merged cells": (
        partial(book, merged="C9:C12"),
        "row 10, column 'rocker_deg': the cell is empty",
    ),
    "a merged header": (
        partial(book, merged="B1:C1"),
        "column 3 has no name",
    ),
    "a sheet of remarks": (
        notes_first, "sheet 'Sheet': a header and no rows; .*say sheet in .file. of the map: log",
    ),
    "numbers for names": (
        partial(book, A1=0.5, B1=1.5, C1=2.5, D1=3.5), "sheet 'Sheet': row 1 holds numbers and no",
    ),
    "hours": (partial(book, A2=time(0, 0, 1)), "row 2, column 'time_s': found '00:00:01'.*seconds"),
    "an empty sheet": (
        partial(book, first="first"),
        "sheet 'first' is empty",
    ),
    "no sheet of numbers": (empty_book, "is empty"),
    "a bomb": (bomb, "bytes when it is unpacked; at most .* are read|no workbook"),
    "a cell far away": (
        partial(sheet_of, inside=FAR), "cells up to row 300000 and column 1000; at most",
    ),
    "laughs": (partial(sheet_of, inside=LAUGHS), "no workbook that can be read"),
    "text that is none": (text(*ROWS), "no workbook that can be read"),
    "cut short": (
        partial(cut_short, book),
        "no workbook that can be read",
    ),
    "another archive": (
        archive,
        "no workbook that can be read",
    ),
}  # fmt: skip
