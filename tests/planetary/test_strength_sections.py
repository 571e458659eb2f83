"""The rating of a planetary train on a sheet: the least safeties of its gears, and each mesh by itself."""

from __future__ import annotations

from pathlib import Path

from gearcad.designs.reader import read_spec
from gearcad.jobs.strength import Rate
from gearcad.page.panels.sheet_content import Figures, strength_figures


def test_every_mesh_has_its_own_sections() -> None:
    design = read_spec(Path(__file__).parents[2] / "templates" / "planetary-24-21-66.toml")
    job = Rate(report=False)
    expected = job.document(job.run(design))
    found: Figures = strength_figures(design)
    assert {section.name for section in found.sections} == {"", *expected["meshes"]}
    for name, mesh in expected["meshes"].items():
        gears = list(mesh["gears"].values()) if "gears" in mesh else ["pinion", "wheel"]
        stresses = mesh["stresses"]["sigma_F"]
        cells = [found.cells[f"{name}.factors.sigma_F", gear].value for gear in gears]
        assert cells == list(stresses.values())
        assert found.cells[f"{name}.factors.K_gamma", ""].value == mesh["factors"]["K_gamma"]
