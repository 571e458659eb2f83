"""The exported mesh in another program: CalculiX reads it and solves what we solve (Debian: calculix-ccx)."""

from __future__ import annotations

import shutil
import subprocess
from dataclasses import asdict
from pathlib import Path

import numpy as np
import pytest
from scipy.sparse.linalg import spsolve

from gearcad import Gear
from gearcad.contact.plane.elasticity import Plane, PlaneElasticity, stiffness_matrix
from gearcad.material import Material
from gearcad.meshing.export import sector_mesh, write_mesh
from gearcad.meshing.section import MeshSizes, SectorMesh, mesh_sector

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
*SOLID SECTION, ELSET=body, MATERIAL=steel
{thickness}
*BOUNDARY
hub, 1, 2
*STEP
*STATIC
*CLOAD
{loads}
*NODE PRINT, NSET=flank
U
*END STEP
"""


@pytest.mark.skipif(CCX is None, reason="needs CalculiX (ccx)")
@pytest.mark.parametrize("plane", Plane)
def test_calculix_solves_the_mesh_as_we_do(plane: Plane, tmp_path: Path) -> None:
    mesh = mesh_sector(Gear(teeth=18, normal_module=1.5, face_width=10), 6.0, MeshSizes().coarse())
    body = sector_mesh(mesh)
    write_mesh(body, tmp_path / "gear.inp", plane_strain=plane is Plane.STRAIN)
    flank = body.sets["flank"]
    force = -100.0 / len(flank)  # N in x and in y on each node of the flank, per mm of width
    loads = "\n".join(f"{node + 1}, {axis}, {THICKNESS * force!r}" for node in flank for axis in (1, 2))
    deck = DECK.format(**asdict(STEEL), thickness=THICKNESS, loads=loads)
    (tmp_path / "deck.inp").write_text(deck)
    assert CCX is not None
    run = subprocess.run([CCX, "deck"], cwd=tmp_path, capture_output=True, text=True, timeout=120)
    assert "ERROR" not in run.stdout
    assert run.returncode == 0
    rows = [line.split() for line in (tmp_path / "deck.dat").read_text().splitlines()]
    found = {int(row[0]): [float(u) for u in row[1:3]] for row in rows if len(row) == 4}
    ours = _solved(mesh, PlaneElasticity(STEEL, plane), flank, body.sets["hub"], force)[flank]
    theirs = np.array([found[node + 1] for node in flank])
    assert np.abs(theirs - ours).max() < INTEGRATION * np.abs(ours).max()


def _solved(mesh: SectorMesh, elasticity: PlaneElasticity, flank: np.ndarray, hub: np.ndarray, force: float) -> np.ndarray:
    """Displacements (n, 2) in mm with the same loads and the same nodes held."""
    loads = np.zeros((len(mesh.points), 2))
    loads[flank] = force
    free = np.setdiff1d(np.arange(loads.size), np.r_[2 * hub, 2 * hub + 1])
    moved = np.zeros(loads.size)
    moved[free] = spsolve(stiffness_matrix(mesh, elasticity)[free][:, free].tocsc(), loads.ravel()[free])
    return moved.reshape(-1, 2)
