"""Splines: the printed rows of DIN 5480-2, worked examples, tolerances, designations, and what is refused."""

import json
import math
from pathlib import Path
from typing import Any

import pytest

from gearcad.core.errors import InputError
from gearcad.geometry.spline import SplineJoint
from gearcad.geometry.spline_inputs import HubInputs, ShaftInputs
from gearcad.geometry.spline_part import Spline
from gearcad.geometry.spline_standards import basic_thickness, deviation, read_designation, read_fit

REFERENCE = json.loads((Path(__file__).parents[1] / "data" / "splines.json").read_text(encoding="utf-8"))
LADDER = (300.0, 150.0, 75.0, 40.0, 20.0, 10.0)
"""A diameter (mm) of each column of the deviations of DIN 5480."""


def joint(**given: Any) -> SplineJoint:
    return SplineJoint(**given)


def shaft_and_hub(found: SplineJoint) -> tuple[Spline, Spline]:
    return found.parts["shaft"], found.parts["hub"]


def test_printed_rows_of_din_5480() -> None:
    tolerance = REFERENCE["tolerance"]
    for row in REFERENCE["din5480_inspection"]:
        inputs = {"nominal_diameter": row["reference_diameter"], "module": row["module"], "teeth": row["teeth"]}
        shaft, hub = shaft_and_hub(
            joint(
                standard="DIN 5480",
                **inputs,
                shaft=ShaftInputs(pin_diameter=row["shaft_pin"], span_teeth=row["span_teeth"]),
                hub=HubInputs(pin_diameter=row["hub_pin"]),
            )
        )
        of_shaft, of_hub = shaft.to_dict(), hub.to_dict()
        assert of_hub["between_pins"] == pytest.approx(row["between_pins"], abs=tolerance["between_pins"]), row
        assert of_hub["pin_factor"] == pytest.approx(row["hub_factor"], abs=tolerance["hub_factor"]), row
        assert of_shaft["span_measurement"] == pytest.approx(row["span"], abs=tolerance["span"]), row
        if row["over_pins"] is not None:
            assert of_shaft["over_pins"] == pytest.approx(row["over_pins"], abs=tolerance["over_pins"]), row
            assert of_shaft["pin_factor"] == pytest.approx(row["shaft_factor"], abs=tolerance["shaft_factor"]), row


def test_the_printed_hub_of_din_5480() -> None:
    example = REFERENCE["din5480_example_hub"]
    expected, tolerance = example["expected"], example["tolerance"]["between_pins"]
    found = joint(designation="N 120 x 3 x 38 x 9H", hub=HubInputs(pin_diameter=example["inputs"]["hub_pin"]))
    assert list(found.parts) == ["hub"]
    hub = found.parts["hub"].to_dict()
    assert (hub["root_diameter"], hub["tip_diameter"]) == (expected["root_diameter"], expected["tip_diameter"])
    assert hub["form_diameter_min"] == pytest.approx(expected["form_diameter_min"], abs=1e-9)
    assert hub["form_diameter"] > expected["form_diameter_min"]
    for key, name in (("actual_max", "max"), ("actual_min", "min")):
        assert hub[f"space_width_{key}"] == pytest.approx(expected[f"space_width_{name}"], abs=5e-4)
        assert hub[f"between_pins_{name}"] == pytest.approx(expected[f"between_pins_{name}"], abs=tolerance)
    assert hub["space_width_effective_min"] == pytest.approx(expected["effective_space_width_min"], abs=5e-4)
    assert (hub["tolerance_actual"], hub["tolerance_effective"]) == (56, 34)


def test_a_given_tooth_of_din_5480_is_that_of_the_gear_it_is() -> None:
    """The print of W 120 x 3 x 38: d_a 119.400, d_f 113.400, d_b 98.7269, s 6.2712."""
    shaft, hub = shaft_and_hub(joint(designation="W 120 x 3 x 38 / N 120 x 3 x 38"))
    gear = shaft.gear
    sizes = (gear.tip_diameter, gear.root_diameter, gear.base_diameter, gear.normal_tooth_thickness)
    assert sizes == pytest.approx((119.4, 113.4, 98.7269, 6.2712), abs=5e-5)
    ring = hub.gear
    assert (ring.tip_diameter, ring.root_diameter) == (-114, -120)
    assert math.pi * 3 - ring.normal_tooth_thickness == pytest.approx(gear.normal_tooth_thickness, abs=1e-12)


def test_deviations_of_din_5480() -> None:
    for letter, printed in REFERENCE["din5480_deviations"]["series"].items():
        fit = read_fit("DIN 5480", "shaft", f"8{letter}")
        unknown = (None, None)
        found = [deviation("DIN 5480", "shaft", fit, diameter, unknown) for diameter in LADDER]  # type: ignore[arg-type]
        assert found == printed, letter


def test_space_widths_of_ansi_b92_1() -> None:
    for row in REFERENCE["b92_1"]["rows"]:
        for angle, key in ((30.0, "space_30"), (37.5, "space_37_5"), (45.0, "space_45")):
            if row[key] is not None:
                found = basic_thickness("ANSI B92.1", angle, 25.4 / row["P"]) / 25.4
                assert found == pytest.approx(row[key], abs=REFERENCE["b92_1"]["tolerance"]), (row, angle)


def test_iso_4156_by_hand() -> None:
    """m 2.5, z 24, 30 deg fillet root, 5H/5f: the formulas of the standard, worked by hand."""
    shaft, hub = shaft_and_hub(joint(designation="INT/EXT 24z x 2.5m x 30R x 5H/5f", length=30.0))
    pitch_arc, depth = math.pi * 2.5 * 24 / 2, 2.5 + 0.0125 * 60
    parts = (3.55 * math.sqrt(pitch_arc) + 9, 2.5 * depth + 16, math.sqrt(30) + 5)
    variation = 0.6 * math.sqrt(sum(each**2 for each in parts))
    thickness = math.pi * 1.25
    total = 16 * (0.45 * 60 ** (1 / 3) + 0.06) + 64 * (0.45 * thickness ** (1 / 3) + 0.001 * thickness)
    for part in (shaft, hub):
        assert part.tolerances == pytest.approx((total - variation, variation), rel=1e-12)
    assert shaft.deviation == -0.030  # f of ISO 286 at 60 mm
    assert shaft.tip_diameter == pytest.approx(62.5 - 0.030 / math.tan(math.pi / 6), abs=1e-12)
    assert hub.root_diameter == pytest.approx(2.5 * 25.8)
    assert hub.effective_limit == pytest.approx(thickness) and shaft.effective_limit == pytest.approx(thickness - 0.030)


def test_play_is_that_of_the_limits() -> None:
    found = joint(designation="N 120 x 3 x 38 x 9H / W 120 x 3 x 38 x 8f")
    assert found.effective_play_min == pytest.approx(0.028, abs=1e-12)  # 8f: -28 µm
    assert found.effective_play_max == pytest.approx(0.028 + 0.056 + 0.040, abs=1e-12)
    assert found.actual_play_min == pytest.approx(0.028 + 0.034 + 0.023, abs=1e-12)
    assert found.actual_play_max == pytest.approx(0.028 + 0.034 + 0.056 + 0.023 + 0.040, abs=1e-12)


@pytest.mark.parametrize(
    "text, expected",
    [
        ("DIN 5480 - W 30 x 1,25 x 22 x 8f", {"nominal_diameter": 30.0, "module": 1.25, "teeth": 22}),
        ("N120x3x30x38x9H", {"nominal_diameter": 120.0, "module": 3.0, "teeth": 38}),
        ("EXT 24z x 2.5m x 30R x 5f", {"module": 2.5, "teeth": 24, "pressure_angle": 30.0}),
        ("INT 24T x 12/24P x 37.5R x 5", {"diametral_pitch": 12.0, "teeth": 24, "pressure_angle": 37.5}),
    ],
)
def test_designations(text: str, expected: dict[str, float]) -> None:
    assert dict(read_designation(text).values) == expected
    made = joint(designation=text)
    assert all(getattr(made, key) == value for key, value in expected.items())


@pytest.mark.parametrize(
    "given, words",
    [
        ({"designation": "W 30 x 1.3 x 22 x 8f"}, "the nearest is 1.25"),
        ({"designation": "W 30 x 1.25 x 28 x 8f"}, "a number of teeth near 22"),
        ({"designation": "W 30 x 1.25 x 22 x 8q"}, "x 8q': must be a grade from 5 to 12 and one of v, u"),
        ({"designation": "N 30 x 1.25 x 22 x 9H / W 31 x 1.25 x 22 x 8f"}, "of the same diameter, module and teeth"),
        ({"designation": "EXT 24z x 2.4m x 30R x 5f"}, "the nearest is 2.5"),
        ({"designation": "EXT 24z x 2.5m x 37R x 5f"}, "the nearest is 37.5"),
        ({"designation": "EXT 24T x 12/20P x 30R x 5"}, "must have a pitch like 12/24"),
        ({"designation": "hello"}, "must be like"),
        ({"designation": "W 30 x 1.25 x 22 x 8f", "teeth": 23}, "the designation says 22"),
        ({"standard": "DIN 5480", "module": 2, "teeth": 20}, "nominal_diameter"),
        ({"standard": "DIN 5480", "module": 2, "teeth": 20, "nominal_diameter": 60}, "must be from 40.2 to 46.2 mm"),
        ({"standard": "ISO 4156", "module": 2, "teeth": 20, "nominal_diameter": 40}, "must be left out"),
        ({"standard": "ISO 4156", "module": 2, "teeth": 20, "pressure_angle": 31}, "must be 30 or 37.5 or 45 deg"),
        ({"standard": "ISO 4156", "module": 2, "teeth": 5}, "from 6 to 500"),
        ({"standard": "DIN 5481", "module": 2, "teeth": 20}, "standard"),
        ({"module": 2, "teeth": 20}, "must be given, one of DIN 5480, ISO 4156, ANSI B92.1"),
        ({"designation": "W 30 x 1.25 x 22", "shaft": ShaftInputs(root="flat")}, "must be one of hobbed, rolled, broached"),
        ({"designation": "W 30 x 1.25 x 22", "shaft": ShaftInputs(bore=29.0)}, "shaft.body.bore"),
        ({"designation": "N 30 x 1.25 x 22", "hub": HubInputs(outer_diameter=29.0)}, "hub."),
        ({"standard": "ANSI B92.1", "diametral_pitch": 5, "teeth": 20, "pressure_angle": 45.0}, "at least 10/inch"),
    ],
)
def test_what_makes_no_spline_is_one_line(given: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError) as caught:
        joint(**given)
    assert words in str(caught.value) and "\n" not in str(caught.value)


def test_tolerances_that_are_not_known_are_told_and_can_be_given() -> None:
    unknown = joint(designation="W 30 x 1.25 x 22 x 8f").parts["shaft"]
    assert unknown.actual_limit is None and unknown.to_dict()["over_pins_max"] is None
    assert [each.code for each in unknown.notices] == ["unknown-tolerances"]
    own = ShaftInputs(tolerance_actual=30.0, tolerance_effective=20.0)
    given = joint(designation="W 30 x 1.25 x 22 x 8f", shaft=own).parts["shaft"]
    assert given.actual_limit == pytest.approx(given.basic_size - 0.022 - 0.020)
    assert given.actual_other == pytest.approx(given.basic_size - 0.022 - 0.050)
    assert not given.notices
