"""Files that anyone can read anywhere: names in every script, equal bytes; STL and GLB beside trimesh's own."""

import hashlib
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from pathlib import Path

import cadquery
import ezdxf
import numpy as np
import pytest
import trimesh
from OCP.Interface import Interface_Static
from OCP.STEPCAFControl import STEPCAFControl_Controller
from support.samples import SAMPLES
from support.step_witness import checked_text, product_tree
from trimesh.exchange.gltf import export_glb

from gearcad import Body, Gear, GearPair, Rack, __version__
from gearcad.core.errors import ParameterError
from gearcad.solids import (
    ScenePart,
    gear_solid,
    pair_assembly,
    rack_solid,
    tessellate,
    write_dxf,
    write_glb,
    write_points,
    write_scene,
    write_step,
    write_stl,
)
from gearcad.solids.facets.tessellation import Facets

SMALL = Rack(teeth=2, normal_module=1, face_width=2, height=4)
GEAR = Gear(teeth=12, normal_module=2, face_width=6, helix_angle=15, body=Body(bore=8))
MATE = Gear(teeth=17, normal_module=2, face_width=5, helix_angle=-15, body=Body(bore=8))

WRITE_ALL = """
import sys
sys.path[:0] = sys.argv[2:]
from test_files import write_all
write_all(sys.argv[1])
"""


def write_all(folder: str) -> None:
    """Every format, by plain text paths."""
    facets = tessellate(GEAR, 0.01)
    write_step(gear_solid(GEAR), f"{folder}/gear.step", name="gear")
    write_step(pair_assembly(GearPair(pinion=GEAR, wheel=MATE)), f"{folder}/pair.step", name="pair")
    write_stl(facets, f"{folder}/gear.stl")
    write_dxf(GEAR, f"{folder}/gear.dxf")
    write_points(GEAR, f"{folder}/gear.csv")
    for suffix in ("3mf", "glb"):
        write_scene([ScenePart(name="gear", facets=facets)], f"{folder}/gear.{suffix}")


@pytest.mark.long
def test_equal_bytes_from_processes_that_hash_differently(tmp_path: Path) -> None:
    made = []
    for seed in ("1", "here"):
        folder = tmp_path / seed
        folder.mkdir()
        if seed == "here":
            write_all(str(folder))
        else:
            command = [sys.executable, "-c", WRITE_ALL, str(folder), *map(str, Path(__file__).parents[:2])]
            subprocess.run(command, check=True, env={**os.environ, "PYTHONHASHSEED": seed})
        made.append({path.name: hashlib.sha256(path.read_bytes()).hexdigest() for path in folder.iterdir()})
    assert len(made[0]) == 7
    assert made[0] == made[1]


# How names stand in the file by ISO 10303-21, with | for the backslash.
HOSTILE = {
    "Zähne 歯": "Z|X2|00E4|X0|hne |X2|6B6F|X0|",
    "O'Brien \\ Söhne": "O|X|27Brien || S|X2|00F6|X0|hne",
    r"\X2\0041\X0\ \S\a \X\41 \P\ \N\ ": "||X2||0041||X0|| ||S||a ||X||41 ||P|| ||N|| ",
    "';#1=X(';/*": "|X|27;#1=X(|X|27;/*",
    "'gearcad-name-0'": "|X|27gearcad-name-0|X|27",
    "a😀\ue000b": "a|X4|0001F600|X0||X2|E000|X0|b",
    "q'" * 50: "q|X|27" * 50,
    "歯" * 100: "|X2|" + "6B6F" * 100 + "|X0|",
    "歯a\\" * 33: "|X2|6B6F|X0|a||" * 33,
}


@pytest.mark.parametrize("name", HOSTILE)
def test_any_name_reads_back(tmp_path: Path, name: str) -> None:
    path = tmp_path / "named.step"
    write_step(rack_solid(SMALL), path, name=name)
    stands = HOSTILE[name].replace("|", "\\")
    text = path.read_text("ascii")
    assert f"=PRODUCT('{stands}','{stands}','',(" in text
    assert checked_text(text).kinds["PRODUCT"] == 1
    assert _product_names(path) == [name]


def test_names_of_an_assembly_read_back(tmp_path: Path) -> None:
    names = [f"{name} wheel" for name in HOSTILE]  # the kernel's reader takes no name of a place that is not ASCII at all
    inner = cadquery.Assembly(name=names[1])
    for name in names[2:]:
        inner.add(rack_solid(SMALL), name=name)
    outer = cadquery.Assembly(name=names[0]).add(inner)
    path = tmp_path / "named.step"
    write_step(outer, path, name=outer.name)
    assert sorted(_product_names(path)) == sorted(names)
    again = cadquery.Assembly.importStep(str(path))
    assert [child.name for child in again.children[0].children] == names[2:]


def test_header_says_which_gearcad_and_names_nobody(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("SOURCE_DATE_EPOCH", raising=False)
    head = _header(tmp_path)
    assert head[:2] == ["FILE_DESCRIPTION(('O\\X\\27Brien'),'2;1')", _file_name("2000-01-01T00:00:00")]
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    assert _header(tmp_path)[1] == _file_name("2023-11-14T22:13:20")
    for wrong in ("yesterday", "-1", "1e9", "9" * 400, "253402300800"):
        monkeypatch.setenv("SOURCE_DATE_EPOCH", wrong)
        with pytest.raises(ParameterError, match=r"SOURCE_DATE_EPOCH = .*must be a whole number of seconds since 1970"):
            _header(tmp_path)


def _header(folder: Path) -> list[str]:
    path = folder / "header.step"
    write_step(rack_solid(SMALL), path, name="O'Brien")
    assert _product_names(path) == ["O'Brien"]
    return path.read_text("ascii").split("HEADER;\n")[1].split(";\n")


def _file_name(stamp: str) -> str:
    return f"FILE_NAME('O\\X\\27Brien','{stamp}',(''),(''),'gearcad {__version__}','gearcad {__version__}','')"


def _product_names(path: Path) -> list[str]:
    """Names of the products in a STEP file, read by the kernel."""
    found, nodes = list[str](), [*product_tree(path)]
    while nodes:
        node = nodes.pop()
        nodes += node.children
        found.append(node.product)
    return found


def test_global_settings_stay_as_they_were(tmp_path: Path) -> None:
    STEPCAFControl_Controller.Init_s()  # the settings exist from now on
    Interface_Static.SetIVal_s("write.surfacecurve.mode", 1)
    Interface_Static.SetCVal_s("write.step.schema", "AP203")
    with ThreadPoolExecutor(8) as pool:
        list(pool.map(lambda i: write_dxf(GEAR, tmp_path / f"{i}.dxf"), range(24)))
        list(pool.map(lambda i: write_step(gear_solid(GEAR), tmp_path / f"{i}.step", name="gear"), range(6)))
    assert Interface_Static.IVal_s("write.surfacecurve.mode") == 1
    assert Interface_Static.CVal_s("write.step.schema") == "AP203"
    assert ezdxf.options.write_fixed_meta_data_for_testing is False
    assert len({(tmp_path / f"{i}.step").read_bytes() for i in range(6)}) == 1
    assert len({(tmp_path / f"{i}.dxf").read_bytes() for i in range(24)}) == 1


RING = replace(SAMPLES["spur"], teeth=-40, tip_alteration=-0.1, body=Body(rim_diameter=95.0))
FACETS = {name: tessellate(SAMPLES[name], 0.02) for name in ("spur", "helical", "tiny", "sharp tool")} | {
    "ring": tessellate(RING, 0.02),
    "a needle without area": Facets(
        np.array([[0.0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 3, 0], [0, 0, 1e-15]]), np.array([[0, 1, 2], [0, 1, 3], [0, 1, 4]])
    ),
}


@pytest.mark.parametrize("name", FACETS)
def test_stl_is_byte_for_byte_that_of_trimesh(name: str, tmp_path: Path) -> None:
    facets = FACETS[name]
    write_stl(facets, tmp_path / "gear.stl")
    theirs = trimesh.Trimesh(facets.vertices, facets.faces, process=False, validate=False).export(file_type="stl")
    assert (tmp_path / "gear.stl").read_bytes() == theirs


def test_glb_is_read_as_that_of_trimesh(tmp_path: Path) -> None:
    """Names, places, meshes and colours of a scene that both have written."""
    blue, red = (0.2, 0.3, 0.8), (0.9, 0.02, 0.1)
    parts = [
        ScenePart(name="pinion", facets=FACETS["helical"], colour=blue),
        *(ScenePart(name=f"planet_{n}", facets=FACETS["spur"], colour=red, rotation=n, offset=(n, 2, 1)) for n in (40, 50)),
    ]
    write_glb(parts, tmp_path / "ours.glb")
    scene = trimesh.Scene()
    root = np.array([[1e-3, 0, 0, 0], [0, 0, 1e-3, 0], [0, -1e-3, 0, 0], [0, 0, 0, 1]])
    scene.graph.update(frame_to="gearcad", frame_from=scene.graph.base_frame, matrix=root)
    for part in parts:
        mesh = trimesh.Trimesh(part.facets.vertices, part.facets.faces, process=False, validate=False)
        light = [((each + 0.055) / 1.055) ** 2.4 if each > 0.04045 else each / 12.92 for each in part.colour]
        material = trimesh.visual.material.PBRMaterial(
            part.name, baseColorFactor=light, metallicFactor=0.6, roughnessFactor=0.45
        )
        mesh.visual = trimesh.visual.TextureVisuals(material=material)
        scene.add_geometry(mesh, part.name, part.name, parent_node_name="gearcad", transform=part.pose)
    (tmp_path / "theirs.glb").write_bytes(export_glb(scene, include_normals=False))
    ours, theirs = (trimesh.load_scene(tmp_path / f"{each}.glb") for each in ("ours", "theirs"))
    assert set(ours.graph.nodes_geometry) == set(theirs.graph.nodes_geometry) == {part.name for part in parts}
    for part in parts:
        (place, made), (their_place, their_made) = ours.graph[part.name], theirs.graph[part.name]
        np.testing.assert_allclose(place, their_place, atol=1e-15)
        mesh, their_mesh = ours.geometry[made], theirs.geometry[their_made]
        np.testing.assert_array_equal(mesh.vertices, their_mesh.vertices)
        np.testing.assert_array_equal(mesh.faces, their_mesh.faces)
        looks, their_looks = mesh.visual.material, their_mesh.visual.material
        np.testing.assert_array_equal(looks.baseColorFactor, their_looks.baseColorFactor)
        assert (looks.metallicFactor, looks.roughnessFactor) == (their_looks.metallicFactor, their_looks.roughnessFactor)
    assert len(ours.geometry) == 2  # both planets show one mesh


def test_another_reader_finds_every_triangle_of_a_glb(tmp_path: Path) -> None:
    """VTK's: as many bodies with as many triangles, of the same size in metres with y up."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOGeometry import vtkGLTFReader

    facets = FACETS["helical"]
    write_glb([ScenePart(name="gear", facets=facets, offset=(80.0, 0.0, 5.0))], tmp_path / "gear.glb")
    reader = vtkGLTFReader()
    reader.SetFileName(str(tmp_path / "gear.glb"))
    reader.Update()
    pieces = reader.GetOutput().NewIterator()
    found = pieces.GetCurrentDataObject()
    pieces.GoToNextItem()
    assert pieces.IsDoneWithTraversal()
    assert found.GetNumberOfPolys() == len(facets.faces)
    x, y, z = (facets.vertices + np.array([80.0, 0.0, 5.0])).T / 1000
    np.testing.assert_allclose(vtk_to_numpy(found.GetPoints().GetData()), np.stack([x, z, -y], -1), atol=1e-8)  # m
