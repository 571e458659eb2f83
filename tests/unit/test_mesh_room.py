"""What cannot fit is refused before it is meshed, with what would."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

import gearcad
from gearcad import Body, Gear, GeometryError, ParameterError
from gearcad.cli import main
from gearcad.jobs import mesh as mesh_job
from gearcad.meshing import plan

HELICAL = Gear(teeth=23, normal_module=2, face_width=12, helix_angle=-18, body=Body(bore=20))

LITTLE = 2.0e9
"""Bytes of a machine that has no room for rings of fine elements."""


def test_more_nodes_than_numbers_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plan, "machine_memory", lambda: 1e18)
    with pytest.raises(ParameterError, match=r"^size = 0.01 mm: makes .*a file numbers at most 2147483647; they take about"):
        gearcad.mesh(HELICAL, size=0.01)


def test_too_many_triangles_are_refused_before_a_sector_is_meshed_to_count_them(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plan, "machine_memory", lambda: LITTLE)
    with pytest.raises(ParameterError, match=r"^size = 0.001 mm: makes [0-9.e+]+ tri6"):
        gearcad.mesh(HELICAL, size=0.001, element="tri6")


class Meshes(Exception):
    """It was not refused."""


def meshes(*_arguments: Any) -> None:
    raise Meshes


@pytest.mark.parametrize("given", [{"size": 0.05}, {"elements": 9_000_000}])
def test_what_is_said_to_do_does(given: dict[str, Any], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plan, "machine_memory", lambda: LITTLE)
    monkeypatch.setattr(mesh_job, "run_mesh", meshes)
    (name,) = given
    with pytest.raises(ParameterError, match="GB of memory, and there are 2 GB") as refused:
        gearcad.mesh(HELICAL, **given)
    enough = re.search(r"about ([0-9.e+]+)(?: mm)? would do", str(refused.value))
    assert enough is not None
    with pytest.raises(Meshes):
        gearcad.mesh(HELICAL, **{name: type(given[name])(float(enough[1]))})


def test_usual_sizes_that_do_not_fit_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plan, "machine_memory", lambda: 1e6)
    with pytest.raises(GeometryError, match="a larger size, or less of the gear, would do"):
        gearcad.mesh(HELICAL, what="sector")


def test_want_of_memory_is_told_in_a_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail(*_arguments: Any) -> None:
        raise MemoryError("Unable to allocate 9 GiB")

    monkeypatch.setattr(mesh_job, "run_mesh", fail)
    spec = tmp_path / "some.toml"
    spec.write_text("[gear]\nteeth = 20\nnormal_module = 2.0\nface_width = 8.0\n", encoding="utf-8")
    result = CliRunner().invoke(main, ["mesh", str(spec), "--quiet", "-o", str(tmp_path / "out")])
    assert (result.exit_code, result.stderr) == (
        1,
        "Error: there is not enough memory (Unable to allocate 9 GiB); ask for less, or free some\n",
    )
