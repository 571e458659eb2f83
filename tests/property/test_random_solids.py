"""Any inputs make either a valid, closed solid of the right volume, or an error that names its parameter."""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import HealthCheck, event, given, settings
from OCP.BRepCheck import BRepCheck_Analyzer
from support.exact import solid_volume
from support.strategies import build_gear, gear_inputs, names_a_field

from gearcad import Gear
from gearcad.core.errors import InputError
from gearcad.solids import gear_solid, tessellate

VOLUME_TOLERANCE = 1e-7  # 0.1 ppm
CHORD_ERROR = 0.002  # in normal modules


def check_solid(gear: Gear) -> None:
    import trimesh

    solid = gear_solid(gear)
    assert BRepCheck_Analyzer(solid.wrapped).IsValid()
    assert len(solid.Shells()) == 1
    assert solid.Shells()[0].wrapped.Closed()
    expected = solid_volume(gear)
    assert solid.Volume() == pytest.approx(expected, rel=VOLUME_TOLERANCE)
    facets = tessellate(gear, CHORD_ERROR * gear.normal_module)
    mesh = trimesh.Trimesh(facets.vertices, facets.faces, process=False)
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert abs(facets.volume - expected) <= CHORD_ERROR * gear.normal_module * mesh.area


def check_inputs(inputs: dict[str, Any]) -> None:
    try:
        gear = build_gear(inputs)
    except InputError as error:
        event(f"refused: {error.parameter}")
        assert names_a_field(error)
        return
    event("solid")
    check_solid(gear)


@settings(max_examples=12, suppress_health_check=[HealthCheck.too_slow])
@given(gear_inputs())
def test_gears_are_valid_solids_or_refused(inputs: dict[str, Any]) -> None:
    check_inputs(inputs)


@pytest.mark.long
@settings(max_examples=10_000, suppress_health_check=[HealthCheck.too_slow])
@given(gear_inputs())
def test_gears_are_valid_solids_or_refused_long(inputs: dict[str, Any]) -> None:
    check_inputs(inputs)
