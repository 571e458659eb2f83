"""Rings and shaper cutters that cannot be: one line each, and the number in it would do."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import pytest

from gearcad import BasicRack, Body, Gear, GeometryError, ParameterError
from gearcad.core.errors import InputError
from gearcad.core.records import PerGear
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
