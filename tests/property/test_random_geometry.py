"""Random gears, racks and pairs: what the program tells of them is what tools, gauges and rolling outlines find."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import event, given, settings
from support.ring_pairs import build_ring_pair, ring_pair_inputs
from support.ring_samples import random_ring
from support.strategies import (
    build_gear,
    build_pair,
    build_rack,
    build_rack_pair,
    gear_inputs,
    pair_inputs,
    rack_inputs,
    rack_pair_inputs,
)

from gearcad import GearPair
from gearcad.core.errors import InputError
from gearcad.verification.claims import Claim
from gearcad.verification.geometry import judge_gear, judge_pair, judge_rack

JUDGES: dict[str, tuple[Any, Any, Any]] = {
    "gear": (gear_inputs(), build_gear, lambda gear: judge_gear(gear, "gear", sections=2)),
    "rack": (rack_inputs(), build_rack, lambda rack: judge_rack(rack, "rack")),
    "pair": (pair_inputs(), build_pair, lambda pair: judge_pair(pair, "pair")),
    "rack pair": (rack_pair_inputs(), build_rack_pair, lambda pair: judge_pair(pair, "pair")),
    "ring pair": (ring_pair_inputs(), build_ring_pair, lambda data: judge_ring_pair(data)),
}


def judge_ring_pair(data: Any) -> list[Claim]:
    """The claims on a pair of a drawn pinion and ring; raises InputError where they do not run together."""
    return list(judge_pair(GearPair(pinion=data.pinion, wheel=data.wheel, centre_distance=data.centre_distance), "pair"))


def check(inputs: dict[str, Any], kind: str) -> None:
    _, build, judge = JUDGES[kind]
    try:
        claims = list(judge(build(inputs)))
    except InputError:
        event("refused")
        return
    for claim in claims:
        event(f"{claim.quantity}: {claim.passed}")
    # Root circles that are given far out can hold a ball off the flanks: the judge is right, and says so.
    assert not [claim for claim in claims if claim.passed is False]


@settings(max_examples=12)
@given(gear_inputs())
def test_what_is_told_of_a_few_gears_is_found(inputs: dict[str, Any]) -> None:
    check(inputs, "gear")


@settings(max_examples=12)
@given(pair_inputs())
def test_what_is_told_of_a_few_pairs_is_found(inputs: dict[str, Any]) -> None:
    check(inputs, "pair")


@pytest.mark.long
@pytest.mark.parametrize("kind", JUDGES)
def test_what_is_told_of_many_is_found(kind: str) -> None:
    @settings(max_examples=600, deadline=None)
    @given(JUDGES[kind][0])
    def many(inputs: dict[str, Any]) -> None:
        check(inputs, kind)

    many()


@pytest.mark.long
def test_what_is_told_of_a_hundred_rings_is_found() -> None:
    rng = np.random.default_rng(37)
    for _ in range(100):
        ring = random_ring(rng)
        assert not [claim for claim in judge_gear(ring, "ring", sections=2) if claim.passed is False], ring
