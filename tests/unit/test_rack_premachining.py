"""Racks that are cut before their flanks are finished: equations of the gear's limit, brute force, what is refused, files."""

import math
import random
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from gearcad import BasicRack, Gear, Rack, RackPair
from gearcad.core.errors import GeometryError, InputError, SpecError
from gearcad.designs.reader import read_spec
from gearcad.geometry.premachining import Premachining, RackFinishing, RackPremachining, SemiTopping
from gearcad.geometry.rack_root import RackCurveKind
from gearcad.jobs.build import Build
from gearcad.rating.root_stress import GrindingNotch
from gearcad.verification.geometry import judge_rack
from gearcad.verification.rolled_outlines import rack_points
from gearcad.verification.tool_sweep import counterpart_of

_TOOL = {"tool_addendum": 1.4, "tool_tip_radius": 0.3, "protuberance": 0.14, "protuberance_angle": 8.0, "stock": 0.1}
_NOTCH = {"protuberance": 0.0, "protuberance_angle": None}


def cut_before(**changes: Any) -> Rack:
    """A rack that a tool with a protuberance cuts before it is ground."""
    given = {name: changes.pop(name) for name in list(changes) if name in RackPremachining.__dataclass_fields__}
    kept = {name: value for name, value in (_TOOL | given).items() if value is not None}
    rack = {"teeth": 8, "normal_module": 3.0, "face_width": 20.0, "height": 20.0}
    return Rack(**rack | {"premachining": RackPremachining(**kept)} | changes)


def test_a_tool_without_protuberance_and_stock_makes_the_plain_tooth() -> None:
    plain = Rack(
        teeth=8,
        normal_module=3.0,
        helix_angle=12.0,
        face_width=20.0,
        height=20.0,
        rack=BasicRack(dedendum=1.3, root_radius=0.3),
    )
    twice = replace(plain, rack=BasicRack(), premachining=RackPremachining(tool_addendum=1.3, tool_tip_radius=0.3))
    heights = np.linspace(-plain.root_depth, plain.tip_height, 41)
    assert twice.profile.half_thickness(heights) == pytest.approx(plain.profile.half_thickness(heights), abs=1e-13)
    assert twice.form_depth == pytest.approx(plain.form_depth, abs=1e-14)


def test_a_gear_of_very_many_teeth_has_the_root_of_the_rack() -> None:
    """Its tooth is that of the rack but for its curvature; extrapolated from 1000 and 2000 teeth the error is of 2nd order."""
    rack, teeth = cut_before(), 2000
    gears = [
        Gear(teeth=each, normal_module=3.0, face_width=20.0, premachining=Premachining(**_TOOL)) for each in (teeth, teeth // 2)
    ]
    depths = [(gear.reference_diameter - gear.form_diameter) / 2 for gear in gears]
    assert 2 * depths[0] - depths[1] == pytest.approx(rack.form_depth, abs=2e-4)
    undercuts = [gear.greatest_undercut for gear in gears]
    assert 2 * undercuts[0] - undercuts[1] == pytest.approx(rack.greatest_undercut, abs=3e-6)


def test_stock_stands_on_both_flanks() -> None:
    rack = cut_before(helix_angle=18.0)
    before = rack.precut
    assert before.stock == 0
    thicker = before.profile.half_thickness(1.0) - rack.profile.half_thickness(1.0)
    across = thicker * math.cos(math.radians(18)) * math.cos(math.radians(20))
    assert across == pytest.approx(0.1, abs=1e-13)
    # A pin of one size stands higher by the stock over the sine of the pressure angle.
    pin = rack.pin_diameter
    higher = before.inspection.over_pin(pin) - rack.inspection.over_pin(pin)
    assert higher == pytest.approx(0.1 / math.sin(math.radians(20)), abs=1e-12)


def test_the_notch_has_the_arc_of_the_wheel() -> None:
    rack = cut_before(**_NOTCH, finishing=RackFinishing(end_depth=3.1, wheel_tip_radius=0.4))
    *_, tool, _, wheel = [curve for curve in rack.profile.curves if curve.kind is RackCurveKind.FILLET]
    assert tool.kind is RackCurveKind.FILLET
    end = float(wheel.direction(np.array([1.0]))[0])
    assert end == pytest.approx(math.radians(70), abs=1e-12)  # tangent to the flank
    start, before = wheel.points(0.0), rack.precut
    assert -start[0] == pytest.approx(before.profile.half_thickness(float(start[1])), abs=1e-12)
    assert rack.form_depth == 3.1
    notch = GrindingNotch.of(rack)
    assert notch is not None
    assert notch == (pytest.approx(0.1), 0.4)


def test_topping_and_ramp_make_the_tips() -> None:
    assert cut_before(topping=2.9).tip_height == 2.9
    rack = cut_before(semi_topping=SemiTopping(angle=45.0, height=2.2))
    ramp = rack.profile.curves[-2]
    assert ramp.kind is RackCurveKind.CHAMFER
    (x, y), (to_x, to_y) = ramp.points(np.array([0.0, 1.0]))
    assert to_x - x == pytest.approx(to_y - y, abs=1e-13)
    # The ramp begins on the flank with the stock, 2.2 mm over the reference line.
    at = -(x + (2.2 - y))
    assert at == pytest.approx(rack.precut.profile.half_thickness_on_flank(2.2), abs=1e-12)


def random_rack(rng: random.Random) -> Rack:
    """A rack of random tools, or an InputError for those that cannot cut it."""
    m, angle = 10 ** rng.uniform(-0.5, 1.3), rng.choice([14.5, 17.5, 20.0, 25.0])
    pre: dict[str, Any] = {"tool_addendum": rng.uniform(1.1, 1.6), "tool_tip_radius": rng.choice([0.0, rng.uniform(0.05, 0.4)])}
    pre["stock"] = rng.uniform(0.0, 0.05) * m
    end: dict[str, Any] = {}
    if rng.random() < 0.6:
        pre |= {
            "protuberance": rng.choice([pre["stock"], rng.uniform(0.001, 0.08) * m]),
            "protuberance_angle": rng.uniform(1, 14),
        }
    if rng.random() < 0.5:
        end = {"end_depth": rng.uniform(0.8, 1.3) * m, "wheel_tip_radius": rng.uniform(0.02, 0.4) * m}
    if rng.random() < 0.3:
        pre["semi_topping"] = SemiTopping(angle=rng.uniform(30, 60), height=rng.uniform(0.5, 0.9) * m)
    elif rng.random() < 0.3:
        pre["topping"] = rng.uniform(0.8, 1.1) * m
    return Rack(
        teeth=6,
        normal_module=m,
        helix_angle=rng.choice([0.0, 17.0, -33.0]),
        face_width=8 * m,
        height=5 * m,
        tooth_thinning=rng.choice([0.0, 0.03]) * m,
        rack=BasicRack(pressure_angle=angle),
        premachining=RackPremachining(**pre),
        finishing=RackFinishing(**end),
    )


def test_random_outlines_are_unbroken_and_touch_the_tools() -> None:
    rng, made = random.Random(11), 0
    for _ in range(150):
        try:
            rack = random_rack(rng)
        except InputError as error:
            assert "\n" not in str(error)
            continue
        made += 1
        ends = [curve.points(np.array([0.0, 1.0])) for curve in rack.profile.curves]
        assert (
            max(float(np.hypot(*(after[0] - before[1]))) for before, after in pairwise(ends))
            < 1e-12 * rack.normal_module + 1e-13
        )
        points = rack_points(rack.profile, 1e-3 * rack.normal_module)
        off = counterpart_of(rack).distance(points + rack.transverse_pitch / 2)
        tips = 0.0 if rack.premachining.semi_topping.present else rack.tip_chamfer
        cut = points.imag < rack.tip_height - tips - 1e-9
        assert off.min() > -1e-9 * rack.normal_module, rack
        assert np.abs(off[cut]).max() < 1e-9 * rack.normal_module, rack
        heights = points.imag[np.r_[True, np.diff(points.imag) > 1e-12]]
        halves = -points.real[np.r_[True, np.diff(points.imag) > 1e-12]]
        inside = (heights > -rack.root_depth + 1e-9) & (heights < rack.tip_height - 1e-9)
        assert rack.profile.half_thickness(heights[inside]) == pytest.approx(halves[inside], abs=1e-7 * rack.normal_module)
    assert made > 30


def test_a_rack_that_is_off_by_a_micrometre_is_noticed() -> None:
    rack = cut_before()
    wrong = replace(rack, premachining=replace(rack.premachining, stock=0.101))
    points = rack_points(rack.profile, 1e-3)
    off = counterpart_of(wrong).distance(points + rack.transverse_pitch / 2)
    assert np.abs(off[points.imag < rack.tip_height - 1e-9]).max() > 5e-4
    assert all(claim.passed for claim in judge_rack(rack, "rack"))


_FAULTS: list[tuple[dict[str, Any], str]] = [
    ({"tool_tip_radius": 0.6}, "premachining.tool_tip_radius"),
    ({"tool_tip_radius": 0.0, "tool_addendum": 2.5}, "premachining.tool_addendum"),
    ({"protuberance_angle": 20.0}, "premachining.protuberance_angle"),
    ({"protuberance_angle": 0.5}, "premachining.protuberance_angle"),
    ({"protuberance": 2.2}, "premachining.protuberance"),
    ({"stock": 2.5}, "premachining.stock"),
    ({"stock": 0.2}, "finishing.end_depth"),
    ({"topping": 2.9, "tip_alteration": 0.1}, "tip_alteration"),
    ({"topping": 7.0}, "premachining.topping"),
    ({"semi_topping": SemiTopping(angle=45.0, height=4.0)}, "premachining.semi_topping.height"),
    ({"semi_topping": SemiTopping(angle=79.0, height=0.1)}, "premachining.semi_topping.height"),
    ({"semi_topping": SemiTopping(angle=20.0, height=2.0)}, "premachining.semi_topping.angle"),
    ({"semi_topping": SemiTopping(angle=45.0, height=2.2), "tip_chamfer": 0.3}, "tip_chamfer"),
    ({"finishing": RackFinishing(end_depth=4.0)}, "finishing.end_depth"),
    ({"finishing": RackFinishing(end_depth=4.3)}, "finishing.end_depth"),
    ({"finishing": RackFinishing(end_depth=-3.0)}, "finishing.end_depth"),
    ({"finishing": RackFinishing(end_depth=3.0, wheel_tip_radius=2.5)}, "finishing.wheel_tip_radius"),
    ({**_NOTCH, "finishing": RackFinishing(end_depth=3.0, wheel_tip_radius=0.1)}, "finishing.wheel_tip_radius"),
]


@pytest.mark.parametrize(("changes", "parameter"), _FAULTS, ids=lambda each: str(each)[:50])
def test_a_tool_that_cannot_cut_the_rack_is_refused(changes: dict[str, Any], parameter: str) -> None:
    with pytest.raises(InputError) as caught:
        cut_before(**changes)
    assert caught.value.parameter == parameter
    assert "\n" not in str(caught.value)


_SPEC = """
[pair]
normal_module = 3.0
face_width = 20.0
tooth_thinning = 0.05
[pair.premachining]
tool_addendum = 1.4
tool_tip_radius = 0.3
protuberance = 0.14
protuberance_angle = 8.0
stock = 0.1
stock_tolerance = 0.02
[pinion]
teeth = 25
profile_shift = 0.2
[rack]
teeth = 8
height = 20.0
[load]
torque = 100.0
[material]
"""


def test_a_pair_shares_the_tool_and_data_tells_what_is_left(tmp_path: Path) -> None:
    (tmp_path / "ground.toml").write_text(_SPEC, encoding="utf-8")
    design = read_spec(tmp_path / "ground.toml")
    document = design.to_dict()
    rack, pinion = (document[name]["premachining"] for name in ("rack", "pinion"))
    assert rack["residual_undercut"] == pinion["residual_undercut"] == pytest.approx(0.04)
    assert rack["root_form_depth"] == document["rack"]["form_depth"]
    least, most = rack["least_stock"]["root_form_depth"], rack["most_stock"]["root_form_depth"]
    assert least < rack["root_form_depth"] < most
    assert rack["precut"]["normal_tooth_thickness"] - document["rack"]["normal_tooth_thickness"] == pytest.approx(
        0.2 / math.cos(math.radians(20))
    )
    assert {"rack.step", "pinion.step"} < Build(stage="precut").files(design).keys()  # type: ignore[arg-type]
    plain = Rack(teeth=8, normal_module=3.0, face_width=20.0, height=20.0)
    assert not {"premachining", "finishing"} & plain.to_dict().keys()


@pytest.mark.parametrize(
    ("line", "key"),
    [
        ("premachining.tool_pressure_angle = 17.0", "tool_pressure_angle"),
        ("premachining.cutter_teeth = 25", "cutter_teeth"),
        ("finishing.end_diameter = 70.0", "end_diameter"),
        ("finishing.kind = 'form'", "kind"),
        ("rack.dedendum = 1.25", "rack.dedendum"),
    ],
)
def test_keys_of_gears_are_refused(tmp_path: Path, line: str, key: str) -> None:
    (tmp_path / "wrong.toml").write_text(_SPEC.replace("height =", f"{line}\nheight ="), encoding="utf-8")
    with pytest.raises(SpecError, match=key) as caught:
        read_spec(tmp_path / "wrong.toml")
    assert "\n" not in str(caught.value)


def test_the_residual_undercut_moves_the_section_of_the_rating() -> None:
    """The chord at the 30-degree tangents is that of the arc of the outline."""
    from gearcad.rating.root_section import rack_load_point, rack_section

    rack = cut_before()
    arc = rack.profile.curves[1]
    theta = math.radians(60)
    section = rack_section(rack, rack_load_point(rack, 1.6))
    s = np.linspace(0, 1, 200001)
    place = float(np.interp(theta, arc.direction(s), -arc.points(s)[:, 0]))
    assert section.chord == pytest.approx(2 * place, rel=1e-9)
    sharp = cut_before(**_NOTCH, finishing=RackFinishing(end_depth=3.1, wheel_tip_radius=0.4, notch_depth=1.7))
    with pytest.raises(GeometryError, match="below 2"):
        GrindingNotch.of(sharp)
    pair = RackPair(pinion=Gear(teeth=25, normal_module=3.0, face_width=20.0), rack=rack)
    assert pair.active_root_depth < rack.form_depth
