"""An installer of engines that needs no network, and versions of MuJoCo made of the one here."""

import sys
from pathlib import Path

INSTALLER = """\
#!{python}
# Stands in for uv: an environment with a package `mujoco`, which is the one that runs here under
# another version.
import subprocess, sys
from pathlib import Path

arguments = sys.argv[1:]
with open({log!r}, "a") as log:
    log.write(" ".join(arguments) + "\\n")
if arguments[0] == "venv":
    sys.exit(subprocess.call([{python!r}, "-m", "venv", "--without-pip", arguments[-1]]))
version = arguments[-1].partition("==")[2]
if version == "9.9.9":
    print("error: No solution found when resolving dependencies", file=sys.stderr)
    print("  cause: Because there is no version of mujoco==9.9.9 and you", file=sys.stderr)
    print("         require mujoco==9.9.9, we can conclude that it is so.", file=sys.stderr)
    sys.exit(1)
environment = Path(arguments[arguments.index("--python") + 1]).parents[1]
(site,) = environment.glob("lib/python*/site-packages")
(site / "mujoco").mkdir()
code = Path({stub!r}).read_text().replace("VERSION", version)
(site / "mujoco" / "__init__.py").write_text(code)
(site / f"mujoco-{{version}}.dist-info").mkdir()
(site / f"mujoco-{{version}}.dist-info" / "METADATA").write_text(
    f"Metadata-Version: 2.1\\nName: mujoco\\nVersion: {{version}}\\n"
)
"""
STUB = """\
import sys
from importlib.machinery import PathFinder
from importlib.util import module_from_spec
from pathlib import Path

here = str(Path(__file__).parents[1])
found = PathFinder.find_spec("mujoco", [path for path in sys.path if path != here])
module = sys.modules["mujoco"] = module_from_spec(found)
found.loader.exec_module(module)
module.mj_versionString = lambda: "VERSION"
"""


def fake_installer(folder: Path) -> Path:
    """The folder, with a command `uv` in it, and the `log` of its calls."""
    stub, program = folder / "stub.py", folder / "uv"
    stub.write_text(STUB, encoding="utf-8")
    paths = {"log": str(folder / "log"), "stub": str(stub)}
    program.write_text(INSTALLER.format(python=sys.executable, **paths), encoding="utf-8")
    program.chmod(0o755)
    return folder
