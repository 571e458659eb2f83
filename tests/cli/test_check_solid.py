"""`gearcad check` of solid bodies as a user meets it: coarse bodies of three teeth, so that it takes seconds."""

import csv
import json
import math
import os
from dataclasses import replace
from functools import partial
from importlib import import_module
from pathlib import Path

import meshio
import numpy as np
import pytest
from support.commands import invoke, read_json, run
from support.pictures import leave_out_pictures
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

from gearcad import FlankModification, Gear, GearPair
from gearcad.contact.shared.line_of_action import loaded_left
from gearcad.core.records import NOT_ASKED_WORDS
from gearcad.jobs.strength import Check

HELICAL = """
[pair]
normal_module = 2.0
helix_angle = 20.0
face_width = 10.0
tooth_thinning = 0.05
modification.tip_relief = 12.0
modification.tip_relief_length = 1.0
modification.tip_relief_shape = "parabolic"
modification.lead_crowning = 3.0
[pinion]
teeth = 20
body.bore = 26.0
[wheel]
teeth = 30
body.bore = 48.0
[load]
torque = 80.0
[mounting]
misalignment = 6.0
[check]
positions = 12
torques = [40.0, 80.0]
body_teeth = 3
refinement = 0.7
"""

_LEVERS = 5e-4
"""Where the edge of a tip touches, its force has another lever arm than the base radius: all forces add up to a little more.
With their arms they add up to 1e-6, see `test_check_plots.py`.
"""

_NODAL = 0.06
"""A stress averaged at nodes against that at the points between them: 4 % on elements as coarse as these."""

_EXTREME = 0.002
"""What a search between the positions may miss of an extreme: no relief begins so that pressures flicker there."""

_BETWEEN = 0.03
"""What 12 positions miss of an extreme."""

_EDGES = ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7))
"""Corners between which nodes 8 to 19 of VTK's quadratic hexahedron lie."""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What the command leaves behind."""
    place, before = tmp_path_factory.mktemp("solid"), Path.cwd()
    os.chdir(place)
    try:
        Path("pair.toml").write_text(HELICAL, encoding="utf-8")
        with pytest.MonkeyPatch.context() as patch:
            leave_out_pictures(patch)
            result = invoke("check", "pair.toml", "--quiet")
    finally:
        os.chdir(before)
    # Elements twice as long as usual are honest about it: the estimate of their error is a gate.
    assert result.exit_code == 1, result.output
    assert f"pair at 80 N·m: numerics NOT passed; strength {NOT_ASKED_WORDS}\n" in result.stdout
    files = ("check.json", "report.html", "stress_pinion.vtu", "stress_wheel.vtu")
    assert result.stdout.splitlines()[-4:] == [f"output/pair/{file}" for file in files]
    assert tuple(sorted(path.name for path in (place / "output/pair").iterdir())) == files
    return place / "output/pair"


@pytest.fixture(scope="module")
def document(folder: Path) -> dict:
    return read_json(folder / "check.json")


@pytest.fixture(scope="module")
def pair() -> GearPair:
    pinion, wheel = (Gear(teeth=z, normal_module=2, face_width=10, helix_angle=beta) for z, beta in ((20, 20), (30, -20)))
    return GearPair(pinion=pinion, wheel=wheel)


@pytest.mark.long
def test_only_the_coarse_mesh_is_at_fault(document: dict) -> None:
    assert document["model"] == "3d"
    failed = [each["quantity"] for each in document["comparisons"] if each["role"] == "gate" and not each["passed"]]
    assert failed and all(quantity.startswith("discretisation error") for quantity in failed)
    for each in document["convergence"]:
        coarse, middle, fine = each["values"]
        assert each["factors"] == [0.794, 1.0, 1.26]
        # Each change is what an error of h^p loses from h to h/1.26; p where the changes show it, else 2 and the worse of both;
        # the range where they go back and forth.
        first, second = abs(coarse - middle), abs(middle - fine)
        if each["order"] is not None and each["order"] >= 1:
            assert first / second == pytest.approx(1.26 ** each["order"])
            expected = second / (1 - 1.26 ** -min(each["order"], 2.0))
        elif each["order"] is None:
            expected = max(each["values"]) - min(each["values"])
        else:
            expected = max(second / (1 - 1.26**-2), first / (1.26**2 - 1))
        assert each["error"] == pytest.approx(expected / fine)


def test_all_of_the_load_is_on_the_lines(document: dict, pair: GearPair) -> None:
    normal = 80e3 / (pair.pinion.base_diameter / 2) / math.cos(math.radians(pair.pinion.base_helix_angle))
    assert len(document["load_distribution"]) == document["positions"] == 12
    for lines, shares in zip(document["load_distribution"], document["mesh_cycle"]["load_share"], strict=True):
        forces = [np.dot(line["length"], line["line_load"]) for line in lines]
        assert sum(forces) == pytest.approx(normal, rel=_LEVERS)
        carried = {line["tooth"]: force / normal for line, force in zip(lines, forces, strict=True)}
        assert [carried.get(tooth, 0.0) for tooth in document["mesh_cycle"]["pairs"]] == pytest.approx(shares, rel=_LEVERS)
        for line in lines:
            assert len({len(values) for name, values in line.items() if name != "tooth"}) == 1
    assert np.mean(document["face"]["load"]) == pytest.approx(80e3 / (pair.pinion.base_diameter / 2) / 10, rel=_LEVERS)


def test_hubs_feel_the_torque(document: dict) -> None:
    found = {each["quantity"]: each for each in document["comparisons"] if "reaction" in each["quantity"]}
    for gear, applied in (("pinion", 80.0), ("wheel", 120.0)):
        each = found[f"torque reaction of the {gear}"]
        assert (each["reference"], each["tolerance"]) == (pytest.approx(applied, rel=_LEVERS), 0.005)
        assert each["passed"]


def test_summary_is_that_of_the_lists(document: dict) -> None:
    cycle, summary = document["mesh_cycle"], document["summary"]
    assert summary["mesh_stiffness_mean"] == pytest.approx(np.mean(cycle["mesh_stiffness"]), rel=_BETWEEN)
    swing = np.ptp(cycle["transmission_error"])
    assert swing <= summary["transmission_error_peak_to_peak"] < (1 + 10 * _BETWEEN) * swing
    turns = 2 * np.pi * np.arange(12) / 12
    for harmonic, amplitude in enumerate(summary["transmission_error_harmonics"], start=1):
        wave = np.exp(1j * harmonic * turns) @ cycle["transmission_error"]
        assert amplitude == pytest.approx(2 * abs(wave) / 12, abs=1e-9)
    for gear in ("pinion", "wheel"):
        along = document["face"][gear]
        most = max(cycle[f"root_stress_{gear}"])
        assert most <= summary[f"root_tension_{gear}"] == max(along["root_tension"]) < (1 + _BETWEEN) * most
        assert along["height"][int(np.argmax(along["root_tension"]))] == summary[f"root_tension_height_{gear}"]
    cells = [
        (line["pressure"][k], line["line_load"][k], line["across"][k])
        for lines in document["load_distribution"]
        for line in lines
        for k in range(len(line["across"]))
        if line["interior"][k]
    ]
    # Between the positions, and between the last cell inside and the first that an edge reaches, there can be more.
    most, _, across = max(cells)
    assert most <= summary["contact_pressure"] < (1 + 2 * _BETWEEN) * most
    assert summary["contact_pressure_across"] == pytest.approx(across, abs=1.0)
    most = max(load for _, load, _ in cells)
    assert most <= summary["line_load_max"] < (1 + 2 * _BETWEEN) * most
    for name in ("contact_pressure", "line_load_max", "root_tension_pinion", "root_tension_wheel"):
        found = document["extremes"][name]
        assert found["value"] == summary[name] and found["error"] < _EXTREME
        assert document["torque_sweep"][1].get(name, summary[name]) == pytest.approx(summary[name], rel=_EXTREME)


def test_misalignment_and_modifications_are_told(document: dict, folder: Path) -> None:
    (flank,) = [each for each in document["comparisons"] if each["quantity"] == "face load factor K_Hbeta"]
    stiffness, specific = document["rating"]["c_gamma_beta"], document["rating"]["w_t"]
    assert flank["reference"] == pytest.approx(1 + 6.0 * stiffness / (2 * specific))
    report = (folder / "report.html").read_text(encoding="utf-8")
    for shown in ("lead crowning", "tip relief, length of roll", "misalignment in the plane of action", "solid bodies"):
        assert shown in report


@pytest.mark.parametrize("gear", ["pinion", "wheel"])
def test_stress_fields_are_read_back(folder: Path, document: dict, gear: str) -> None:
    mesh = meshio.read(folder / f"stress_{gear}.vtu")
    (block,) = mesh.cells
    assert block.type == "hexahedron20"
    corners = mesh.points[block.data[:, :8]]
    for node, (first, second) in enumerate(_EDGES, start=8):
        between = mesh.points[block.data[:, node]] - (corners[:, first] + corners[:, second]) / 2
        edge = np.linalg.norm(corners[:, second] - corners[:, first], axis=1)
        assert (np.linalg.norm(between, axis=1) < 0.2 * edge).all()
    along, up, high = (corners[:, k] - corners[:, 0] for k in (1, 3, 4))
    assert (np.einsum("ij,ij->i", np.cross(along, up), high) > 0).all()
    summary = document["summary"]
    place = np.hypot(np.hypot(*mesh.points[:, :2].T) - summary[f"root_tension_radius_{gear}"], 0)
    near = (place < 0.3) & (np.abs(mesh.points[:, 2] - summary[f"root_tension_height_{gear}"]) < 1.0)
    stress = mesh.point_data["stress_MPa"][near]
    tensors = stress[:, [[0, 3, 5], [3, 1, 4], [5, 4, 2]]]
    assert np.linalg.eigvalsh(tensors)[:, 2].max() == pytest.approx(summary[f"root_tension_{gear}"], rel=_NODAL)
    xx, yy, zz, xy, yz, zx = stress.T
    mises = np.sqrt(xx**2 + yy**2 + zz**2 - xx * yy - yy * zz - zz * xx + 3 * (xy**2 + yz**2 + zx**2))
    assert mesh.point_data["von_mises_MPa"][near] == pytest.approx(mises)


@pytest.mark.parametrize("gear", ["pinion", "wheel"])
def test_stress_fields_open_with_the_colours_of_the_root(folder: Path, pair: GearPair, gear: str) -> None:
    """As VTK reads them, which is ParaView's reader; it gave the contact's 2590 MPa where the root has 777."""
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(folder / f"stress_{gear}.vtu"))
    reader.Update()
    data = reader.GetOutput().GetPointData()
    names = {data.GetArrayName(i) for i in range(data.GetNumberOfArrays())}
    assert names == {"von_mises_root_MPa", "von_mises_MPa", "stress_MPa", "displacement_mm"}
    assert data.GetScalars().GetName() == "von_mises_root_MPa"
    assert data.GetVectors().GetName() == "displacement_mm"
    shown, whole = (vtk_to_numpy(data.GetArray(name)) for name in ("von_mises_root_MPa", "von_mises_MPa"))
    most = shown.max()
    assert np.array_equal(shown, np.minimum(whole, most))
    assert whole.max() > 1.5 * most
    radius = np.hypot(*vtk_to_numpy(reader.GetOutput().GetPoints().GetData())[:, :2].T)
    assert radius[whole > most].min() > getattr(pair, gear).form_diameter / 2
    root = radius[np.isclose(1.1 * whole, most, rtol=1e-12)]
    assert root.size and (root < getattr(pair, gear).form_diameter / 2).all()


@pytest.mark.usefixtures("no_pictures")
def test_spur_gears_as_solids_carry_as_in_the_plane(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without modifications, loaded backwards, and without the finer mesh: the model is asked for on the command line."""
    monkeypatch.chdir(tmp_path)
    changed = HELICAL.replace("helix_angle = 20.0\n", "").replace("torque = 80.0", "torque = -80.0")
    plain = "\n".join(line for line in changed.splitlines() if not line.startswith(("modification", "misalignment")))
    Path("spur.toml").write_text(f"{plain}\nconvergence = 'off'\n", encoding="utf-8")
    solid = json.loads(invoke("check", "spur.toml", "--quiet", "--json", "--model", "3d").stdout)
    monkeypatch.setattr(import_module("gearcad.jobs.strength"), "Check", partial(Check, report=False))
    plane = json.loads(invoke("check", "spur.toml", "--quiet", "--json").stdout)
    assert (solid["model"], plane["model"]) == ("3d", "2d")
    assert solid["convergence"] == plane["convergence"] == []
    # Free ends make solid teeth a little softer than plane strain.
    ratio = solid["summary"]["mesh_stiffness_mean"] / plane["summary"]["mesh_stiffness_mean"]
    assert 0.92 < ratio < 1.0
    assert not Path("output").joinpath("spur", "stress_pinion.vtu").exists()  # the plane check came last


@pytest.mark.long
def test_helical_rows_of_a_table_are_checked(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    keys = {
        "name": "helical",
        "normal_module": 2,
        "helix_angle": 20,
        "pinion.teeth": 20,
        "wheel.teeth": 30,
        "pinion.face_width": 6,
        "wheel.face_width": 6,
        "load.torque": 30,
        "check.body_teeth": 3,
        "check.refinement": 0.7,
        "check.positions": 12,
        "check.torques": 30,
        "check.convergence": "off",
        "check.model": "3d",
    }
    with Path("table.csv").open("w", encoding="utf-8", newline="") as file:
        csv.writer(file).writerows([keys.keys(), keys.values()])
    run("batch", "table.csv", "--do", "check", "--quiet", "-j", "1")
    with Path("output/table/results.csv").open(encoding="utf-8") as file:
        (row,) = csv.DictReader(file)
    assert row["check.passed"].lower() == "true"
    assert float(row["check.face_load_factor"]) >= 1
    assert len(row["check.transmission_error_harmonics"].split()) == 5


@pytest.mark.parametrize("helix", [0.0, 20.0])
def test_backwards_the_mirror_image_carries(helix: float) -> None:
    """The left flanks of the image are the right ones of the pair, at the same radii and heights."""
    changes = FlankModification(helix_angle_modification=9, twist=5, lead_crowning=2, pressure_angle_modification=3)
    pinion, wheel = (
        Gear(teeth=z, normal_module=2, face_width=10, helix_angle=beta, modification=changes)
        for z, beta in ((20, helix), (30, -helix))
    )
    pair = GearPair(pinion=pinion, wheel=wheel)
    assert loaded_left(pair, 5.0) == pair
    image = loaded_left(pair, -5.0)
    assert image.centre_distance == pair.centre_distance
    lengths, heights = np.linspace(3, 9, 5)[:, None], np.linspace(0, 10, 7)
    for gear, mirrored in ((pair.pinion, image.pinion), (pair.wheel, image.wheel)):
        assert mirrored.helix_angle == -gear.helix_angle
        right = gear.flank_form.depth(lengths, heights, left=False)
        assert mirrored.flank_form.depth(lengths, heights) == pytest.approx(right, abs=1e-12)
        assert replace(mirrored, helix_angle=gear.helix_angle).tip_diameter == gear.tip_diameter
