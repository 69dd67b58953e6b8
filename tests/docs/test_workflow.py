"""The workflow of the page on gates runs as it stands there: in a clean folder, each step in a
shell as GitHub starts it, with a program that keeps artifacts in the place of GitHub's."""

import json
import os
import re
import shutil
import subprocess
from pathlib import Path

import yaml

from models.files.reading import shipped
from tests.worlds.command import COMMAND
from tests.worlds.tiers import slow

PAGE = Path(__file__).parents[2] / "docs" / "how-to" / "gate-ci.md"
GH = """#!/bin/sh
[ "$1 $2" = "run list" ] && [ -d "{kept}" ] && echo 17
[ "$1 $2" = "run list" ] && exit 0
[ "$*" = "run download 17 --name baseline --dir baseline" ] && cp -r "{kept}" baseline
"""


def job() -> list[dict[str, object]]:
    (text,) = re.findall("```yaml\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    steps: list[dict[str, object]] = yaml.safe_load(text)["jobs"]["verify"]["steps"]
    return steps


def ran(folder: Path, kept: Path, scene: str) -> tuple[int, str]:
    """Exit code of the first step that fails, or 0, and the summary, of a job in a new folder."""
    (folder / "scenes").mkdir(parents=True)
    (folder / "bin").mkdir()
    (folder / "scenes" / "mine.toml").write_text(scene, encoding="utf-8")
    for name, text in {"gh": GH.format(kept=kept), "pip": "#!/bin/sh\n"}.items():
        (folder / "bin" / name).write_text(text)
        (folder / "bin" / name).chmod(0o755)
    summary = folder / "summary.md"
    own = {"PATH": f"{folder / 'bin'}:{Path(COMMAND).parent}:{os.environ['PATH']}"}
    env = os.environ | own | {"GITHUB_STEP_SUMMARY": str(summary), "CI": "true"}
    for step in job():
        if "run" in step:
            command = ["bash", "-e", "-c", str(step["run"])]
            done = subprocess.run(command, cwd=folder, env=env, capture_output=True, check=False)
            if done.returncode:
                return done.returncode, summary.read_text(encoding="utf-8")
    (uploaded,) = (step for step in job() if "upload" in str(step.get("uses")))
    assert uploaded["with"] == {"name": "baseline", "path": "now"}
    shutil.copytree(folder / "now", kept, dirs_exist_ok=True)
    return 0, summary.read_text(encoding="utf-8")


@slow("a minute: verifications and hard cases, three times each")
def test_the_first_run_makes_the_baseline_of_the_next_and_a_worse_one_fails(tmp_path: Path) -> None:
    scene, kept = shipped()["fourbar-lecture-1"].read_text(encoding="utf-8"), tmp_path / "kept"
    code, first = ran(tmp_path / "first", kept, scene)
    assert code == 0
    assert re.findall("^## crankcheck ([a-z]+)", first, re.M) == ["verify", "stability"]
    assert "WORSE" not in first
    code, second = ran(tmp_path / "second", kept, scene)
    assert (code, second.count("NOT WORSE")) == (0, 2)
    better = kept / "hard" / "stability.json"
    content = json.loads(better.read_text(encoding="utf-8"))
    content["critical"][0] |= {"holds": content["cases"][0]["values"][-1], "fails": None}
    better.write_text(json.dumps(content), encoding="utf-8")
    code, third = ran(tmp_path / "third", kept, scene)
    assert code == 1
    assert "- worse coarse-step mujoco tuned: critical value" in third
