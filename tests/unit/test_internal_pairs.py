"""Pairs with a ring: what is refused and told with the number that would do, clear tips, poses, specs, pictures."""

import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.batches import faults_of
from support.ring_pairs import RingMesh
from support.specs import TEMPLATES
from support.strategies import permitted_beside

from gearcad import BasicRack, Body, Gear, GearPair, GeometryError, ParameterError
from gearcad.core.errors import SpecError
from gearcad.designs.design import Design
from gearcad.designs.reader import design_from_tables
from gearcad.designs.table import open_table
from gearcad.geometry import ShaperCutter, specific_sliding
from gearcad.geometry.gear_data import twist


def _ring_pair(teeth: tuple[int, int], shifts: tuple[float, float] = (0.0, 0.0), **inputs: Any) -> GearPair:
    """Module 2; `pinion`, `wheel` and `pair` hold inputs of one."""
    own = {key: inputs.pop(key, {}) for key in ("pinion", "wheel", "pair")}
    common = {"normal_module": 2.0, "face_width": 20.0, **inputs}
    pinion = Gear(**{**common, "teeth": teeth[0], "profile_shift": shifts[0], **own["pinion"]})
    ring = Gear(**{**common, "teeth": teeth[1], "profile_shift": shifts[1], **own["wheel"]})
    return GearPair(pinion=pinion, wheel=ring, **own["pair"])


# ---------------------------------------------------------------------- what is refused

SHORT = {"wheel": {"rack": BasicRack(addendum=0.5)}}
REFUSED: list[tuple[dict[str, Any], str, str]] = [
    ({"teeth": (20, -60)}, "wheel.tip_diameter", "involute interference, the tip reaches 0.07492 mm beyond the base tangent"),
    ({"teeth": (30, -38)}, "wheel.tip_diameter", "beside the mesh the tips interfere by 0.02828 mm; or wheel.teeth"),
    ({"teeth": (40, -44), "shifts": (0.3, -0.3)}, "wheel.teeth", "trochoid interference, beside the mesh the tips interfere"),
    ({"teeth": (40, -41)}, "wheel.teeth", "trochoid interference"),
    ({"teeth": (30, -34), **SHORT}, "wheel.teeth", "trochoid interference"),
    ({"teeth": (30, -38), "wheel": {"body": Body(tip_chamfer=0.01)}}, "wheel.tip_diameter", "trochoid interference"),
    ({"teeth": (24, -66), "wheel": {"tip_diameter": -127.0}}, "wheel.tip_diameter", "the tip reaches the pinion's root circle"),
    ({"teeth": (24, -66), "pinion": {"tip_diameter": 53.5}}, "pinion.tip_diameter", "the tip reaches the wheel's root circle"),
    ({"teeth": (24, -66), "pair": {"centre_distance": -43.0}}, "centre_distance", "the backlash would be -"),
    ({"teeth": (24, -66), "pair": {"centre_distance": -39.0}}, "centre_distance", "where the base circles touch"),
    ({"teeth": (24, -66), "wheel": {"helix_angle": 15.0}}, "wheel.helix_angle", "as on the pinion of an internal pair"),
]  # fmt: skip


def _with(inputs: dict[str, Any], parameter: str, value: float) -> GearPair:
    """The pair with one parameter changed."""
    owner, _, name = parameter.rpartition(".")
    if name == "teeth":
        return _ring_pair(**{**inputs, "teeth": (inputs["teeth"][0], round(value))})
    owner = owner or "pair"
    return _ring_pair(**{**inputs, owner: {**inputs.get(owner, {}), name: value}})


@pytest.mark.parametrize(("inputs", "parameter", "text"), REFUSED, ids=[f"{row[1]}-{i}" for i, row in enumerate(REFUSED)])
def test_wrong_pair_states_a_limit_that_is_itself_permitted(inputs: dict[str, Any], parameter: str, text: str) -> None:
    with pytest.raises(GeometryError) as caught:
        _ring_pair(**inputs)
    _with(inputs, parameter, permitted_beside(caught.value, parameter, text))
    if more := re.search(r"or wheel.teeth at most (-\d+)", caught.value.permitted):
        _with(inputs, "wheel.teeth", float(more[1]))
        with pytest.raises(GeometryError):
            _with(inputs, "wheel.teeth", float(more[1]) + 1)


def test_which_gear_is_the_ring() -> None:
    ring = Gear(teeth=-60, normal_module=2.0, face_width=20.0)
    with pytest.raises(GeometryError, match=r"pinion.teeth = -60: must be above 0: of an internal pair the ring is the wheel"):
        GearPair(pinion=ring, wheel=Gear(teeth=20, normal_module=2.0, face_width=20.0))
    with pytest.raises(GeometryError, match=r"wheel.teeth = -60: must be far below -70: the pinion stands inside the ring"):
        GearPair(pinion=Gear(teeth=70, normal_module=2.0, face_width=20.0), wheel=ring)
    with pytest.raises(ParameterError, match=r"centre_distance = 42 mm: .* below 0 mm with a ring \(ISO 21771\): write -42$"):
        _ring_pair((24, -66), pair={"centre_distance": 42.0})


def test_rings_next_to_their_pinions_are_refused_whatever_is_given() -> None:
    """With a centre distance of its own no other number of teeth would do, and no tip leaves contact all along."""
    with pytest.raises(GeometryError, match=r"wheel.teeth = -41: must differ more from the pinion's 40: trochoid interference"):
        _ring_pair((40, -41), pair={"centre_distance": -1.0})


def test_a_ring_with_a_given_tip_diameter_is_not_told_another_number_of_teeth() -> None:
    """50/-65 with given tips goes in along the axis only. One tooth more would be another ring with the same tips, so the tip
    that would do is named; where the tip follows from the teeth, the number of teeth is.
    """
    inputs: dict[str, Any] = {"teeth": (50, -65), "shifts": (0.6, -0.4), "rack": BasicRack(addendum=0.8)}
    given = _only(_ring_pair(**inputs, wheel={"tip_diameter": -129.02}), "radial-assembly")
    assert "with wheel.tip_diameter at most -129.103 mm it goes in either way" in given
    followed = _only(_ring_pair(**inputs, wheel={"tip_alteration": 0.2}), "radial-assembly")
    assert "from wheel.teeth = -6" in followed


# ---------------------------------------------------------------------- what is told


def _only(pair: GearPair, code: str) -> str:
    (text,) = (notice.text for notice in pair.notices if notice.code == code)
    return text


def test_tip_in_the_pinions_fillet_is_told_with_the_one_that_clears_it() -> None:
    """24/-66, x = 0: the standard tip circle is 128 mm, 128.471 mm is needed."""
    pair = _ring_pair((24, -66))
    text = _only(pair, "fillet-interference")
    assert "the wheel's tip reaches diameter 45.1961 mm of the pinion, below its root form circle 45.3518 mm" in text
    assert pair.wheel.tip_diameter == -128.0
    assert pair.clear_tip_diameter == pytest.approx(-128.4710217, abs=1e-6)
    limit = float(re.search(r"wheel.tip_diameter at most (-[\d.]+) mm", text)[1])  # type: ignore[index]
    for tip in (limit, pair.clear_tip_diameter):
        clear = replace(pair, wheel=replace(pair.wheel, tip_diameter=tip))
        assert clear.notices == ()
        assert clear.path_of_contact.A == pytest.approx(clear.usable_path[0], abs=1e-3)
    almost = replace(pair, wheel=replace(pair.wheel, tip_diameter=-128.45))
    assert [notice.code for notice in almost.notices] == ["fillet-interference"]


@pytest.mark.parametrize(
    ("tip", "corner", "words"),
    [(52.8, 0.38, "the pinion's tip reaches diameter -136.1677 mm"), (52.95, 0.25, "the edge of the pinion's tip cuts")],
)
def test_pinions_tip_in_the_rings_fillet_is_told_with_the_one_that_clears_it(tip: float, corner: float, words: str) -> None:
    wheel = {"tip_alteration": -0.3, "cutter": ShaperCutter(tip_radius=corner)}
    pair = _ring_pair((24, -66), pinion={"tip_diameter": tip}, wheel=wheel)
    text = _only(pair, "fillet-interference")
    assert words in text and "outside its root form circle -136." in text
    limit = float(re.search(r"pinion.tip_diameter at most ([\d.]+) mm", text)[1])  # type: ignore[index]
    assert replace(pair, pinion=replace(pair.pinion, tip_diameter=limit)).notices == ()
    almost = replace(pair, pinion=replace(pair.pinion, tip_diameter=limit + 1e-3))
    assert [notice.code for notice in almost.notices] == ["fillet-interference"]


def test_edge_that_cuts_the_fillet_below_the_end_of_contact_draws_the_clear_tip_in() -> None:
    """The ring's flank may end on the form circle, and its edge still cut the fillet further down."""
    pinion, wheel = {"rack": BasicRack(dedendum=1.1, root_radius=0.2)}, {"rack": BasicRack(addendum=1.3)}
    pair = _ring_pair((44, -82), (0.4, 0.3), pinion=pinion, wheel=wheel)
    reach = pair.base_tangent.length - math.sqrt(pair.pinion.form_diameter**2 - pair.pinion.base_diameter**2) / 2
    on_form_circle = -math.hypot(pair.wheel.base_diameter, 2 * reach)
    cut = replace(pair, wheel=replace(pair.wheel, tip_diameter=on_form_circle))
    assert "the edge of the wheel's tip cuts" in _only(cut, "fillet-interference")
    clear = pair.clear_tip_diameter
    assert clear is not None and clear < on_form_circle - 0.01
    codes = [{n.code for n in replace(pair, wheel=replace(pair.wheel, tip_diameter=d)).notices} for d in (clear, clear + 1e-3)]
    assert "fillet-interference" not in codes[0] and "fillet-interference" in codes[1]
    tables = {"pair": {"normal_module": 2.0, "face_width": 20.0}}
    tables["pinion"] = {"teeth": 44, "profile_shift": 0.4, "rack.dedendum": 1.1, "rack.root_radius": 0.2}
    tables["wheel"] = {"teeth": -82, "profile_shift": 0.3, "rack.addendum": 1.3, "tip_alteration": "clear"}
    design = design_from_tables(tables, where=lambda key: "spec", default_name="x")
    assert design.gears["wheel"].tip_diameter == pytest.approx(clear, abs=1e-9)


def test_pinion_that_goes_in_along_the_axis_is_told_with_the_ring_that_takes_it_either_way() -> None:
    pair = _ring_pair((30, -42), (0.3, -0.3), wheel={"tip_alteration": -0.3})
    margins = pair.interference_margins
    assert margins is not None and margins.trochoid > 0 > margins.radial
    text = _only(pair, "radial-assembly")
    assert f"the pinion hits the ring's tips by {-margins.radial:.4g} mm: assemble it along the axis" in text
    teeth = int(re.search(r"from wheel.teeth = (-\d+) on", text)[1])  # type: ignore[index]
    codes = {z: {n.code for n in replace(pair, wheel=replace(pair.wheel, teeth=z)).notices} for z in (teeth, teeth + 1)}
    assert "radial-assembly" not in codes[teeth] and "radial-assembly" in codes[teeth + 1]


def test_pinion_of_a_ring_whose_rim_holds_no_more_teeth_is_told_the_tip_that_would_do() -> None:
    rim = {"wheel": {"tip_alteration": -0.3, "body": Body(rim_diameter=91.0)}}
    pair = _ring_pair((30, -42), (0.3, -0.3), **rim)
    tip = float(re.search(r"with wheel.tip_diameter at most (-[\d.]+) mm", _only(pair, "radial-assembly"))[1])  # type: ignore[index]
    shorter = replace(pair, wheel=replace(pair.wheel, tip_diameter=tip))
    assert not any(notice.code == "radial-assembly" for notice in shorter.notices)


def test_external_pairs_have_no_margins() -> None:
    gear = Gear(teeth=30, normal_module=2.0, face_width=20.0)
    pair = GearPair(pinion=gear, wheel=gear)
    assert pair.interference_margins is None and pair.clear_tip_diameter is None
    assert "interference_margins" not in pair.to_dict()


@pytest.mark.parametrize("teeth", [(10, -2000), (600, -2000), (1900, -2000), (24, -66), (9, -66)])
@pytest.mark.parametrize("module", [0.01, 200.0])
def test_margins_scale_with_the_module_at_the_limits(teeth: tuple[int, int], module: float) -> None:
    shifts = (1.0, -1.2) if teeth[0] < 12 else (0.4, -0.6)
    tips: dict[str, Any] = {"rack": BasicRack(addendum=0.7, root_radius=0.1)}
    one, other = (
        _ring_pair(teeth, shifts, normal_module=m, face_width=10 * m, pinion=tips, wheel=tips).interference_margins
        for m in (1.0, module)
    )
    assert one is not None and other is not None
    assert tuple(other) == pytest.approx(tuple(module * margin for margin in one), rel=1e-9, abs=1e-9 * module)


# ---------------------------------------------------------------------- in mesh


@pytest.mark.parametrize("helix", [0.0, 15.0, -28.0])
@pytest.mark.parametrize(("teeth", "shifts"), [((22, -70), (0.5, -1.2)), ((25, -71), (0.4, -0.6)), ((36, -93), (0.5, 0.1))])
def test_pose_puts_a_tooth_midway_in_a_space_at_every_height(
    teeth: tuple[int, int], shifts: tuple[float, float], helix: float
) -> None:
    pair = _ring_pair(
        teeth, shifts, helix_angle=helix, tooth_thinning=0.04, wheel={"face_width": 17.0}, pair={"axial_offset": 2.5}
    )
    mesh = RingMesh(pair.pinion, pair.wheel, -pair.centre_distance)
    half = pair.circumferential_backlash / 2
    turn = np.array([-1, 1]) / (pair.working_pitch_diameters.pinion / 2)
    for rotation in (0.0, 3.7, -101.0, 222.2):
        pose = pair.wheel_pose(rotation)
        assert (pose.x, pose.z) == (pair.centre_distance, 20 / 2 - 17 / 2 + 2.5)
        z = np.array([pose.z, 9.0, 20.0])[:, None]
        pinion = np.radians(rotation) + twist(pair.pinion) * z
        ring = np.radians(pose.rotation) + twist(pair.wheel) * (z - pose.z)

        def clearance(pinion: Any, ring: Any) -> Any:
            pinion, ring = np.broadcast_arrays(pinion, ring)
            return mesh.standing(pinion.ravel(), ring.ravel(), np.zeros(pinion.size))

        assert clearance(pinion, ring).min() > 0
        assert clearance(pinion + turn * (half - 2e-3), ring).min() > 0
        assert clearance(pinion + turn * (half + 2e-3), ring).max() < 0


def test_picture_of_a_pair_has_the_ring_around_the_pinion() -> None:
    rim = Body(rim_diameter=160.0, bolt_circle=150.0, bolt_holes=6, bolt_diameter=5.0)
    pair = _ring_pair((24, -66), pinion={"body": Body(bore=20.0)}, wheel={"body": rim})
    html = pair._repr_html_()
    (view,) = re.findall(r'viewBox="([^"]+)"', html)
    assert [float(number) for number in view.split()] == [-42 - 80, -80, 160, 160]
    pinion, ring = re.findall(r'<path fill-rule="evenodd"( fill="none")? d="([^"]+)"', html)
    assert pinion[1].count("M") == 2 and ring[1].count("M") == 1 + 1 + 6
    points = np.array([[float(x) for x in point.split(",")] for point in ring[1].split("Z")[0][1:].split()])
    assert np.hypot(points[:, 0] + 42, points[:, 1]).min() == pytest.approx(64, abs=0.1)


# ---------------------------------------------------------------------- specs

TABLES: dict[str, dict[str, Any]] = {
    "pair": {"normal_module": 2.8},
    "pinion": {"teeth": 22, "profile_shift": 0.5, "face_width": 16.0},
    "wheel": {"teeth": -70, "profile_shift": -1.2025, "face_width": 14.0},
}


def _design(**changes: dict[str, Any]) -> Design:
    tables = {owner: {**TABLES[owner], **changes.get(owner, {})} for owner in TABLES}
    return design_from_tables(tables, where=lambda key: "spec", default_name="x")


def _pair(**changes: dict[str, Any]) -> GearPair:
    pair = _design(**changes).assembly  # type: ignore[attr-defined]
    assert isinstance(pair, GearPair)
    return pair


def test_shifts_from_a_centre_distance() -> None:
    """The centre distance of 69 mm of Alm's train asks for x2 = -1.2025 (printed)."""
    pair = _pair(pair={"centre_distance": -69.0}, wheel={"profile_shift": "auto"})
    assert pair.wheel.profile_shift == pytest.approx(-1.2025, abs=5e-5)
    assert pair.circumferential_backlash == pytest.approx(0, abs=1e-12)
    assert (pair.pinion.tip_alteration, pair.wheel.tip_alteration, pair.tip_alteration) == (0.0, 0.0, 0.0)


def test_two_automatic_shifts_have_equal_specific_sliding() -> None:
    automatic = {"profile_shift": "auto"}
    pair = _pair(pair={"centre_distance": -69.0}, pinion=automatic, wheel=automatic | {"body.tip_chamfer": 0.2})
    first, _, _, _, last = pair.path_of_contact
    whole, ratio = pair.base_tangent.length, pair.gear_ratio
    pinion = 1 - (whole - first) / first / ratio
    wheel = 1 - last / (whole - last) * ratio
    assert pinion == pytest.approx(wheel, rel=1e-9)
    sliding = specific_sliding(
        teeth=pair.gears.map(lambda gear: gear.teeth),
        base_radii=pair.gears.map(lambda gear: gear.base_diameter / 2),
        tip_radii=pair.gears.map(lambda gear: gear.tip_form_diameter / 2),
        centre_distance=pair.centre_distance,
    )
    assert sliding == pytest.approx((pinion, wheel), rel=1e-12)


@pytest.mark.parametrize("changes", [{}, {"pair": {"centre_distance": -58.75}}, {"wheel": {"body.tip_chamfer": 0.3}}])
def test_clear_tip_of_a_spec_ends_on_the_pinions_form_circle(changes: dict[str, dict[str, Any]]) -> None:
    teeth = {"pinion": {"teeth": 24, "profile_shift": 0.0}, "wheel": {"teeth": -66, "profile_shift": 0.0}}
    merged = {owner: {**teeth.get(owner, {}), **changes.get(owner, {})} for owner in TABLES}
    assert [notice.code for notice in _pair(**merged).notices] == ["fillet-interference"]
    merged["wheel"]["tip_alteration"] = "clear"
    pair = _pair(**merged)
    assert pair.notices == ()
    assert pair.wheel.tip_diameter == pytest.approx(pair.clear_tip_diameter, abs=1e-9)
    assert pair.interference_margins is not None
    assert pair.interference_margins.pinion_fillet == pytest.approx(0, abs=1e-9)


def test_clear_tip_of_gears_in_inches() -> None:
    tables: dict[str, dict[str, Any]] = {"pair": {"normal_diametral_pitch": 8.0, "face_width": 25.4}, "pinion": {"teeth": 24}}
    tables["wheel"] = {"teeth": -66, "tip_alteration": "clear"}
    design = design_from_tables(tables, where=lambda key: "spec", default_name="x")
    assert design.gears["wheel"].tip_diameter == pytest.approx(-128.4710217264 / 2 * 25.4 / 8, rel=1e-10)


def test_clear_tip_that_clears_already_is_not_lengthened() -> None:
    pair = _pair(wheel={"tip_alteration": "clear"})
    assert pair.wheel.tip_alteration == 0.0
    assert pair.clear_tip_diameter is not None and pair.wheel.tip_diameter < pair.clear_tip_diameter


WRONG: list[tuple[dict[str, dict[str, Any]], str]] = [
    ({"pair": {"centre_distance": 69.0}}, "centre_distance = 69 mm: must be a number below 0 mm with a ring (ISO 21771): wr"),
    ({"pair": {"centre_distance": 0.0}}, "pair.centre_distance = 0 mm: must be a number below 0 mm with a ring (ISO 21771)"),
    ({"wheel": {"teeth": -20}}, "wheel.teeth = -20: must be far below -22: the pinion stands inside the ring"),
    ({"pinion": {"teeth": -70}}, "pinion.teeth = -70: must be above 0: of an internal pair the ring is the wheel"),
    ({"pinion": {"helix_angle": 15.0}, "wheel": {"helix_angle": -15.0}}, "wheel.helix_angle = -15 deg: must be 15 deg, as on"),
    ({"wheel": {"teeth": -26, "profile_shift": -0.5}}, "wheel.teeth = -26: must be at most -30: trochoid interference"),
    ({"pinion": {"tip_alteration": "clear"}}, "pinion.tip_alteration = 'clear': must be a number, or \"auto\""),
    ({"pair": {"tip_alteration": "clear"}}, "pair.tip_alteration = 'clear': must be a number, or \"auto\""),
    ({"wheel": {"teeth": 70, "tip_alteration": "clear"}}, "wheel.tip_alteration = 'clear': must be a number, or \"auto\""),
    ({"wheel": {"tip_alteration": "clear", "tip_diameter": -197.0}}, "wheel.tip_diameter = -197 mm: must be left out"),
    ({"wheel": {"tip_alteration": "cler"}}, "must be a number at least -5 and at most 5, or \"auto\", or of a ring \"clear\""),
    ({"wheel": {"teeth": 70}, "pair": {"centre_distance": -130.0}}, "centre_distance = -130 mm: must be a number above 0 mm"),
]  # fmt: skip


@pytest.mark.parametrize(("changes", "text"), WRONG, ids=range(len(WRONG)))
def test_what_a_newcomer_gets_wrong_is_one_line(changes: dict[str, dict[str, Any]], text: str) -> None:
    with pytest.raises(SpecError) as caught:
        _design(**changes)
    assert text in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_right_hand_pinion_has_a_right_hand_ring() -> None:
    for owner in ("pair", "pinion", "wheel"):
        pair = _pair(**{owner: {"helix_angle": 12.0}})
        assert [gear.helix_angle for gear in pair.gears] == [12.0, 12.0]


# ---------------------------------------------------------------------- tables


def test_table_of_rings_has_no_interference_and_follows_its_words() -> None:
    rows = {row.name: row.design() for row in open_table(TEMPLATES / "rings.csv").rows()}
    pairs = {name: design.assembly for name, design in rows.items()}  # type: ignore[attr-defined]
    assert all(pair.internal and pair.wheel.body.rim_diameter for pair in pairs.values())
    codes = {notice.code for design in rows.values() for notice in design.notices}
    assert not any("interference" in code or "radial" in code or "undercut" in code for code in codes)
    assert pairs["standard-24-66"].wheel.tip_diameter == pytest.approx(-128.4710217, abs=1e-6)
    shared = pairs["equal-sliding-20-56"]
    assert shared.pinion.profile_shift + shared.wheel.profile_shift == pytest.approx(shared.zero_backlash_shift_sum, rel=1e-12)


def test_every_fault_of_a_row_with_a_ring_is_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What is wrong beside an external wheel is not beside a ring: negative centre distances and diameters."""
    monkeypatch.chdir(tmp_path)
    heading = "name,normal_module,centre_distance,pinion.teeth,wheel.teeth,wheel.profile_shift,wheel.tip_diameter,face_width"
    first, second = faults_of(f"{heading}\na,2.8,-69,22,-70,auto,-197.2,-15\nb,2.8,69,22,-70,auto,,15\n")
    assert first.startswith("t.csv row 2 column H (a): pair.face_width = -15 mm: must be a number above 0 mm")
    write = "pair.centre_distance = 69 mm: must be a number below 0 mm with a ring (ISO 21771): write -69"
    assert second == f"t.csv row 3 column C (b): {write}"
