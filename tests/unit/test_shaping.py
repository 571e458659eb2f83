"""Rings, shaper cutters and specs with a ring that cannot be: one line each, and the number in it would do."""

import re
from dataclasses import replace
from typing import Any

import pytest

from gearcad import BasicRack, Body, Gear, GeometryError, ParameterError
from gearcad.core.errors import InputError, SpecError
from gearcad.core.records import PerGear
from gearcad.designs.design import Design
from gearcad.designs.reader import design_from_tables
from gearcad.geometry import ShaperCutter, zero_backlash_centre_distance


def _inputs(**changes: Any) -> dict[str, Any]:
    return {"normal_module": 2.0, "face_width": 10.0} | changes


def _with(inputs: dict[str, Any], parameter: str, value: float) -> dict[str, Any]:
    """The inputs with another value of one parameter, such as cutter.teeth."""
    part, _, field = parameter.rpartition(".")
    if not part:
        return inputs | {field: value}
    known = inputs.get(part) or {"rack": BasicRack(), "cutter": ShaperCutter(), "body": Body()}[part]
    return inputs | {part: replace(known, **{field: value})}


CUTTER = ShaperCutter(teeth=25)
REFUSED: list[tuple[dict[str, Any], str, str, float]] = [
    ({"teeth": -20}, r"tip_diameter = -36 mm: must be below {} mm \(rack.addendum below 0.603073\), the base", "", -1e-4),
    ({"teeth": -20}, r"tip_diameter = -36 mm: must be below -37.5878 mm \(rack.addendum below {}\)", "rack.addendum", -1e-6),
    ({"teeth": -70, "cutter": ShaperCutter(teeth=100)}, r"cutter.teeth = 100: must be at most {}: the cutter", "", 0),
    (
        {"teeth": -70, "cutter": ShaperCutter(teeth=69, profile_shift=0.1)},
        "cutter.profile_shift = 0.1: must be below {}: the cutter meshes", "", -1e-5,
    ),
    ({"teeth": -70, "cutter": replace(CUTTER, profile_shift=-3)}, "cutter.profile_shift = -3: must be above {}:", "", 2.1),
    ({"teeth": -70, "cutter": replace(CUTTER, tip_radius=0.5)}, r"cutter.tip_radius = 0.5: must be at most {} \(full", "", 0),
    ({"teeth": -70, "cutter": ShaperCutter(tip_radius=0.5)}, r"cutter.tip_radius = 0.5: must be at most {} \(full", "", 0),
    ({"teeth": -70, "cutter": ShaperCutter(teeth=18)}, "tip_diameter = -136 mm: must be at most {} mm", "", 0),
    ({"teeth": -70, "cutter": ShaperCutter(teeth=18)}, r"\(rack.addendum at most {}\): the cutter's inv", "rack.addendum", 0),
    ({"teeth": -70, "cutter": ShaperCutter(teeth=18)}, "or cutter.teeth at least {}$", "cutter.teeth", 0),
    ({"teeth": -70, "cutter": CUTTER, "root_diameter": -150.0}, "root_diameter = -150 mm: must be at least {} mm", "", 0),
    ({"teeth": -70, "cutter": CUTTER, "rack": BasicRack(dedendum=2.9)}, "rack.dedendum = 2.9: must be at most {}, wh", "", 0),
    ({"teeth": -70, "rack": BasicRack(dedendum=2.9)}, "rack.dedendum = 2.9: must be at most {}, where the flanks of", "", 0),
    ({"teeth": -70, "root_diameter": -160.0}, "root_diameter = -160 mm: must be at least {} mm, where the flanks of", "", 0),
    (
        {"teeth": -70, "normal_module": 0.01, "face_width": 1.0, "root_diameter": -0.8},
        "root_diameter = -0.8 mm: must be at least {} mm", "", 0,
    ),
    ({"teeth": -70, "root_diameter": -137.0}, "root_diameter = -137 mm: must be below {} mm", "", -3.0),
    ({"teeth": -60, "body": Body(tip_chamfer=3.0)}, "body.tip_chamfer = 3 mm: must be at most {} mm", "", 0),
    ({"teeth": 30, "cutter": ShaperCutter(teeth=10)}, "tip_diameter = 64 mm: must be at most {} mm", "", 0),
    ({"teeth": 30, "cutter": ShaperCutter(teeth=10)}, "or cutter.teeth at least {}$", "cutter.teeth", 0),
    ({"teeth": 30, "cutter": replace(CUTTER, tip_radius=0.6)}, r"cutter.tip_radius = 0.6: must be at most {} \(full", "", 0),
    ({"teeth": -60, "tip_diameter": 116.0}, "tip_diameter = 116 mm: must be a number below 0 mm, .*: write {}$", "", 0),
    ({"teeth": -60, "root_diameter": 125.0}, "root_diameter = 125 mm: must be a number below 0 mm, .*: write {}$", "", 0),
]  # fmt: skip
"""Inputs, the message with the number that would do, its parameter ("": the one refused), and what to add to it."""


@pytest.mark.parametrize(("inputs", "message", "parameter", "beyond"), REFUSED, ids=[message for _, message, *_ in REFUSED])
def test_refused_with_the_number_that_would_do(inputs: dict[str, Any], message: str, parameter: str, beyond: float) -> None:
    with pytest.raises(InputError) as refused:
        Gear(**_inputs(**inputs))
    text = str(refused.value)
    assert "\n" not in text
    found = re.search(message.format(r"(-?[0-9.]+)"), text)
    assert found, text
    parameter = parameter or refused.value.parameter
    number = float(found.group(1)) + beyond
    Gear(**_with(_inputs(**inputs), parameter, round(number) if parameter == "cutter.teeth" else number))


def test_the_limits_are_tight() -> None:
    """A little beyond each, there is a fault again."""
    limits = {"tip_diameter": -136.281, "cutter.teeth": 20}
    inputs = _inputs(teeth=-70, cutter=ShaperCutter(teeth=18))
    for parameter, value, step in (("tip_diameter", limits["tip_diameter"], 1e-3), ("cutter.teeth", 20, -1)):
        Gear(**_with(inputs, parameter, value))
        with pytest.raises(GeometryError, match="the cutter's involute begins on its base circle"):
            Gear(**_with(inputs, parameter, value + step))


@pytest.mark.parametrize("teeth", [-70, 40])
@pytest.mark.parametrize("shift", [0.0, -0.4])
def test_tip_of_the_cutter_reaches_the_root_at_the_centre_distance_without_backlash(teeth: int, shift: float) -> None:
    gear = Gear(**_inputs(teeth=teeth, profile_shift=shift, cutter=ShaperCutter(teeth=25, profile_shift=0.1)))
    apart = zero_backlash_centre_distance(
        normal_module=2.0, teeth=PerGear(25, teeth), helix_angle=0.0, pressure_angle=20.0, shift_sum=shift + 0.1
    )
    assert gear.cutter_tip_diameter == pytest.approx(abs(2 * apart - gear.root_diameter), rel=1e-12)
    standard = replace(gear, profile_shift=0.0, cutter=CUTTER)
    assert standard.cutter_tip_diameter == pytest.approx(2.0 * (25 + 2 * 1.25), rel=1e-12)
    assert replace(gear, cutter=ShaperCutter()).cutter_tip_diameter is None


def test_too_few_teeth_and_wrong_signs() -> None:
    with pytest.raises(ParameterError, match=r"teeth = -8: must be a whole number from 3 to 2000, or from -2000 to -10 \(int"):
        Gear(**_inputs(teeth=-8))
    with pytest.raises(ParameterError, match=r"tip_diameter = -64 mm: must be a number above 0 mm$"):
        Gear(**_inputs(teeth=30, tip_diameter=-64.0))


def test_the_corner_is_the_racks_or_the_full_one() -> None:
    plain = Gear(**_inputs(teeth=-70))
    assert plain.profile.tool.radius == 0.38 * 2
    cramped = Gear(**_inputs(teeth=-40, profile_shift=-0.5))
    assert cramped.profile.tool.radius < 0.305 * 2 + 1e-3
    with pytest.raises(GeometryError, match="full radius"):
        Gear(**_inputs(teeth=-40, profile_shift=-0.5, cutter=ShaperCutter(tip_radius=0.38)))


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
