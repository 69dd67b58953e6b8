"""Files are refused before the work, and written whole or not at all after it; tables in them keep
every digit, and Markdown the names that would be markup."""

import io
import math
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

import numpy as np
import openpyxl
import pandas as pd
import pytest

from models.errors import CrankcheckError
from reports.output.formats import code, counted, folded, plain, table, workbook, write_frame
from reports.output.write import Outputs, check_file, check_folder, write

NOT_ROOT = pytest.mark.skipif(
    not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write everywhere"
)
HARD = [0.1 + 0.2, 1e-300, 5e-324, -1.7976931348623157e308, 1 / 3, 1.5e-323, -0.0, 123456789.1]
READERS = {".csv": pd.read_csv, ".parquet": pd.read_parquet, ".xlsx": pd.read_excel}
NASTY = "a|b `c` <d> [e](f) @team *g* $h$ #1 \\ 中文"


def where(path: str) -> pytest.MarkDecorator:
    return pytest.mark.skipif(not Path(path).exists(), reason="there is no such thing here")


def refused(message: str, check: Callable[..., None], *arguments: object) -> None:
    with pytest.raises(CrankcheckError, match=message):
        check(*arguments)


def test_a_file_is_replaced_whole_and_nothing_is_left_beside_it(tmp_path: Path) -> None:
    target = tmp_path / "out.csv"
    target.write_text("old and much longer than the new one")
    write(target, "new")
    assert target.read_text() == "new"
    assert list(tmp_path.iterdir()) == [target]
    write(tmp_path / "a" / "b" / "c.txt", b"raw")
    assert (tmp_path / "a" / "b" / "c.txt").read_bytes() == b"raw"


@pytest.mark.parametrize(("number", "space"), [(28, True), (5, False)])
def test_a_write_that_fails_leaves_the_old_file_and_names_space_where_there_is_none(
    number: int, space: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(self: Path, target: Path) -> None:
        raise OSError(number, os.strerror(number))

    target = tmp_path / "out.csv"
    target.write_text("old")
    monkeypatch.setattr(Path, "replace", fail)
    with pytest.raises(CrankcheckError, match=f"{os.strerror(number)}.*choose another pl") as told:
        write(target, "new")
    assert ("free some space there" in str(told.value)) == space
    assert target.read_text() == "old"
    assert list(tmp_path.iterdir()) == [target]


@pytest.mark.parametrize("target", ["other.csv", "nothing", "folder", "/dev/null"])
def test_a_named_link_is_refused_and_one_in_a_folder_replaced(target: str, tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "other.csv").write_text("of another")
    link = tmp_path / "out" / "link.csv"
    link.parent.mkdir()
    link.symlink_to(tmp_path / target)
    refused(rf"--csv .*: a link to .*{target}; name this", check_file, link, "--csv")
    check_folder(link.parent, "-o", [link.name])
    Outputs({}, link.parent, {link.name: ""}).check()
    write(link, "new")
    assert not link.is_symlink()
    assert (tmp_path / "other.csv").read_text() == "of another"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["folder", "other.csv", "out"]


def test_neither_other_names_of_a_file_nor_links_aside_are_followed(tmp_path: Path) -> None:
    other, out = tmp_path / "other", tmp_path / "out"
    other.write_text("of another")
    out.hardlink_to(other)
    (tmp_path / f".out.{os.getpid()}.tmp").symlink_to(other)
    write(out, "new")
    assert (other.read_text(), out.read_text()) == ("of another", "new")


def test_a_folder_may_be_a_link_but_not_to_nothing(tmp_path: Path) -> None:
    (tmp_path / "real").mkdir()
    for name in ("real", "nothing"):
        (tmp_path / f"to {name}").symlink_to(tmp_path / name)
    check_folder(tmp_path / "to real" / "to be made", "-o", ["out.csv"])
    assert not list((tmp_path / "real").iterdir())
    write(tmp_path / "to real" / "out.csv", "new")
    assert (tmp_path / "real" / "out.csv").read_text() == "new"
    for deeper in ("", "deeper"):
        words = r"-o .*to nothing: a link to .*nothing; name"
        refused(words, check_folder, tmp_path / "to nothing" / deeper, "-o")


@where("/dev/fd")
def test_a_device_and_what_the_shell_made_a_pipe_of_are_written_into() -> None:
    write(Path("/dev/null"), "gone")
    assert not Path("/dev/null").is_file()
    read, into = os.pipe()
    path = Path(f"/dev/fd/{into}")
    check_file(path, "--csv")
    write(path, "new")
    os.close(into)
    assert os.read(read, 9) == b"new"
    os.close(read)


@where("/proc/self/fd")
@pytest.mark.parametrize("name", ["/dev/stdout", "/proc/self/fd/1"])
def test_what_the_shell_made_a_file_of_is_written_into(name: str, tmp_path: Path) -> None:
    """In its turn: what the process prints there before and after stays."""
    script = f"""
from pathlib import Path
from reports.output.write import Outputs, write
print("before")
Outputs({{"--csv": Path("{name}"), "--json": Path("{name}")}}).check()
write(Path("{name}"), "new\\n")
write(Path("{name}"), "newer\\n")
print("after")
"""
    with (tmp_path / "out").open("w") as out:
        subprocess.run([sys.executable, "-c", script], stdout=out, check=True)
    assert (tmp_path / "out").read_text().split() == ["before", "new", "newer", "after"]
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


@pytest.mark.parametrize("name", ["/proc/self/cwd", "/dev/fd"])
def test_a_folder_that_the_system_has_a_link_to_is_no_stream(name: str) -> None:
    if not Path(name).is_symlink():
        pytest.skip("no such link here")
    refused(f"--csv {name}: a link to .*; name this file itself", check_file, Path(name), "--csv")


@pytest.mark.skipif(not os.access("/dev/shm", os.W_OK), reason="no such folder here")
def test_a_link_of_a_user_among_those_of_the_system_is_refused(tmp_path: Path) -> None:
    with tempfile.TemporaryDirectory(dir="/dev/shm") as folder:
        for target in (tmp_path / "other", Path("/dev/null")):
            link = Path(folder) / target.name
            link.symlink_to(target)
            target.touch()
            refused(r"--csv .*: a link to .*; name", check_file, link, "--csv")


@pytest.mark.parametrize(
    ("check", "name", "more", "message"),
    [
        (check_file, "folder", [], "a folder; name a file in it"),
        (check_file, "nowhere/out.csv", [(".csv",)], "there is no folder"),
        (check_file, "file.csv/out.csv", [(".csv",)], "there is no folder"),
        (check_file, "out.txt", [(".csv",)], "found '.txt'; use .csv"),
        (check_file, "out", [(".csv",)], "found no ending; use .csv"),
        (check_folder, "file.csv/deep/out", [], "is a file; name a folder"),
        # The rights of /proc say nothing: those of root are all.
        pytest.param(check_file, "/proc/x.json", [], r"-o /proc/x\.json: ", marks=where("/proc")),
        pytest.param(check_folder, "/proc/x", [], "-o /proc/x: ", marks=where("/proc")),
    ],
)
def test_what_can_not_be_written_is_refused_before_the_work(
    check: Callable[..., None], name: str, more: list[object], message: str, tmp_path: Path
) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "file.csv").touch()
    refused(message, check, tmp_path / name, "-o", *more)


def test_a_place_not_to_be_seen_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def locked(self: Path, **_: object) -> object:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "stat", locked)
    for check in (check_file, check_folder):
        words = r"-o .*Permission denied; choose another place"
        refused(words, check, tmp_path / "locked" / "out", "-o")


def test_a_file_of_a_folder_that_may_not_be_replaced_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "cells.csv").touch()
    monkeypatch.setattr(os, "access", lambda path, _: Path(path).name != "cells.csv")
    words = r"-o .*cells.csv: no right to write it"
    refused(words, check_folder, tmp_path, "-o", ["cells.csv", "other.csv"])
    check_folder(tmp_path, "-o", ["other.csv"])


def test_one_file_for_two_outputs_is_refused_unless_it_is_a_device(tmp_path: Path) -> None:
    out, link = tmp_path / "out", tmp_path / "link"
    link.symlink_to(tmp_path)
    twice = {"--csv": out, "--json": link / "out", "--junit": None}
    refused("--csv and --json: both name", Outputs(twice).check)
    refused("--csv and -o: both name", Outputs({"--csv": out}, tmp_path, {"out": ""}).check)
    Outputs({"--csv": Path("/dev/null"), "--json": Path("/dev/null")}).check()


@NOT_ROOT
def test_a_folder_without_the_right_to_write_is_refused(tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    try:
        for check in (check_file, check_folder):
            refused("no right to write", check, tmp_path / "out.csv", "-o")
    finally:
        tmp_path.chmod(0o700)


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
    facts = {"scene": "=2+2", "source": "bell \x07"}
    book = openpyxl.load_workbook(io.BytesIO(workbook(frame, "log", facts)))
    assert book.sheetnames == ["log", "source"]
    rows = list(book["source"].iter_rows(values_only=True))
    assert rows[1:3] == [("scene", "=2+2"), ("source", "bell \ufffd")]
    assert rows[-1][0] == "crankcheck"
    assert book["source"]["B2"].data_type == "s"
    assert (book["log"]["A2"].value, book["log"]["A2"].data_type) == (1.5, "n")


def test_names_in_markdown_mean_themselves_and_a_fence_is_longer_than_any_in_the_code() -> None:
    text = plain(NASTY)
    assert re.sub(r"\\(.)", r"\1", text).replace("\N{WORD JOINER}", "") == NASTY
    assert "@team" not in text
    for special in "|`<[*$#":
        assert not re.search(rf"(?<!\\){re.escape(special)}", text), special
    assert plain("a\n\n| b") == r"a \| b"
    assert folded("<b> & @team", "x").startswith(
        "<details><summary>&lt;b&gt; &amp; @\N{WORD JOINER}team</summary>\n\nx\n\n</details>"
    )
    assert code("a\n````\nb\n", "xml") == "`````xml\na\n````\nb\n`````"
    assert code("a", "") == "```\na\n```"


def test_what_has_no_room_is_counted() -> None:
    text = table(("name", "number:"), [("x" * 50, i) for i in range(100)], 2000)
    assert len(text.encode()) < 2000
    shown = text.count("\n| ") - 1
    assert text.endswith(f"\n\nand {100 - shown} more")
    assert shown > 20
    assert counted(["a" * 10] * 3, 25, "lines") == ["a" * 10, "a" * 10, "\nand 1 more lines"]
    assert counted(["a" * 10] * 2, 25, "lines") == ["a" * 10, "a" * 10]
