"""What `import gearcad` and each command load; system libraries, examples in docstrings, and the version."""

import ast
import doctest
import importlib
import json
import pkgutil
import re
import subprocess
import sys
import tomllib
from pathlib import Path
from types import ModuleType

import pytest
from support.specs import TEMPLATES

import gearcad

HEAVY = (
    *("scipy", "cadquery", "OCP", "gmsh", "matplotlib", "vtk", "vtkmodules"),
    *("trimesh", "ezdxf", "rich", "skfem", "meshio", "numba"),
)


def test_import_pulls_in_no_heavy_library() -> None:
    code = "import sys, gearcad; print('numpy' in sys.modules, gearcad.Gear.__name__, gearcad.geometry.__name__); "
    code += f"print(*[name for name in {HEAVY!r} if name in sys.modules], 'numpy' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == ["False", "Gear", "gearcad.geometry", "True"]
    assert done.stderr == ""


def test_every_name_is_there_and_no_other() -> None:
    assert [name for name in gearcad.__all__ if getattr(gearcad, name, None) is None] == []
    assert set(gearcad.__all__) <= set(dir(gearcad))
    with pytest.raises(AttributeError, match=r"gearcad.* attribute '?Gaer"):
        gearcad.Gaer  # noqa: B018


def test_type_checkers_are_told_the_same_names() -> None:
    stub = ast.parse(Path(gearcad.__file__).with_suffix(".pyi").read_text(encoding="utf-8"))
    names = {each.asname for node in stub.body if isinstance(node, ast.ImportFrom) for each in node.names} - {None}
    names |= {node.name for node in stub.body if isinstance(node, ast.FunctionDef)}
    rooms = {name for name in names if isinstance(getattr(gearcad, name), ModuleType)}
    assert names - rooms | {"check", "dynamics", "identify", "planetary", "shafts", "stiffness"} == set(gearcad.__all__)
    assert set(dir(gearcad)) - set(gearcad.__all__) <= names | {name for name in dir(gearcad) if name.startswith("__")}


def _modules_of_texts(tree: ast.AST) -> set[str]:
    """The modules of gearcad that a file imports by a text, `import_module("gearcad.plots")`, up to its first variable part."""
    calls = [node for node in ast.walk(tree) if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "import_module"]
    texts = [call.args[0].values[0] if isinstance(call.args[0], ast.JoinedStr) else call.args[0] for call in calls]
    return {text.value for text in texts if isinstance(text, ast.Constant) and str(text.value).startswith("gearcad")}


def test_imports_by_a_text_point_down_too() -> None:
    """`lint-imports` does not see them."""
    project = Path(gearcad.__file__).parents[1]
    with (project / "pyproject.toml").open("rb") as file:
        contracts = tomllib.load(file)["tool"]["importlinter"]["contracts"]
    layers = next(each["layers"] for each in contracts if each["type"] == "layers")
    floors = {room.strip(): -floor for floor, layer in enumerate(layers) for room in layer.split("|")}
    up, seen = [], 0
    for path in sorted(Path(gearcad.__file__).parent.rglob("*.py")):
        own = ".".join(path.relative_to(project).with_suffix("").parts[:2])
        for module in _modules_of_texts(ast.parse(path.read_text(encoding="utf-8"))):
            room = ".".join(module.rstrip(".").split(".")[:2])
            seen += 1
            up += [(own, module)] if room in floors and floors[room] > floors[own] else []
    assert (up, seen > 2) == ([], True)


MUTABLE = {"Run", "_Source", "_Keeper", "_Trial", "Elimination", "_Rings"}
"""A run of the page, the file that is open there, and states of loops inside one function."""


def test_dataclasses_are_frozen() -> None:
    """Inputs and results are values: nothing changes one that another has been handed."""
    found = set()
    for path in Path(gearcad.__file__).parent.rglob("*.py"):
        found |= set(
            re.findall(r"@dataclass(?![^\n]*frozen=True)[^\n]*\n(?:@[^\n]*\n)*class (\w+)", path.read_text(encoding="utf-8"))
        )
    assert found == MUTABLE


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

COMMAND_HEAVY = {
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
        assert {each.partition(".")[0] for each in modules} & COMMAND_HEAVY == set()
        assert {each.split(".")[1] for each in modules if each.startswith("gearcad.")} & FOREIGN == set()
    assert {"gear.step", "gear.stl", "gear.glb"} < {file.name for file in (tmp_path / "output" / "spur").iterdir()}


@pytest.mark.parametrize("library", ["cadquery", "ezdxf", "jinja2", "lxml", "matplotlib", "meshio", "skfem", "trimesh", "vtk"])
def test_library_loads(library: str) -> None:
    importlib.import_module(library)


def test_gmsh_meshes() -> None:
    """gmsh loads OpenGL, X and OpenMP libraries of the system, which a bare machine lacks."""
    import gmsh

    gmsh.initialize(interruptible=False)
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.occ.addDisk(0, 0, 0, 1, 1)
        gmsh.model.occ.synchronize()
        gmsh.model.mesh.generate(2)
        assert len(gmsh.model.mesh.getElementsByType(2)[0]) > 10
    finally:
        gmsh.finalize()


PACKAGE = Path(gearcad.__file__).parent
ROOMS = [
    ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts).removesuffix(".__init__")
    for path in sorted(PACKAGE.rglob("*.py"))
    if re.search(rb"^ *>>> ", path.read_bytes(), re.MULTILINE)
]


@pytest.mark.parametrize("room", ROOMS)
def test_examples_give_what_they_show(room: str) -> None:
    module = importlib.import_module(room)
    # Names and modules that are imported at their first use, which is not to be while their examples are sought.
    for name in dir(module):
        getattr(module, name, None)
    for each in pkgutil.iter_modules(getattr(module, "__path__", ())):
        if each.name != "__main__":
            importlib.import_module(f"{room}.{each.name}")
    found = doctest.testmod(module)
    assert found.attempted and not found.failed


ROOT = Path(__file__).parents[2]
FALLBACK = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["hatch"]["version"]["fallback-version"]


def test_a_checkout_that_was_never_installed_has_the_version_of_a_build_without_a_tag(tmp_path: Path) -> None:
    (tmp_path / "gearcad").mkdir()
    (tmp_path / "gearcad" / "__init__.py").touch()
    (tmp_path / "gearcad" / "version.py").write_bytes((ROOT / "gearcad" / "version.py").read_bytes())
    shown = [sys.executable, "-c", "from gearcad.version import __version__; print(__version__)"]
    done = subprocess.run(shown, cwd=tmp_path, env={"PYTHONPATH": str(tmp_path)}, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == FALLBACK


def test_the_version_is_that_which_was_written() -> None:
    written = ROOT / "gearcad" / "_version.py"
    names: dict[str, str] = {}
    exec(written.read_text() if written.exists() else f'__version__ = "{FALLBACK}"', names)
    assert gearcad.__version__ == names["__version__"]


def test_a_release_stands_in_the_changelog_and_is_what_is_cited() -> None:
    """A version without "dev" is that of a tag; before the first release the one to come is cited."""
    changes = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    released = re.findall(r"^## \[(\d+\.\d+\.\d+)\] - \d{4}-\d\d-\d\d$", changes, re.MULTILINE)
    (cited,) = re.findall(r"^version: (\S+)$", (ROOT / "CITATION.cff").read_text(encoding="utf-8"), re.MULTILINE)
    assert cited == (released[0] if released else FALLBACK.partition(".dev")[0])
    assert "dev" in gearcad.__version__ or released[:1] == [gearcad.__version__]
