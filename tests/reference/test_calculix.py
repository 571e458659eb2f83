"""Meshes in another program: CalculiX reads them and solves what we solve (Debian: calculix-ccx)."""

from __future__ import annotations

import shutil
import subprocess
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve
from support.boxes import box
from support.brute import stiffness_matrix

from gearcad import Gear
from gearcad.contact.plane.sector import Plane, PlaneElasticity
from gearcad.material import Material
from gearcad.meshing import Element, ElementMesh, MeshSizes
from gearcad.meshing.bodies.section_mesh import mesh_section
from gearcad.meshing.files import write_inp
from gearcad.meshing.sector import SectorMesh

CCX = shutil.which("ccx")

STEEL = Material()

# Where sides are curved, three points (ccx) and six (ours) do not integrate a triangle to the same: 1.0e-4 on this mesh.
INTEGRATION = 2e-4

# ccx makes the triangles prisms of this thickness (mm), free at their ends in plane stress: a plane is what thin ones tend to.
THICKNESS = 0.01

DECK = """*INCLUDE, INPUT=gear.inp
*MATERIAL, NAME=steel
*ELASTIC
{youngs_modulus}, {poisson_ratio}
*SOLID SECTION, ELSET=gear, MATERIAL=steel
{thickness}
*BOUNDARY
bore, 1, 2
*STEP
*STATIC
*CLOAD
{loads}
*NODE PRINT, NSET=left_flank_0
U
*END STEP
"""

PRESSURE = 100.0
"""MPa on the far side of the box; its other three planes are held."""

BOX = """*INCLUDE, INPUT=gear.inp
*MATERIAL, NAME=steel
*ELASTIC
{youngs_modulus}, {poisson_ratio}
*SOLID SECTION, ELSET=gear, MATERIAL=steel
{thickness}
*BOUNDARY
bore, 1
cut_behind, 2
{back}
*STEP
*STATIC
*DSLOAD
left_flank_0, P, 100.
*NODE PRINT, NSET=nodes
U
*END STEP
"""


@pytest.mark.skipif(CCX is None, reason="needs CalculiX (ccx)")
@pytest.mark.parametrize("plane", Plane)
def test_calculix_solves_the_mesh_as_we_do(plane: Plane, tmp_path: Path) -> None:
    sizes = MeshSizes().coarse()
    gear = Gear(teeth=18, normal_module=1.5, face_width=10)
    mesh = mesh_section(gear, teeth=1, held_radius=6.0, sizes=sizes, element=Element.TRI6)
    write_inp(mesh, tmp_path / "gear.inp", plane_strain=plane is Plane.STRAIN)
    flank = mesh.nodes("left_flank_0")
    force = -100.0 / len(flank)  # N in x and in y on each node of the flank, per mm of width
    loads = "\n".join(f"{node + 1}, {axis}, {THICKNESS * force!r}" for node in flank for axis in (1, 2))
    found = _run(tmp_path, DECK.format(**asdict(STEEL), thickness=THICKNESS, loads=loads))
    ours = _solved(mesh, PlaneElasticity(STEEL, plane), force)[flank]
    theirs = np.array([found[node + 1][:2] for node in flank])
    assert np.abs(theirs - ours).max() < INTEGRATION * np.abs(ours).max()


@pytest.mark.skipif(CCX is None, reason="needs CalculiX (ccx)")
@pytest.mark.parametrize("element", Element)
def test_calculix_presses_a_box_as_expected(element: Element, tmp_path: Path) -> None:
    """Even stress: wrong orders of nodes, sides or sets would each spoil it."""
    write_inp(box(element), tmp_path / "gear.inp", plane_strain=False)
    solid = element.shape.dimension == 3
    found = _run(tmp_path, BOX.format(**asdict(STEEL), thickness="" if solid else "1.", back="end_back, 3" if solid else "**"))
    strain = -PRESSURE / STEEL.youngs_modulus
    strains = strain * np.array([1, -STEEL.poisson_ratio, -STEEL.poisson_ratio])[: element.shape.dimension]
    expected = box(element).points[:, : len(strains)] * strains
    theirs = np.array([found[node + 1] for node in range(len(expected))])[:, : len(strains)]
    # The .dat has seven digits.
    assert np.abs(theirs - expected).max() < 2e-6 * np.abs(expected).max()


def _run(folder: Path, deck: str) -> dict[int, list[float]]:
    """Run a deck in a folder: displacements (mm) of printed nodes, by their numbers."""
    (folder / "deck.inp").write_text(deck)
    assert CCX is not None
    run = subprocess.run([CCX, "deck"], cwd=folder, capture_output=True, text=True, timeout=120)
    assert "ERROR" not in run.stdout
    # Abaqus has a word for node sets whose order matters; CalculiX does not know it, and says so.
    assert run.stdout.count("*WARNING") == run.stdout.count("UNSORTED")
    assert run.returncode == 0
    rows = [line.split() for line in (folder / "deck.dat").read_text().splitlines()]
    return {int(row[0]): [float(u) for u in row[1:]] for row in rows if len(row) == 4}


def _solved(mesh: ElementMesh, elasticity: PlaneElasticity, force: float) -> np.ndarray:
    """Displacements (n, 2) in mm with the same loads and the same nodes held."""
    sector = SectorMesh(mesh.points[:, :2], mesh.cells.astype(np.int64), {})
    loads = np.zeros((len(mesh.points), 2))
    loads[mesh.nodes("left_flank_0")] = force
    held = mesh.nodes("bore")
    free = np.setdiff1d(np.arange(loads.size), np.r_[2 * held, 2 * held + 1])
    moved = np.zeros(loads.size)
    moved[free] = spsolve(stiffness_matrix(sector, elasticity)[free][:, free].tocsc(), loads.ravel()[free])
    return moved.reshape(-1, 2)
