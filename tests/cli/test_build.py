"""`gearcad build` of gears, pairs and planetary trains: which files appear, whole or not at all; what is refused."""

import json
import re
import subprocess
import sys
from collections.abc import Callable
from importlib import import_module
from inspect import getmembers, isfunction, signature
from pathlib import Path
from pkgutil import iter_modules
from typing import Any

import pytest
from click.testing import Result
from support.commands import invoke, run
from support.specs import FACETED_OR_FLAT, TEMPLATES, WITHOUT_ASSEMBLY

from gearcad import GeometryError, ParameterError, SolverError
from gearcad.designs import read_spec
from gearcad.designs.design import Design
from gearcad.jobs.build import Build, build
from gearcad.solids import FileOptions, Format, files
from gearcad.solids.files import products

PAIR = ["pinion", "wheel"]


@pytest.fixture
def pair() -> Design:
    return read_spec(TEMPLATES / "volvo-13-44.toml")


@pytest.fixture
def gear() -> Design:
    return read_spec(TEMPLATES / "spur.toml")


@pytest.fixture
def stand_ins(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Solids that cost nothing: every writer leaves its name in its file, and every call its name in the list."""
    calls: list[str] = []

    def writer(name: str, path_at: int) -> Callable[..., None]:
        def write(*arguments: Any, **_options: Any) -> None:
            calls.append(name)
            arguments[path_at].write_text(name)

        return write

    def maker(name: str) -> Callable[..., str]:
        def make(*_arguments: Any, **options: Any) -> str:
            calls.append(f"{name} {options}" if options else name)
            return name

        return make

    for module in (import_module(f"{files.__name__}.{each.name}") for each in iter_modules(files.__path__)):
        for name, function in getmembers(module, isfunction):
            if name.startswith("write_") and function.__module__ == module.__name__:
                monkeypatch.setattr(module, name, writer(name, list(signature(function).parameters).index("path")))
    for name in ("gear_boundary", "pair_product", "tessellate"):
        monkeypatch.setattr(products, name, maker(name))
    return calls


def names(folder: Path) -> set[str]:
    return {path.name for path in folder.iterdir()}


@pytest.mark.parametrize("kind", Format)
def test_single_gear_gives_one_file_per_format(kind: Format, gear: Design, stand_ins: list[str], tmp_path: Path) -> None:
    files = build(gear, tmp_path / "out", [kind])
    assert files == [tmp_path / "out" / "data.json", tmp_path / "out" / f"gear.{kind.value}"]
    assert names(tmp_path / "out") == {"data.json", f"gear.{kind.value}"}


@pytest.mark.parametrize("kind", Format)
def test_pair_gives_both_gears_and_the_assembly_where_the_format_has_one(
    kind: Format, pair: Design, stand_ins: list[str], tmp_path: Path
) -> None:
    build(pair, tmp_path / "out", [kind])
    parts = PAIR if kind in WITHOUT_ASSEMBLY else [*PAIR, "assembly"]
    assert names(tmp_path / "out") == {"data.json", *(f"{part}.{kind.value}" for part in parts)}


def test_facets_of_a_gear_are_made_once_for_all_formats(pair: Design, stand_ins: list[str], tmp_path: Path) -> None:
    build(pair, tmp_path, [Format.STL, Format.THREE_MF, Format.GLB])
    assert stand_ins.count("tessellate") == 2


def test_bracket_reaches_the_assembly(pair: Design, stand_ins: list[str], tmp_path: Path) -> None:
    build(pair, tmp_path, [Format.STEP], bracket=True)
    assert "pair_product {'bracket': True}" in stand_ins


def test_progress_counts_up_to_the_last_file(pair: Design, stand_ins: list[str], tmp_path: Path) -> None:
    seen: list[tuple[str, int, int]] = []
    files = build(pair, tmp_path, progress=lambda *step: seen.append(step))
    assert [(file, done) for file, done, _ in seen] == [(file.name, number) for number, file in enumerate(files)]
    assert {total for *_, total in seen} == {len(files)}


@pytest.mark.parametrize("error", [SolverError("no"), RuntimeError("no"), KeyboardInterrupt(), MemoryError()])
def test_failure_at_the_last_file_leaves_no_file_at_all(
    error: BaseException, pair: Design, stand_ins: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fail(*_arguments: Any, **_options: Any) -> None:
        raise error

    monkeypatch.setattr(products, "pair_product", fail)
    with pytest.raises(type(error)):
        build(pair, tmp_path / "output" / "x")
    assert list(tmp_path.iterdir()) == []


def test_data_json_is_what_the_data_command_prints(pair: Design, stand_ins: list[str], tmp_path: Path) -> None:
    build(pair, tmp_path, [Format.DXF])
    printed = invoke("data", str(TEMPLATES / "volvo-13-44.toml"), "--json").stdout
    assert (tmp_path / "data.json").read_text() == printed


def test_command_reports_files_on_stdout_and_the_rest_on_stderr(
    stand_ins: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    spec = str(TEMPLATES / "volvo-13-44.toml")
    plain = invoke("build", spec, "--format", " DXF , stl,dxf")
    files = [f"output/volvo-13-44/{name}" for name in ("data.json", "pinion.dxf", "wheel.dxf", "pinion.stl", "wheel.stl")]
    assert (plain.exit_code, plain.stdout.splitlines()) == (0, files)
    assert all(Path(file).is_file() for file in files)
    assert plain.stderr.startswith("[1/5] data.json\n[2/5] pinion.dxf\n")
    assert "Warning: pair: fillet interference" in plain.stderr

    quiet = invoke("build", spec, "--quiet", "--json", "-o", "elsewhere", "--format", "csv")
    assert (quiet.exit_code, quiet.stderr) == (0, "")
    document = json.loads(quiet.stdout)
    assert document["files"] == [f"elsewhere/{name}" for name in ("data.json", "pinion.csv", "wheel.csv")]
    assert (document["kind"], document["name"], document["output"]) == ("build", "volvo-13-44", "elsewhere")
    assert any("fillet interference" in warning for warning in document["warnings"])


def test_kernel_failure_is_status_1(stand_ins: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_arguments: Any, **_options: Any) -> None:
        raise SolverError("the CAD kernel could not write it")

    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(products, "gear_boundary", fail)
    result = invoke("build", str(TEMPLATES / "spur.toml"), "--quiet")
    assert (result.exit_code, result.stderr) == (1, "Error: the CAD kernel could not write it\n")
    assert list(tmp_path.iterdir()) == []


def test_solids_and_facets_need_no_heavy_library(tmp_path: Path) -> None:
    """Every word of a STEP file and every triangle is ours."""
    heavy = ["cadquery", "OCP", "trimesh", "ezdxf", "vtkmodules", "scipy", "matplotlib", "gmsh", "skfem"]
    command = ["build", str(TEMPLATES / "spur.toml"), "-o", str(tmp_path / "out"), "--format", "step,stl", "--quiet"]
    code = f"""
import sys
from gearcad.cli import main
main({command!r}, standalone_mode=False)
print([name for name in {heavy} if name in sys.modules], file=sys.stderr)
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.stderr == "[]\n"
    assert names(tmp_path / "out") == {"data.json", "gear.step", "gear.stl"}


# ---------------------------------------------------------------------- the real thing


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("built")
    build(read_spec(TEMPLATES / "volvo-13-44.toml"), folder, Format, chord_error=0.02)
    return folder


def test_every_file_of_the_reference_pair_is_there(built: Path) -> None:
    assemblies = {f"assembly.{kind.value}" for kind in Format if kind not in WITHOUT_ASSEMBLY}
    assert names(built) == {"data.json", *assemblies, *(f"{part}.{kind.value}" for part in PAIR for kind in Format)}


def test_equal_input_gives_equal_bytes(built: Path, tmp_path: Path) -> None:
    build(read_spec(TEMPLATES / "volvo-13-44.toml"), tmp_path, Format, chord_error=0.02)
    assert [name for name in sorted(names(built)) if (built / name).read_bytes() != (tmp_path / name).read_bytes()] == []


def test_step_assembly_opens_in_cadquery_as_two_gears_at_the_centre_distance(built: Path) -> None:
    import cadquery

    found = cadquery.importers.importStep(str(built / "assembly.step")).solids().vals()
    assert len(found) == 2
    pinion, wheel = sorted(found, key=lambda solid: solid.Volume())
    alone = [cadquery.importers.importStep(str(built / f"{part}.step")).val() for part in PAIR]
    assert [pinion.Volume(), wheel.Volume()] == pytest.approx([part.Volume() for part in alone], rel=1e-9)
    # The centre of mass of a gear with teeth all round lies on its axis; the tolerance is that of OCC's integration.
    assert wheel.Center().x - pinion.Center().x == pytest.approx(80.0, abs=1e-4)


def test_meshes_open_in_trimesh_closed_and_of_the_solids_volume(built: Path) -> None:
    import cadquery
    import trimesh

    for part in PAIR:
        mesh = trimesh.load_mesh(built / f"{part}.stl")
        assert mesh.is_watertight
        solid = cadquery.importers.importStep(str(built / f"{part}.step")).val()
        # A chord error e on the whole surface changes the volume by less than area times e.
        assert abs(mesh.volume - solid.Volume()) < 0.02 * solid.Area()
    for suffix in ("3mf", "glb"):
        scene = trimesh.load_scene(built / f"assembly.{suffix}")
        assert set(scene.geometry) == {f"volvo-13-44 {part}" for part in PAIR}


def test_parts_are_the_same_products_alone_and_in_the_assembly(built: Path) -> None:
    products = {part: f"volvo-13-44 {part}" for part in PAIR}
    for part, product in products.items():
        assert _products(built / f"{part}.step") == {product}
    assert _products(built / "assembly.step") == {"volvo-13-44", *products.values()}


def _products(path: Path) -> set[str]:
    return set(re.findall(r"=PRODUCT\('([^']*)'", path.read_text("ascii")))


def test_contours_open_in_ezdxf(built: Path) -> None:
    import ezdxf

    for part in PAIR:
        document = ezdxf.readfile(built / f"{part}.dxf")
        assert not document.audit().has_errors
        assert len(document.modelspace()) > 0


def test_bracket_without_bores_is_refused_and_leaves_nothing(pair: Design, tmp_path: Path) -> None:
    spec = tmp_path / "bare.toml"
    spec.write_text((TEMPLATES / "volvo-13-44.toml").read_text().replace("body.bore = 16.0", ""))
    with pytest.raises(GeometryError, match=r"pinion\.body\.bore = 0 mm: must be above 0 mm"):
        build(read_spec(spec), tmp_path / "out", [Format.STEP], bracket=True)
    assert names(tmp_path) == {"bare.toml"}


RING = """[gear]
name = "annulus"
teeth = -60
normal_module = 2.0
face_width = 12.0
helix_angle = 15.0
cutter.teeth = 22
cutter.tip_radius = 0.2
body.end_chamfer = 0.8
"""


def test_a_ring_is_built_in_every_faceted_and_flat_format(tmp_path: Path) -> None:
    spec, target = tmp_path / "ring.toml", tmp_path / "files"
    spec.write_text(f"{RING}body.rim_diameter = 150.0\n")
    run("build", str(spec), "-o", str(target), "--format", ",".join(FACETED_OR_FLAT), "--circles")
    assert names(target) == {"data.json", *(f"gear.{suffix}" for suffix in FACETED_OR_FLAT)}


def test_a_ring_without_a_rim_is_drawn_but_has_no_body(tmp_path: Path) -> None:
    spec = tmp_path / "ring.toml"
    spec.write_text(RING)
    run("build", str(spec), "-o", str(tmp_path / "flat"), "--format", "dxf,csv")
    for kind in ("stl", "step"):
        result = invoke("build", str(spec), "-o", str(tmp_path / kind), "--format", kind)
        assert result.exit_code != 0
        (line,) = (line for line in result.output.splitlines() if line.startswith("Error"))
        assert "gear.body.rim_diameter is missing: must be given, at least 129.634 mm" in line
        assert ".step" not in result.output and ".stl" not in result.output
        assert not (tmp_path / kind).exists()


@pytest.mark.parametrize(("starter", "words"), [("volvo-13-44", "tip diameter of 127.656"), ("rack", "rack of")])
def test_a_chord_error_that_one_part_cannot_have_is_refused_before_any_is_made(
    monkeypatch: pytest.MonkeyPatch, starter: str, words: str
) -> None:
    """The pinion's facets took 10 s of CPU time before the wheel was refused."""
    monkeypatch.setattr(Build, "write", None)
    design = read_spec(TEMPLATES / f"{starter}.toml")
    with pytest.raises(ParameterError, match=rf"chord_error = 1e-05 mm: must be at least .* for a {words}"):
        build(design, "out", ["stl"], chord_error=1e-5)
    assert Build(formats=["step"], options=FileOptions(chord_error=1e-5)).run(design) is design


ALM = TEMPLATES / "planetary-alm.toml"


def train_build(*arguments: object, status: int = 0) -> Result:
    result = run("build", *map(str, arguments), "--quiet", status=status)
    return result


def test_every_gear_has_files_of_its_own_and_the_train_an_assembly(tmp_path: Path) -> None:
    train_build(ALM, "--format", "dxf,csv", "--circles", "-o", tmp_path / "out")
    gears = list(read_spec(ALM).gears)
    assert len(gears) == 6
    files = {"data.json", "assembly.dxf", *(f"{gear}.{suffix}" for gear in gears for suffix in ("dxf", "csv"))}
    assert {file.name for file in (tmp_path / "out").iterdir()} == files


def test_a_carrier_has_files_of_its_own_in_the_formats_of_bodies() -> None:
    job = Build(formats=("step", "stl", "dxf", "csv"), options=FileOptions(carrier=True))
    files = job.files(job.run(read_spec(ALM)))
    assert [file for file in files if file.startswith("carrier.")] == ["carrier.stl", "carrier.step"]
    assert not any(file.startswith("carrier.") for file in Build(formats=("step",)).files(read_spec(ALM)))


PLAIN = """
[planetary]
planets = 3
input = "sun"
output = "carrier"
fixed = "ring"
normal_module = 2.0
face_width = 20.0

[sun]
teeth = 24

[planet]
teeth = 21

[ring]
teeth = -66
"""


@pytest.mark.parametrize(
    ("spec", "arguments", "message"),
    [
        ("plain", ["--format", "step"], "ring.body.rim_diameter is missing: must be given, at least 137.4 mm: a solid of"),
        ("alm", ["--format", "dxf", "--exploded"], "exploded = True: needs the format step or 3mf or glb or png"),
        ("alm", ["--format", "step", "--turning"], "turning = True: needs the format glb: it is an animation of assembly.glb"),
        ("alm", ["--bracket"], "bracket = True: needs a pair of gears: a planetary train has a carrier"),
        ("pair", ["--carrier"], "carrier = True: needs a planetary train"),
        ("pair", ["--format", "glb", "--turning"], "turning = True: needs a planetary train"),
    ],
)
def test_what_cannot_be_built_is_one_line_and_leaves_nothing(
    spec: str, arguments: list[str], message: str, tmp_path: Path
) -> None:
    (tmp_path / "plain.toml").write_text(PLAIN)
    path = {"plain": tmp_path / "plain.toml", "alm": ALM, "pair": TEMPLATES / "volvo-13-44.toml"}[spec]
    result = train_build(path, *arguments, "-o", tmp_path / "out", status=2)
    assert result.stderr.startswith(f"Error: {message}") and result.stderr.count("\n") == 1
    assert not (tmp_path / "out").exists()


def test_a_row_has_the_options_that_its_kind_has_use_for() -> None:
    options = FileOptions(bracket=True, carrier=True, exploded=True, turning=True)
    job = Build(formats=("step", "glb"), options=options)
    of_pair = job.for_row(read_spec(TEMPLATES / "volvo-13-44.toml"), ["step", "glb"])
    of_train = job.for_row(read_spec(ALM), ["step", "glb"])
    of_step = job.for_row(read_spec(ALM), ["step"])
    assert of_pair.options == FileOptions(bracket=True)  # type: ignore[attr-defined]
    assert of_train.options == FileOptions(carrier=True, exploded=True, turning=True)  # type: ignore[attr-defined]
    assert of_step.options == FileOptions(carrier=True, exploded=True)  # type: ignore[attr-defined]
