"""What commands do without: a library that one of them does not need would be most of the time that it takes."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

TEMPLATES = Path(__file__).parents[2] / "templates"

_CODE = """
import json, sys
from gearcad.cli import main
def known(*arguments):
    try:
        main(arguments, standalone_mode=False)
    except SystemExit as end:
        assert not end.code
    return sorted(sys.modules)
spec = sys.argv[1]
found = [known("data", spec), known("build", spec, "--quiet", "--format", "stl,3mf,glb,csv"), known("build", spec, "--quiet")]
print(json.dumps(found))
"""
"""Every command after the other, the lightest first, in one process, which tells what it has imported by then."""

HEAVY = {
    *("matplotlib", "gmsh", "skfem", "meshio", "numba", "scipy", "vtk", "vtkmodules", "PIL", "reportlab", "lxml", "networkx"),
    *(
        "cadquery",
        "OCP",
        "trimesh",
        "ezdxf",
        "fontTools",
        "rich",
        "tomlkit",
        "jinja2",
        "filelock",
        "threadpoolctl",
        "distributed",
    ),
}
"""No command for the data or the usual files of a gear needs any of these."""

FOREIGN = {"check", "contact", "dynamics", "meshing", "planetary", "rating", "sizing", "stiffness", "report", "plots", "batch"}
"""Rooms of gearcad that a gear's data and files have nothing to do with."""


def test_data_and_files_of_a_gear_need_no_heavy_library_and_no_room_of_other_kinds(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", _CODE, str(TEMPLATES / "spur.toml")], cwd=tmp_path, check=True, capture_output=True, text=True
    )
    for modules in map(set, json.loads(done.stdout.splitlines()[-1])):
        assert "numpy" in modules
        assert {each.partition(".")[0] for each in modules} & HEAVY == set()
        assert {each.split(".")[1] for each in modules if each.startswith("gearcad.")} & FOREIGN == set()
    assert {"gear.step", "gear.stl", "gear.glb"} < {file.name for file in (tmp_path / "output" / "spur").iterdir()}
