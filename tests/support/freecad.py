"""FreeCAD with the workbench in a home folder of its own."""

import importlib.util
import os
import shutil
from pathlib import Path

import gearcad

ROOT = Path(__file__).parents[2]
WORKBENCH = ROOT / "freecad" / "gearcad_workbench"
_MODULES = {"fonttools": "fontTools"}
"""Names of modules that differ from those of their packages."""


def install_workbench(home: Path) -> None:
    """Install the workbench as its manual says, with links to gearcad and to the packages of packages.txt."""
    mod = home / ".local" / "share" / "FreeCAD" / "Mod" / "gearcad_workbench"
    shutil.copytree(WORKBENCH, mod, ignore=shutil.ignore_patterns("packages", "__pycache__"))
    packages = mod / "packages"
    packages.mkdir()
    (packages / "gearcad").symlink_to(Path(gearcad.__file__).resolve().parent)
    (packages / "templates").symlink_to(ROOT / "templates")
    for line in (WORKBENCH / "packages.txt").read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            name = line.partition(">=")[0]
            spec = importlib.util.find_spec(_MODULES.get(name, name))
            assert spec is not None and spec.origin is not None
            file = Path(spec.origin)
            file = file.parent if file.name == "__init__.py" else file
            (packages / file.name).symlink_to(file)


def freecad_environment(home: Path, **more: str) -> dict[str, str]:
    """Return the environment of FreeCAD with this home folder, without anything of the Python that runs the tests."""
    found = {key: value for key, value in os.environ.items() if not key.startswith(("PYTHON", "XDG_"))}
    return found | {"HOME": str(home)} | more
