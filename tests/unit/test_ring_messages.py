"""What specs of pairs with a ring are told where a newcomer goes wrong: the number that does do, and whose sign it is."""

from __future__ import annotations

import re
from typing import Any

import pytest

from gearcad.core.errors import SpecError
from gearcad.designs.design import Design
from gearcad.designs.reader import design_from_tables


def _tables(
    pair: dict[str, Any] | None = None, pinion: dict[str, Any] | None = None, wheel: dict[str, Any] | None = None
) -> dict[str, Any]:
    """A spur pinion of 22 teeth in a ring of 70, module 2.8, with some keys changed."""
    return {
        "pair": {"normal_module": 2.8, "face_width": 14.0} | (pair or {}),
        "pinion": {"teeth": 22} | (pinion or {}),
        "wheel": {"teeth": -70} | (wheel or {}),
    }


def _design(**changes: dict[str, Any]) -> Design:
    return design_from_tables(_tables(**changes), where=lambda key: "ring.toml", default_name="ring")


def _refusal(**changes: dict[str, Any]) -> str:
    with pytest.raises(SpecError) as caught:
        _design(**changes)
    return str(caught.value)


def test_ring_that_is_told_to_take_the_pinion_either_way_does_so_with_the_tip_that_is_then_clear() -> None:
    def told(teeth: int) -> list[str]:
        design = _design(wheel={"teeth": teeth, "tip_alteration": "clear"})
        return [text for text in design.warnings if "radial assembly" in text]

    (text,) = told(-29)
    named = int(re.search(r"from wheel.teeth = (-\d+) on", text)[1])  # type: ignore[index]
    assert told(named + 1) and not told(named)


@pytest.mark.parametrize("distance", [{}, {"centre_distance": -69.0}])
def test_shift_of_a_ring_in_the_sign_of_khk_is_told_where_the_other_sign_would_do(distance: dict[str, float]) -> None:
    changes = {"pair": distance, "pinion": {"profile_shift": 0.5, "tooth_thinning": 0.04}, "wheel": {"profile_shift": 1.2025}}
    reminder = "; is the profile shift in KHK's sign? then write wheel.profile_shift = -1.2025"
    assert _refusal(**changes).endswith(reminder)
    assert _design(**changes | {"wheel": {"profile_shift": -1.2025, "tooth_thinning": 0.05}}).gears["wheel"].teeth == -70
    # Neither where it has nothing to do with the fault, nor where the other sign would not do either.
    changes["wheel"] |= {"body": {"rim_diameter": 1.0}}
    assert "KHK" not in _refusal(**changes)


def test_shift_of_a_single_ring_in_the_sign_of_khk() -> None:
    gear = {"teeth": -70, "normal_module": 2.8, "face_width": 14.0, "profile_shift": 1.2025}
    with pytest.raises(SpecError, match=r"in KHK's sign\? then write profile_shift = -1.2025$"):
        design_from_tables({"gear": gear}, where=lambda key: "ring.toml", default_name="ring")


@pytest.mark.parametrize("teeth", [0, 2, -9])
def test_number_of_teeth_is_judged_before_the_sign_of_the_centre_distance(teeth: int) -> None:
    for distance in (-69.0, 69.0):
        assert f"wheel.teeth = {teeth}: must be" in _refusal(pair={"centre_distance": distance}, wheel={"teeth": teeth})


def test_shift_that_followed_from_the_centre_distance_is_told_only_of_faults_that_depend_on_it() -> None:
    changes = {"pair": {"centre_distance": -69.0}, "pinion": {"profile_shift": 0.5}}
    for field, value in (("cutter", {"teeth": 80}), ("body", {"rim_diameter": 240.0, "bolt_circle": 226.0, "bolt_holes": -1})):
        assert "profile_shift" not in _refusal(**changes, wheel={"profile_shift": "auto", field: value})
    text = _refusal(**changes, wheel={"profile_shift": "auto", "tip_diameter": -180.0})
    assert "; its profile_shift is -1.20" in text


@pytest.mark.parametrize("wheel", [{}, {"rack": {"addendum": 0.7}}, {"profile_shift": -0.4, "tip_alteration": "clear"}])
def test_ring_of_fewer_teeth_than_its_pinion_is_told_how_many_make_the_pair(wheel: dict[str, Any]) -> None:
    text = _refusal(wheel=wheel | {"teeth": -20})
    start = "ring.toml: wheel.teeth = -20: must be far below -22: the pinion stands inside the ring; with the other numbers"
    assert text.startswith(start)
    named = int(re.search(r" at most (-\d+)$", text)[1])  # type: ignore[index]
    assert _design(wheel=wheel | {"teeth": named}).gears["wheel"].teeth == named
    _refusal(wheel=wheel | {"teeth": named + 1})


def test_ring_that_its_cutter_cannot_make_is_told_what_the_pair_asks_of_its_tip_besides() -> None:
    ring = {"teeth": -28, "rack": {"addendum": 0.7}, "cutter": {"teeth": 15}}
    text = _refusal(wheel=ring)
    assert "no flank beyond that; or cutter.teeth at least 17; whatever the cutter, wheel.tip_diameter must be" in text
    tip = float(re.search(r"whatever the cutter, wheel.tip_diameter must be at most (-[\d.]+) mm", text)[1])  # type: ignore[index]
    assert _design(wheel=ring | {"tip_diameter": tip}).gears["wheel"].cutter.teeth == 15
    assert "whatever the cutter" not in _refusal(
        wheel=ring | {"teeth": -66, "rack": {"addendum": 0.9}, "cutter": {"teeth": 12}}
    )
