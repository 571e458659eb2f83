"""Any inputs make either a sane tooth or an error that names its parameter."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import event, given, settings
from support.strategies import build_gear, gear_inputs, names_a_field

from gearcad import Gear
from gearcad.core.errors import InputError
from gearcad.geometry.profile import CurveKind

ROUNDING = 1e-12
"""Relative rounding of radii and angles."""


def check_gear(gear: Gear) -> None:
    half_pitch = math.pi / gear.teeth
    assert gear.root_diameter <= gear.form_diameter * (1 + ROUNDING)
    assert gear.base_diameter <= gear.form_diameter * (1 + ROUNDING)
    assert gear.form_diameter < gear.tip_form_diameter <= gear.tip_diameter
    s = np.linspace(0, 1, 201)
    last = gear.root_diameter / 2
    for curve in gear.profile.curves:
        radius, angle = curve.polar(s)
        # Radii never fall from root to tip and each radius has one half angle within the pitch: no self-intersection.
        assert radius[0] == pytest.approx(last, rel=ROUNDING)
        assert np.all(np.diff(radius) >= -ROUNDING * radius[0])
        assert np.all(angle <= half_pitch * (1 + ROUNDING))
        assert np.all(angle[:-1] > 0)
        if curve.kind in (CurveKind.INVOLUTE, CurveKind.CHAMFER, CurveKind.TIP, CurveKind.ROOT):
            assert np.all(np.diff(angle) < 0)
        if curve.kind is CurveKind.FILLET and not gear.undercut:
            assert np.all(np.diff(angle) <= ROUNDING)
        last = radius[-1]
    assert last == pytest.approx(gear.tip_diameter / 2, rel=ROUNDING)
    turn = float(gear.profile.curves[-2].direction(0.0) - gear.profile.curves[-3].direction(1.0))
    if not gear.undercut and not gear.body.tip_chamfer:
        assert turn == pytest.approx(0, abs=1e-7)
    json.dumps(gear.to_dict(), allow_nan=False)  # every derived number exists


def check_inputs(inputs: dict[str, Any]) -> None:
    try:
        gear = build_gear(inputs)
    except InputError as error:
        event(f"refused: {error.parameter}")
        assert names_a_field(error), error
    else:
        event("made")
        check_gear(gear)


@settings(max_examples=80)
@given(gear_inputs())
def test_gear_or_error(inputs: dict[str, Any]) -> None:
    check_inputs(inputs)


@pytest.mark.long
@settings(max_examples=10_000)
@given(gear_inputs())
def test_gear_or_error_long(inputs: dict[str, Any]) -> None:
    check_inputs(inputs)
