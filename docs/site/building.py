"""From pages to the site, step by step; each step needs the one before it to be without fault."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path

from docs.site.examples import run_examples, with_figures
from docs.site.formulas import fault_of
from docs.site.inspection import faults_of_site
from docs.site.staging import ROOT, pages

HERE = Path(__file__).parent
LOOKS = ("site.css", "iframe-worker.js")
COLOUR = re.compile(r"\x1b\[[0-9;]*m")
PROGRESS = re.compile(r"(Build started|Build finished.*|No issues found|\s*)")


def build(output: Path, *, examples: bool = True) -> list[str]:
    """Build the site in the folder ``output``, which is replaced, and return fault with it;
    where something is, the folder stays as it was. Without examples no command is run, and figures
    are stood in for."""
    with tempfile.TemporaryDirectory(prefix="crankcheck-docs-") as folder:
        stage = Path(folder)
        faults = _staged(stage, examples=examples) or _rendered(stage)
        if faults:
            return faults
        shutil.rmtree(output, ignore_errors=True)
        shutil.copytree(stage / "site", output)
    return []


def _staged(stage: Path, *, examples: bool) -> list[str]:
    """Write all pages, with their figures, where zensical reads them."""
    made = pages()
    if told := {place: fault for place, page in made.items() if (fault := fault_of(page))}:
        return _named(told)
    runs = stage / "runs"
    if examples and (told := run_examples(made, runs)):
        return _named(told)
    faults = []
    for place, page in made.items():
        there = stage / "pages" / place
        there.parent.mkdir(parents=True, exist_ok=True)
        text, missing = with_figures(place, page, runs if examples else None, stage / "pages")
        faults += [f"{place}: shows {name}, which none of its commands draws" for name in missing]
        there.write_text(text, encoding="utf-8")
    for name in LOOKS:
        shutil.copyfile(HERE / name, stage / "pages" / name)
    shutil.copyfile(HERE / "zensical.toml", stage / "zensical.toml")
    return faults


def _named(faults: Mapping[str, str]) -> list[str]:
    return [f"{place}\n{fault}" for place, fault in faults.items()]


def _rendered(stage: Path) -> list[str]:
    """Make the site; whatever zensical says beside its progress is a fault."""
    done = subprocess.run(
        [sys.executable, "-m", "zensical", "build", "--strict"],
        cwd=stage,
        env={**os.environ, "PYTHONPATH": str(ROOT), "NO_COLOR": "1"},
        capture_output=True,
        text=True,
        check=False,
    )
    told, _, crash = COLOUR.sub("", done.stdout + done.stderr).partition("Traceback (most recent")
    if crash and "--strict" not in crash.splitlines()[-1]:  # which only repeats what was told
        told += "\n".join(line for line in crash.splitlines() if not line.startswith(" "))
    said = [line for line in told.splitlines() if not PROGRESS.fullmatch(line)]
    if said or done.returncode != 0:
        return ["\n".join(said) or f"zensical ended with {done.returncode}"]
    return list(faults_of_site(stage / "site"))
