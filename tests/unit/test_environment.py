"""The system libraries of the README's command are enough for every library the project and its tests build on."""

from __future__ import annotations

import importlib

import pytest


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
