"""Pinions and racks in mesh, on their exact outlines: no overlap, and contact exactly where the backlash says.

`support.rack_clearance` knows nothing of backlash, contact ratio or interference, so it judges all three. Flanks that touch
after half the backlash, to 1e-7 modules, overlap where the rack is moved on by any more: by 2 µm too.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import event, given, settings
from hypothesis import strategies as st
from support.rack_clearance import travel_to_touch
from support.strategies import build_rack_pair, rack_pair_inputs

from gearcad import RackPair
from gearcad.core.errors import InputError

TOUCH = 1e-7
"""In normal modules: what the search along curves and the touching travel leave; also what counts as interference."""

SHOWN = 1e-2
"""A cut of this depth (normal modules) shows in one of 60 positions."""


def check_pair(pair: RackPair, start: float, side: int) -> None:
    m, half = pair.pinion.normal_module, pair.circumferential_backlash / 2
    places = (start + np.arange(9) / 9) * 360 / pair.pinion.teeth
    cuts = [notice for notice in pair.notices if notice.code == "fillet-interference"]
    if cuts:
        event("fillet interference")
        if any(float(cut.text.split("cuts ")[1].split()[0]) > SHOWN * m for cut in cuts):
            gaps = travel_to_touch(pair, np.linspace(0, 360 / pair.pinion.teeth, 60), side)
            assert gaps.min() < half - TOUCH * m  # what is said to cut does
        return
    always = pair.usable_contact_ratio >= 1 + 1e-6
    event("contact ratio at least 1" if always else "contact ratio below 1")
    gaps = travel_to_touch(pair, places, side)
    assert gaps.min() >= half - TOUCH * m  # the flanks never meet before they should: no overlap with the backlash split
    if always:
        assert gaps == pytest.approx(half, abs=TOUCH * m, rel=0)  # and a pair of flanks always meets there


def check_inputs(inputs: dict[str, Any], start: float, side: int) -> None:
    try:
        pair = build_rack_pair(inputs)
    except InputError as error:
        event(f"refused: {error.parameter}")
        assert "\n" not in str(error)
        return
    check_pair(pair, start, side)


START, SIDE = st.floats(-50, 50), st.sampled_from([1, -1])


@settings(max_examples=20)
@given(rack_pair_inputs(), START, SIDE)
def test_racks_touch_where_the_backlash_says(inputs: dict[str, Any], start: float, side: int) -> None:
    check_inputs(inputs, start, side)


@pytest.mark.long
@settings(max_examples=5_000)
@given(rack_pair_inputs(), START, SIDE)
def test_racks_touch_where_the_backlash_says_long(inputs: dict[str, Any], start: float, side: int) -> None:
    check_inputs(inputs, start, side)
