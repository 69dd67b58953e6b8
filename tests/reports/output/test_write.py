"""Files are refused before the work, and written whole or not at all after it."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

from models.errors import CrankcheckError
from reports.output.write import check_file, check_folder, check_outputs, write

NOT_ROOT = pytest.mark.skipif(
    not hasattr(os, "geteuid") or os.geteuid() == 0, reason="root may write everywhere"
)


def test_a_file_is_replaced_whole_and_nothing_is_left_beside_it(tmp_path: Path) -> None:
    target = tmp_path / "out.csv"
    target.write_text("old and much longer than the new one")
    write(target, "new")
    assert target.read_text() == "new"
    assert list(tmp_path.iterdir()) == [target]


def test_a_write_that_fails_leaves_the_old_file_and_no_other(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    target = tmp_path / "out.csv"
    target.write_text("old")

    def full(self: Path, target: Path) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "replace", full)
    with pytest.raises(CrankcheckError, match="No space left"):
        write(target, "new")
    assert target.read_text() == "old"
    assert list(tmp_path.iterdir()) == [target]


@pytest.mark.parametrize("target", ["other.csv", "nothing", "folder", "/dev/null"])
def test_a_link_is_refused_where_it_is_named_and_replaced_in_a_folder(
    target: str, tmp_path: Path
) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "other.csv").write_text("of another")
    link = tmp_path / "out" / "link.csv"
    link.parent.mkdir()
    link.symlink_to(tmp_path / target)
    with pytest.raises(CrankcheckError, match=rf"--csv .*: a link, to .*{target}; name that"):
        check_file(link, "--csv")
    check_folder(link.parent, "-o", [link.name])
    check_outputs({}, link.parent, [link.name])
    write(link, "new")
    assert not link.is_symlink()
    assert (tmp_path / "other.csv").read_text() == "of another"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["folder", "other.csv", "out"]


def test_a_file_of_several_names_is_changed_under_one_of_them(tmp_path: Path) -> None:
    (tmp_path / "other").write_text("of another")
    (tmp_path / "out").hardlink_to(tmp_path / "other")
    write(tmp_path / "out", "new")
    assert (tmp_path / "other").read_text() == "of another"


def test_a_link_where_it_is_written_aside_is_not_followed(tmp_path: Path) -> None:
    (tmp_path / "other").write_text("of another")
    (tmp_path / f".out.{os.getpid()}.tmp").symlink_to(tmp_path / "other")
    write(tmp_path / "out", "new")
    assert (tmp_path / "other").read_text() == "of another"
    assert (tmp_path / "out").read_text() == "new"


def test_a_folder_may_be_a_link_but_not_to_nothing(tmp_path: Path) -> None:
    (tmp_path / "real").mkdir()
    for name in ("real", "nothing"):
        (tmp_path / f"to {name}").symlink_to(tmp_path / name)
    check_folder(tmp_path / "to real", "-o", ["out.csv"])
    write(tmp_path / "to real" / "out.csv", "new")
    assert (tmp_path / "real" / "out.csv").read_text() == "new"
    for deeper in ("", "deeper"):
        with pytest.raises(CrankcheckError, match=r"-o .*to nothing: a link, to .*nothing; name"):
            check_folder(tmp_path / "to nothing" / deeper, "-o")


@pytest.mark.skipif(not Path("/dev/fd").exists(), reason="no such links here")
def test_what_the_shell_made_a_pipe_of_is_written_into() -> None:
    read, into = os.pipe()
    path = Path(f"/dev/fd/{into}")
    check_file(path, "--csv")
    write(path, "new")
    os.close(into)
    assert os.read(read, 9) == b"new"
    os.close(read)


@pytest.mark.skipif(not Path("/proc/self/fd").exists(), reason="no such links here")
@pytest.mark.parametrize("name", ["/dev/stdout", "/dev/fd/1", "/proc/self/fd/1"])
def test_what_the_shell_made_a_file_of_is_written_into(name: str, tmp_path: Path) -> None:
    """In its turn: what the process prints there before and after stays."""
    code = f"""
from pathlib import Path
from reports.output.write import check_outputs, write
print("before")
check_outputs({{"--csv": Path("{name}"), "--json": Path("{name}")}})
write(Path("{name}"), "new\\n")
write(Path("{name}"), "newer\\n")
print("after")
"""
    with (tmp_path / "out").open("w") as out:
        subprocess.run([sys.executable, "-c", code], stdout=out, check=True)
    assert (tmp_path / "out").read_text().split() == ["before", "new", "newer", "after"]
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


@pytest.mark.parametrize("name", ["/proc/self/cwd", "/dev/fd"])
def test_a_folder_that_the_system_has_a_link_to_is_no_stream(name: str) -> None:
    if not Path(name).is_symlink():
        pytest.skip("no such link here")
    with pytest.raises(CrankcheckError, match=f"--csv {name}: a link, to .*; name that itself"):
        check_file(Path(name), "--csv")


@pytest.mark.skipif(not os.access("/dev/shm", os.W_OK), reason="no such folder here")
def test_a_link_of_a_user_among_those_of_the_system_is_refused(tmp_path: Path) -> None:
    with tempfile.TemporaryDirectory(dir="/dev/shm") as folder:
        for target in (tmp_path / "other", Path("/dev/null")):
            link = Path(folder) / target.name
            link.symlink_to(target)
            target.touch()
            with pytest.raises(CrankcheckError, match=r"--csv .*: a link, to .*; name"):
                check_file(link, "--csv")


@pytest.mark.skipif(not Path("/dev/null").exists(), reason="no devices here")
def test_a_device_is_written_to_and_not_replaced() -> None:
    write(Path("/dev/null"), "gone")
    assert not Path("/dev/null").is_file()


def test_folders_on_the_way_are_made(tmp_path: Path) -> None:
    write(tmp_path / "a" / "b" / "c.txt", b"raw")
    assert (tmp_path / "a" / "b" / "c.txt").read_bytes() == b"raw"


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("folder", "a folder; name a file in it"),
        ("nowhere/out.csv", "there is no folder"),
        ("file.csv/out.csv", "there is no folder"),
        ("out.txt", "found '.txt'; use .csv"),
        ("out", "found no ending; use .csv"),
    ],
)
def test_a_file_that_can_not_be_written_is_refused(tmp_path: Path, name: str, message: str) -> None:
    (tmp_path / "folder").mkdir()
    (tmp_path / "file.csv").touch()
    endings = (".csv",) if "out." in name or name == "out" else ()
    with pytest.raises(CrankcheckError, match=message):
        check_file(tmp_path / name, "-o", endings)


def test_a_folder_below_a_file_is_refused(tmp_path: Path) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(CrankcheckError, match="is a file; name a folder"):
        check_folder(tmp_path / "file" / "deep" / "out", "-o")


def test_a_folder_that_has_to_be_made_is_fine_and_is_not_made_yet(tmp_path: Path) -> None:
    check_folder(tmp_path / "a" / "b", "-o")
    assert not (tmp_path / "a").exists()


@pytest.mark.skipif(not Path("/proc/self").exists(), reason="no such folder here")
def test_a_folder_that_takes_no_file_is_found_out_before_the_work() -> None:
    """Its rights say nothing: those of root are all."""
    with pytest.raises(CrankcheckError, match=r"--json /proc/x\.json: "):
        check_file(Path("/proc/x.json"), "--json")
    with pytest.raises(CrankcheckError, match=r"-o /proc/x: "):
        check_folder(Path("/proc/x"), "-o")


@pytest.mark.parametrize(("number", "space"), [(28, True), (5, False)])
def test_space_is_named_only_where_there_is_none(
    number: int, space: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refused(self: Path, target: Path) -> None:
        raise OSError(number, os.strerror(number))

    monkeypatch.setattr(Path, "replace", refused)
    with pytest.raises(CrankcheckError, match="choose another place") as told:
        write(tmp_path / "out.csv", "new")
    assert ("free some space there" in str(told.value)) == space


def test_a_place_that_may_not_be_looked_at_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def locked(self: Path, **_: object) -> object:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "stat", locked)
    for check in (check_file, check_folder):
        with pytest.raises(CrankcheckError, match=r"-o .*Permission denied; choose another place"):
            check(tmp_path / "locked" / "out", "-o")


def test_a_file_of_a_folder_that_may_not_be_replaced_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "cells.csv").touch()
    monkeypatch.setattr(os, "access", lambda path, _: Path(path).name != "cells.csv")
    with pytest.raises(CrankcheckError, match=r"-o .*cells.csv: no right to write it"):
        check_folder(tmp_path, "-o", ["cells.csv", "other.csv"])
    check_folder(tmp_path, "-o", ["other.csv"])


def test_one_file_for_two_outputs_is_refused_unless_it_is_a_device(tmp_path: Path) -> None:
    link = tmp_path / "link"
    link.symlink_to(tmp_path)
    with pytest.raises(CrankcheckError, match="--csv and --json: both name"):
        check_outputs({"--csv": tmp_path / "out", "--json": link / "out", "--junit": None})
    with pytest.raises(CrankcheckError, match="--csv and -o: both name"):
        check_outputs({"--csv": tmp_path / "out"}, tmp_path, ["out"])
    check_outputs({"--csv": Path("/dev/null"), "--json": Path("/dev/null")})


@NOT_ROOT
def test_a_folder_without_the_right_to_write_is_refused(tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    try:
        with pytest.raises(CrankcheckError, match="no right to write"):
            check_folder(tmp_path / "out", "-o")
        with pytest.raises(CrankcheckError, match="no right to write"):
            check_file(tmp_path / "out.csv", "-o")
    finally:
        tmp_path.chmod(0o700)
