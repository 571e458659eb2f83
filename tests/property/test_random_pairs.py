"""Exact profiles of pairs, racks and rings in mesh: no overlap, and contact exactly where the backlash says."""

import math
import re
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np
import pytest
from hypothesis import event, given, settings
from hypothesis import strategies as st
from support.clearance import turn_to_touch
from support.rack_clearance import travel_to_touch
from support.ring_pairs import CHORD_ERROR, RingMesh, build_ring_pair, ring_pair_inputs
from support.strategies import build_pair, build_rack_pair, pair_inputs, rack_pair_inputs

from gearcad import GearPair, RackPair
from gearcad.core.errors import InputError
from gearcad.core.records import Floats
from gearcad.geometry.pair_data import PairData

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


SHOWN = 1e-2
"""A cut of this depth (normal modules) shows in one of 60 positions."""


def rack_check_pair(pair: RackPair, start: float, side: int) -> None:
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


def rack_check_inputs(inputs: dict[str, Any], start: float, side: int) -> None:
    try:
        pair = build_rack_pair(inputs)
    except InputError as error:
        event(f"refused: {error.parameter}")
        assert "\n" not in str(error)
        return
    rack_check_pair(pair, start, side)


START, SIDE = st.floats(-50, 50), st.sampled_from([1, -1])


@settings(max_examples=20)
@given(rack_pair_inputs(), START, SIDE)
def test_racks_touch_where_the_backlash_says(inputs: dict[str, Any], start: float, side: int) -> None:
    rack_check_inputs(inputs, start, side)


@pytest.mark.long
@settings(max_examples=5_000)
@given(rack_pair_inputs(), START, SIDE)
def test_racks_touch_where_the_backlash_says_long(inputs: dict[str, Any], start: float, side: int) -> None:
    rack_check_inputs(inputs, start, side)


STEP = 2e-3
"""How far (mm, on the working circle) before and behind the used-up backlash the pair is looked at."""

VISIBLE = 5e-3
"""Depth (mm) of an interference that shows at STEP before the flanks touch."""

POSITIONS = np.linspace(0, 1, 9)


def deepest(
    clearance: Callable[[Floats], Floats], low: float = 0.0, high: float = 1.0, points: int = 25, levels: int = 4
) -> float:
    """Least clearance over the positions between two ends, refined around the least."""
    for _ in range(levels):
        places = np.linspace(low, high, points)
        found = clearance(places)
        least = int(np.argmin(found))
        low, high = places[max(least - 1, 0)], places[min(least + 1, points - 1)]
    return float(found[least])


def mesh_of(pair: PairData) -> RingMesh:
    return RingMesh(pair.pinion, pair.wheel, -pair.centre_distance)


def overlaps_before_flanks_touch(pair: PairData) -> bool:
    """Whether anything overlaps, in any position, STEP before the backlash of either side is used up."""
    mesh, turn = mesh_of(pair), (pair.circumferential_backlash / 2 - STEP) / (pair.working_pitch_diameters.pinion / 2)
    return any(deepest(partial(mesh.clearance, turned=side * turn)) < 0 for side in (1, -1))


def confirm_refusal(pair: PairData, error: InputError) -> None:
    """That what is refused for an interference interferes."""
    assert "\n" not in str(error)
    text = str(error)
    if "interference" in text:
        kind = "involute" if "involute interference" in text else "trochoid"
        depth = float(re.search(r"(?:cuts|interfere by) ([\d.e-]+) mm", text)[1])  # type: ignore[index]
        event(f"refused: {kind}" + ("" if depth > VISIBLE else ", too shallow to see"))
        assert depth <= VISIBLE or overlaps_before_flanks_touch(pair)
    elif "root circle" in text or "backlash would be" in text:
        event(f"refused: {'tip in root' if 'root circle' in text else 'backlash'}")
        shallow = "backlash would be" in text and pair.circumferential_backlash > -VISIBLE
        assert shallow or deepest(mesh_of(pair).clearance) < 0
    else:
        event(f"refused: {error.parameter}")


def confirm_notices(pair: GearPair) -> bool:
    """That a pair which is told to interfere does; whether it is."""
    cuts = [notice.text for notice in pair.notices if notice.code == "fillet-interference"]
    depths = [float(re.search(r"cuts ([\d.e-]+) mm", text)[1]) for text in cuts]  # type: ignore[index]
    if cuts:
        visible = max(depths) > VISIBLE
        event("told: fillet" + ("" if visible else ", too shallow to see"))
        assert not visible or overlaps_before_flanks_touch(pair)
    return bool(cuts)


def confirm_mesh(pair: GearPair) -> None:
    """No overlap with the backlash split or STEP before it is used up; overlap STEP behind."""
    mesh, half, radius = mesh_of(pair), pair.circumferential_backlash / 2, pair.working_pitch_diameters.pinion / 2
    polygons = 4 * CHORD_ERROR * pair.pinion.transverse_module
    assert mesh.clearance(POSITIONS).min() >= (0 if half > polygons else -polygons)
    always = pair.usable_contact_ratio >= 1 + 1e-6
    event(f"admitted, {'backlash' if half > STEP else 'no backlash'}" + ("" if always else ", contact ratio below 1"))
    for side in (1, -1):
        if half > STEP:
            assert mesh.clearance(POSITIONS, side * (half - STEP) / radius).min() >= 0
        if always:
            assert mesh.clearance(POSITIONS, side * (half + STEP) / radius).max() < 0


def check(inputs: dict[str, Any]) -> None:
    try:
        data = build_ring_pair(inputs)
    except InputError as error:
        event(f"no gear: {error.parameter}")
        return
    try:
        pair = GearPair(pinion=data.pinion, wheel=data.wheel, centre_distance=data.centre_distance)
    except InputError as error:
        confirm_refusal(data, error)
        return
    if not confirm_notices(pair):
        confirm_mesh(pair)


@settings(max_examples=40)
@given(ring_pair_inputs())
def test_rings_and_pinions_touch_nowhere_but_at_their_flanks(inputs: dict[str, Any]) -> None:
    check(inputs)


@pytest.mark.long
@settings(max_examples=5000)
@given(ring_pair_inputs())
def test_rings_and_pinions_touch_nowhere_but_at_their_flanks_long(inputs: dict[str, Any]) -> None:
    check(inputs)


# ---------------------------------------------------------------------- put in along the line of centres

COARSE = 1e-3
"""Chord error of the polygons of a pinion that is pushed in (transverse modules): its corners are exact."""

SEATED = 0.03
"""Way from its place (transverse modules) over which flanks that are nearly in mesh are not looked at."""


def deepest_on_the_way_in(pair: GearPair) -> float:
    """Least clearance (mm) of a pinion in any position, anywhere on its way to its place, refined around the least."""
    m = pair.pinion.transverse_module
    mesh = RingMesh(pair.pinion, pair.wheel, -pair.centre_distance, COARSE)
    way_out = -pair.centre_distance + pair.pinion.tip_diameter / 2 + pair.wheel.tip_diameter / 2
    way_out = min(way_out, -pair.centre_distance * (1 - 1e-6))  # a pinion larger than the opening is never out
    least = math.inf
    places, backs = np.linspace(0, 1, 17)[:, None], np.linspace(SEATED * m, way_out, 17)
    for _ in range(4):
        found = mesh.clearance(places, back=backs)
        least = min(least, float(found.min()))
        row, column = np.unravel_index(np.argmin(found), found.shape)
        places = np.linspace(places[max(row - 1, 0), 0], places[min(row + 1, 16), 0], 17)[:, None]
        backs = np.linspace(backs[max(column - 1, 0)], backs[min(column + 1, 16)], 17)
    return least


def check_way_in(inputs: dict[str, Any]) -> None:
    try:
        data = build_ring_pair(inputs)
        pair = GearPair(pinion=data.pinion, wheel=data.wheel, centre_distance=data.centre_distance)
    except InputError as error:
        event(f"no pair: {error.parameter}")
        return
    codes = {notice.code for notice in pair.notices}
    if "fillet-interference" in codes:
        event("told: fillet")
        return
    event(f"goes in {'along the axis' if 'radial-assembly' in codes else 'either way'}")
    assert (deepest_on_the_way_in(pair) < 0) is ("radial-assembly" in codes)


@settings(max_examples=40)
@given(ring_pair_inputs(most_more=20))
def test_what_goes_in_along_the_line_of_centres(inputs: dict[str, Any]) -> None:
    check_way_in(inputs)


@pytest.mark.long
@settings(max_examples=2000)
@given(ring_pair_inputs(most_more=40))
def test_what_goes_in_along_the_line_of_centres_long(inputs: dict[str, Any]) -> None:
    check_way_in(inputs)
