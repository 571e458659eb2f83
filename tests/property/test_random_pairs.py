"""Exact profiles in mesh: no overlap, and contact exactly where the backlash says, at any position of the pinion.

`support.clearance` knows nothing of backlash, contact ratio or interference, so it judges all three.
"""

from __future__ import annotations

from typing import Any

import pytest
from hypothesis import event, given, settings
from hypothesis import strategies as st
from support.clearance import turn_to_touch
from support.strategies import build_pair, pair_inputs

from gearcad import GearPair
from gearcad.core.errors import InputError

TOUCH = 1e-7
"""In normal modules, along the working circle: what the search along curves and the touching turn leave."""


NOISE = 1e-13
"""In normal modules, of a centre distance in normal modules: what rounding leaves of a difference is less."""


def check_pair(pair: GearPair, places: list[float]) -> None:
    m, half = pair.pinion.normal_module, pair.circumferential_backlash / 2
    radius = pair.working_pitch_diameters[1] / 2
    if any("fillet interference" in warning for warning in pair.warnings):
        event("fillet interference")
        return
    always = pair.transverse_contact_ratio >= 1 + 1e-6
    event("contact ratio at least 1" if always else "contact ratio below 1")
    for place in places:
        for side in (1, -1):
            gap = turn_to_touch(pair, place * 360 / pair.pinion.teeth, side) * radius
            assert gap >= half - TOUCH * m  # the flanks never meet before they should: no overlap with the backlash split
            if always:
                assert gap == pytest.approx(half, abs=TOUCH * m, rel=0)  # and a pair of flanks always meets there


def check_inputs(inputs: dict[str, Any], places: list[float]) -> None:
    try:
        pair = build_pair(inputs)
    except InputError as error:
        event(f"refused: {error.parameter}")
        assert "\n" not in str(error)
        return
    check_pair(pair, places)


PLACES = st.lists(st.floats(0, 1), min_size=3, max_size=3)


@settings(max_examples=40)
@given(pair_inputs(), PLACES)
def test_pairs_touch_where_the_backlash_says(inputs: dict[str, Any], places: list[float]) -> None:
    check_inputs(inputs, places)


@pytest.mark.long
@settings(max_examples=10_000)
@given(pair_inputs(), PLACES)
def test_pairs_touch_where_the_backlash_says_long(inputs: dict[str, Any], places: list[float]) -> None:
    check_inputs(inputs, places)


@settings(max_examples=40)
@given(pair_inputs())
def test_documents_have_no_rounding_in_the_place_of_zero(inputs: dict[str, Any]) -> None:
    """At the centre distance without backlash its difference is 0, and so is that of the shift sums."""
    try:
        pair = build_pair({**inputs, "spread": None})
    except InputError:
        return
    document = pair.to_dict()
    for key in ("circumferential_backlash", "normal_backlash", "zero_backlash_shift_sum", "tip_alteration"):
        assert document[key] == 0 or abs(document[key]) > NOISE * abs(pair.centre_distance) / pair.pinion.normal_module, key
