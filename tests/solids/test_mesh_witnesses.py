"""STL and GLB beside what knows nothing of ours: the exporter of trimesh, its reader, and that of VTK."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import trimesh
from support.samples import SAMPLES
from trimesh.exchange.gltf import export_glb

from gearcad import Body
from gearcad.solids import ScenePart, write_glb, write_stl
from gearcad.solids.facets.tessellation import Facets, tessellate

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
