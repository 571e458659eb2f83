"""Shafts on bearings: given cases, closed forms, balance, bearing life, and the load over the face of a mesh on its shafts."""

import json
import math
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.shaft_cases import REFERENCE, mesh_of, shaft_of

from gearcad import check, data
from gearcad.batch.study import plan_study, write_study
from gearcad.core.errors import GeometryError, InputError, ParameterError, SpecError
from gearcad.core.records import PerGear, Role
from gearcad.designs import PairDesign, ShaftDesign, open_table, read_spec
from gearcad.designs.spec_writers import pair_text
from gearcad.jobs.shafts import Shafts
from gearcad.load import Load
from gearcad.shafts.arrangement import BearingLife, ShaftOptions, ShaftResult, bearing_life
from gearcad.shafts.beam import ShaftBearing, ShaftForce, ShaftSegment, SteppedShaft
from gearcad.shafts.bearing_life import (
    ball_deflection,
    basic_life,
    deep_groove_load,
    life_factor,
    life_in_hours,
    one_sided_load,
    opposed_axial_loads,
    reference_viscosity,
)
from gearcad.shafts.bearing_shelf import bearing_of
from gearcad.shafts.strength import Shoulder, shoulder_safeties
from gearcad.shafts.whirl import ShaftDisc, ShaftWhirl, ring_disc

SHAFTS, MESHES = REFERENCE["shafts"], REFERENCE["meshes"]


def flat(document: Any) -> list[float]:
    if isinstance(document, dict):
        return [value for key in sorted(document) for value in flat(document[key])]
    return [value for each in document for value in flat(each)] if isinstance(document, list) else [document]


@pytest.mark.parametrize("case", SHAFTS, ids=lambda case: case["name"])
def test_given_shafts(case: dict[str, Any]) -> None:
    """To 1e-5 of the greatest value of its kind; inclinations are printed to 1e-6 µm/mm."""
    expected = case["expected"]
    found = shaft_of(case["inputs"], [each["position"] for each in expected["stations"]]).solve().to_dict()
    stations = {round(each["position"], 6): each for each in found["stations"]}
    pairs: dict[str, list[tuple[float, float]]] = {"reactions": []}
    for mine, theirs in zip(found["reactions"], expected["reactions"], strict=True):
        pairs["reactions"] += zip(flat(mine), flat(theirs), strict=True)
    for theirs in expected["stations"]:
        mine = stations[round(theirs["position"], 6)]
        for key in ("deflection", "inclination", "twist"):
            pairs.setdefault(key, []).extend(zip(flat([mine[key]]), flat([theirs[key]]), strict=True))
        for side in {"left", "right"} & set(theirs):
            for key, value in theirs[side].items():
                pairs.setdefault(key, []).extend(zip(flat([mine[side][key]]), flat([value]), strict=True))
    for key, values in pairs.items():
        greatest = max(abs(theirs) for _, theirs in values)
        worst = max(abs(mine - theirs) for mine, theirs in values)
        assert worst <= max(1e-5 * greatest, 1e-6), key
    assert found["coupling_torque"] == pytest.approx(expected["coupling_torque"], abs=1e-4)


def beam(length: float = 400.0, position: float = 150.0, force: float = 1000.0) -> tuple[SteppedShaft, ShaftSegment]:
    part = ShaftSegment(length=length, outer_diameter=40.0)
    rigid = (ShaftBearing(position=0.0, axial_stiffness="rigid"), ShaftBearing(position=length))
    return SteppedShaft(
        segments=(part,), bearings=rigid, forces=(ShaftForce(position=position, force=(0.0, -force, 0.0)),)
    ), part


def test_a_force_between_two_supports_by_the_closed_form() -> None:
    """w = F a^2 b^2/(3 E I l) + F a b/(l kappa G A), slope F a b (b - a)/(3 E I l) under the force."""
    length, a, force = 400.0, 150.0, 1000.0
    shaft, part = beam(length, a, force)
    b, bending = length - a, part.youngs_modulus * part.second_moment
    at = shaft.solve().at(a)
    shear = part.shear_coefficient * part.shear_modulus * part.area
    assert at[1] == pytest.approx(-(force * a**2 * b**2 / (3 * bending * length) + force * a * b / (length * shear)), rel=1e-9)
    assert -at[3] == pytest.approx(-force * a * b * (b - a) / (3 * bending * length), rel=1e-9)
    assert part.shear_coefficient == pytest.approx(6 * 1.3 / (7 + 6 * 0.3), rel=1e-12)  # solid: 0.886


def test_weight_bends_a_beam_as_a_line_load() -> None:
    """5 q l^4/(384 E I) + q l^2/(8 kappa G A) in the middle, exact at a node whatever the elements."""
    shaft, part = beam(force=0.0)
    heavy = replace(shaft, gravity=(0.0, -9.80665, 0.0), places=(200.0, 77.0))
    line = part.density * 1e-9 * part.area * 9.80665
    bending = part.youngs_modulus * part.second_moment
    shear = part.shear_coefficient * part.shear_modulus * part.area
    expected = 5 * line * 400**4 / (384 * bending) + line * 400**2 / (8 * shear)
    assert heavy.solve().at(200.0)[1] == pytest.approx(-expected, rel=1e-9)


def test_the_first_critical_speed_of_a_slender_beam() -> None:
    """omega = pi^2 sqrt(E I/(rho A))/l^2; shear and rotary inertia take 0.4 % of it here."""
    part = ShaftSegment(length=1000.0, outer_diameter=30.0)
    rigid = (ShaftBearing(position=0.0, axial_stiffness="rigid"), ShaftBearing(position=1000.0))
    shaft = SteppedShaft(segments=(part,), bearings=rigid, places=tuple(np.linspace(0.0, 1000.0, 101)))
    slender = math.pi**2 * math.sqrt(part.youngs_modulus * part.second_moment / (part.density * 1e-12 * part.area)) / 1e6
    assert ShaftWhirl(shaft).critical_speeds(1)[0] == pytest.approx(30 / math.pi * slender, rel=5e-3)


ROSS = json.loads((Path(__file__).parents[1] / "data" / "ross_shafts.json").read_text(encoding="utf-8"))["cases"]


@pytest.mark.parametrize("case", ROSS, ids=lambda case: f"{len(case['bearings'])} bearings, {len(case['discs'])} discs")
def test_shafts_bend_and_whirl_as_in_ross(case: dict[str, Any]) -> None:
    """To 1e-6, on the same nodes; their positions are rounded to 1e-6 mm there."""
    steps = np.cumsum([0.0, *(each["length"] for each in case["segments"])])
    shaft = SteppedShaft(
        segments=tuple(ShaftSegment(**each) for each in case["segments"]),
        bearings=tuple(ShaftBearing(**each, axial_stiffness="rigid") for each in case["bearings"]),
        forces=tuple(ShaftForce(position=each["position"], force=tuple(each["force"])) for each in case["forces"]),
        places=tuple(place for place in case["nodes"] if np.abs(steps - place).min() > 1e-5),
    )
    moved, expected = 1000 * shaft.solve().moved.reshape(-1, 6)[:, :2], np.array(case["deflection"])
    assert np.abs(moved - expected).max() < 1e-6 * np.abs(expected).max()
    whirl = ShaftWhirl(shaft, tuple(ShaftDisc(**each) for each in case["discs"]))
    assert whirl.frequencies()["forward"] == pytest.approx(case["rest"], rel=1e-6)
    turning = whirl.frequencies(case["speed"])
    assert turning["forward"] == pytest.approx(case["forward"], rel=1e-6)
    assert turning["backward"] == pytest.approx(case["backward"], rel=1e-6)


def test_critical_speeds_of_a_thick_bar_by_the_closed_form() -> None:
    """Half waves of Timoshenko's beam: (kappa G A k^2 - rho A w^2)(E I k^2 + kappa G A - s rho I w^2) = (kappa G A k)^2.

    s = 1 at rest, -1 where the whirl turns with the shaft as fast as this, 3 where it turns against it.
    """
    part = ShaftSegment(length=600.0, outer_diameter=90.0)
    rigid = (ShaftBearing(position=0.0, axial_stiffness="rigid"), ShaftBearing(position=600.0))
    whirl = ShaftWhirl.of(SteppedShaft(segments=(part,), bearings=rigid))
    shear, bending = part.shear_coefficient * part.shear_modulus * part.area, part.youngs_modulus * part.second_moment
    line, turning = part.density * 1e-12 * part.area, part.density * 1e-12 * part.second_moment

    def speed(waves: int, sense: float) -> float:
        k = waves * math.pi / 600.0
        square = sense * line * turning
        linear = -(shear * k**2 * sense * turning + line * (bending * k**2 + shear))
        roots = np.roots([square, linear, shear * k**2 * bending * k**2])
        return 30 / math.pi * math.sqrt(min(each for each in roots.real.tolist() if each > 0))

    expected = {sense: [speed(waves, sense) for waves in (1, 2, 3)] for sense in (1.0, -1.0, 3.0)}
    forward, backward = whirl.critical_speeds(), whirl.critical_speeds(forward=False)
    assert forward == pytest.approx(expected[-1.0], rel=6e-4) and forward[0] == pytest.approx(expected[-1.0][0], rel=1e-5)
    assert backward == pytest.approx(expected[3.0], rel=6e-4)
    assert [60 * each for each in whirl.frequencies()["forward"]] == pytest.approx(expected[1.0], rel=6e-4)
    assert 60 * whirl.frequencies(forward[0], 1)["forward"][0] == pytest.approx(forward[0], rel=1e-9)
    finer = ShaftWhirl(replace(whirl.shaft, places=tuple(np.linspace(0, 600, 97).tolist()))).critical_speeds()
    limit = [(4 * fine - coarse) / 3 for fine, coarse in zip(finer, forward, strict=True)]  # the error falls with the square
    assert limit == pytest.approx(expected[-1.0], rel=1e-6)


def test_the_disc_of_a_ring() -> None:
    found = ring_disc(5.0, outer_diameter=100.0, inner_diameter=40.0, width=20.0, density=7850.0)
    assert found is not None
    assert found.mass == pytest.approx(7850 * math.pi / 4 * (0.1**2 - 0.04**2) * 0.02)
    assert found.polar_inertia == pytest.approx(found.mass * (0.05**2 + 0.02**2) / 2)
    assert found.transverse_inertia == pytest.approx(found.mass * (3 * (0.05**2 + 0.02**2) + 0.02**2) / 12)
    assert ring_disc(5.0, outer_diameter=40.0, inner_diameter=40.0, width=20.0, density=7850.0) is None


def test_reactions_balance_forces_and_weight_and_energy_is_half_the_work() -> None:
    for case in SHAFTS:
        shaft = shaft_of(case["inputs"])
        state = shaft.solve()
        forces = sum((each.load() for each in shaft.forces), np.zeros(6))[:3]
        weight = math.fsum(
            part.density * 1e-9 * part.area * length for part, length in zip(shaft.parts, np.diff(shaft.nodes), strict=True)
        )
        total = forces + weight * np.array(shaft.gravity) + sum(each[:3] for each in state.reactions)
        assert np.abs(total).max() < 1e-9 * max(np.abs(forces).max(), 1.0)
        energy = state.moved @ np.linalg.pinv(shaft.compliance) @ state.moved / 2
        assert energy == pytest.approx(shaft.loads @ state.moved / 2, rel=1e-8)
        assert np.abs(shaft.compliance - shaft.compliance.T).max() < 1e-12 * np.abs(shaft.compliance).max()


def test_loose_shafts_and_places_beside_them_are_refused() -> None:
    shaft, _ = beam()
    one = shaft.bearings[0]
    with pytest.raises(GeometryError, match="must hold the shaft"):
        replace(shaft, bearings=(one,)).solve()
    with pytest.raises(GeometryError, match="must hold the shaft"):
        replace(shaft, bearings=(replace(one, axial_stiffness=0.0), shaft.bearings[1])).solve()
    with pytest.raises(GeometryError, match="from 0 to 400 mm"):
        replace(shaft, bearings=(one, ShaftBearing(position=401.0)))
    with pytest.raises(InputError, match="at least 0 mm"):
        ShaftForce(position=-1.0)
    with pytest.raises(GeometryError, match="must be below 20 mm"):
        ShaftSegment(length=1.0, outer_diameter=20.0, inner_diameter=20.0)


# ---------------------------------------------------------------------- life of bearings


@pytest.mark.parametrize("row", REFERENCE["bearing_life"], ids=lambda row: row["name"])
def test_given_lives(row: dict[str, Any]) -> None:
    expected, tolerance = row["expected"], row["tolerance"] if isinstance(row["tolerance"], float) else 5e-3
    if "X" in row:
        radial = row["X"] * row["F_r"] + row["Y"] * row["F_a"]
        load = max(radial, row["F_r"])
    else:
        load = deep_groove_load(row["F_r"], row["F_a"], f0=row.get("f0", 13.0), static_rating=row.get("C0", 30000.0)).load
    if "P" in expected:
        assert load == pytest.approx(expected["P"], rel=max(tolerance, 2e-3))
    if "C_required" in expected:
        required = load * (row["life"] * 60 * row["speed"] / 1e6) ** (1 / 3)
        assert required == pytest.approx(expected["C_required"], rel=tolerance)
    if "L10" in expected:
        assert basic_life(row["C"], load, ball=True) == pytest.approx(expected["L10"], rel=tolerance)
    if "L10h" in expected:
        hours = life_in_hours(basic_life(row["C"], load, ball=True), row["speed"])
        assert hours == pytest.approx(expected["L10h"], rel=max(tolerance, 3e-3))


def test_given_factors_of_lives() -> None:
    for row in REFERENCE["life_modification"]:
        found = life_factor(row["kappa"], row["e_C_C_u_over_P"], ball=row["kind"] == "ball")
        assert found == pytest.approx(row["a_ISO"], rel=1e-7), row
    for row in REFERENCE["reference_viscosity"]:
        assert reference_viscosity(row["speed"], row["pitch_diameter"]) == pytest.approx(row["nu_1"], rel=1e-7), row
    for row in REFERENCE["deep_groove"]:
        found_load = deep_groove_load(row["F_r"], row["F_a"], f0=row["f0"], static_rating=row["C0"])
        assert found_load == pytest.approx((row["P"], row["e"], row["Y"]), rel=1e-7), row
    (row,) = REFERENCE["ball_bearing_deflection"]
    deflection = 1000 * ball_deflection(row["radial_force"], balls=row["balls"], ball_diameter=row["ball_diameter"])
    assert deflection == pytest.approx(row["deflection"], rel=0.03)


def test_opposed_bearings_share_thrust_in_balance() -> None:
    """The difference of both axial loads is the outer thrust, and neither is below its own."""
    for outer in (-3000.0, 0.0, 500.0, 4000.0):
        a, b = opposed_axial_loads((2000.0, 5000.0), (1.6, 1.8), outer)
        assert a - b == pytest.approx(outer)
        assert a >= 2000 / 3.2 and b >= 5000 / 3.6


def test_a_life_says_what_it_lacks() -> None:
    bearing = ShaftBearing(position=0.0, name="A", kind="deep groove", C=55300.0, C0=31500.0, f0=13.0)
    made = bearing_life(bearing, 4000.0, 500.0, 1800.0, ShaftOptions())
    assert made.hours == pytest.approx(24500, rel=5e-3)
    assert made.modified_hours is None and "viscosity" in made.reasons[0]
    full = ShaftOptions(viscosity=20.0, contamination_factor=0.5, life_reliability=99.0)
    known = bearing_life(replace(bearing, pitch_diameter=72.5), 4000.0, 500.0, 1800.0, full)
    factor = life_factor(20.0 / reference_viscosity(1800.0, 72.5), 0.5 * 31500 / 22 / 4000, ball=True)
    assert known.modified_hours == pytest.approx(0.25 * factor * made.hours)
    assert "kind and C" in bearing_life(ShaftBearing(position=0.0), 1.0, 0.0, 1.0, full).reasons[0]
    assert "e and Y" in bearing_life(replace(bearing, kind="tapered"), 1.0, 0.0, 1.0, full).reasons[0]


def tapered_shaft(sides: tuple[str, str], thrust: float) -> ShaftResult:
    """1000 N in the middle between two tapered bearings with Y = 1.6, and a thrust towards larger z."""
    bearing = ShaftBearing(position=0.0, kind="tapered", C=50000.0, e=0.37, Y=1.6, axial_stiffness=100.0, pushes=sides[0])
    other = replace(bearing, position=200.0, pushes=sides[1])
    shaft = SteppedShaft(
        segments=(ShaftSegment(length=200.0, outer_diameter=40.0),),
        bearings=(bearing, other),
        forces=(ShaftForce(position=100.0, force=(0.0, -1000.0, thrust)),),
    )
    return ShaftResult(shaft.solve(), 1000.0, ShaftOptions())


def test_two_tapered_bearings_push_against_each_other() -> None:
    """Each makes 500/(2 1.6) = 156.25 N; that which pushes against the thrust takes both."""
    for sides, thrust, expected in (
        (("right", "left"), 400.0, (156.25, 556.25)),
        (("left", "right"), 400.0, (556.25, 156.25)),
        (("right", "left"), -400.0, (556.25, 156.25)),
        (("right", "left"), 0.0, (156.25, 156.25)),
    ):
        lives = tapered_shaft(sides, thrust).lives
        assert [each.axial for each in lives] == pytest.approx(expected)
        for life, axial in zip(lives, expected, strict=True):
            load = 500.0 if axial / 500 <= 0.37 else 0.4 * 500 + 1.6 * axial
            assert life.equivalent is not None and life.equivalent.load == pytest.approx(load)
            assert life.hours == pytest.approx((50000 / load) ** (10 / 3) * 1e6 / 60000)
    assert "nothing holds it" in tapered_shaft(("left", "left"), 400.0).lives[0].reasons[0]


def test_angular_contact_bearings_have_the_factor_of_their_limit() -> None:
    found = one_sided_load("angular contact", 1000.0, 2000.0, limit=1.14, factor=0.57)
    assert found.load == pytest.approx(0.35 * 1000 + 0.57 * 2000)


def test_lives_over_a_spectrum_by_miner(tmp_path: Path) -> None:
    """Loads in proportion to the torque: half of the time under twice of it leaves 1/(0.5 + 0.5 8) of the life of balls."""
    own = 'axial_stiffness = "rigid"\nkind = "deep groove"\nC = 30000.0'
    force = "[[pinion.force]]\nposition = 150.0\nforce = [0.0, -300.0, 0.0]\n"
    assert force in PAIR
    text = PAIR.replace('axial_stiffness = "rigid"', own).replace(force, "").replace("offset = [1.0, 0]\n", "")
    text += "[load]\ntorque = 50.0\nspeed = 600.0\n[rating]\n"

    def life(rating: str) -> BearingLife:
        design = pair_design(tmp_path, f"{text}face_mesh_stiffness = 15.0\n{rating}")
        return Shafts().run(design).shafts["pinion"].lives[0]

    one, plain = life(""), life("spectrum = [[0.4, 1.0], [0.6, 1.0]]")
    assert one.hours is not None and plain.hours == pytest.approx(one.hours, rel=1e-9)
    assert plain.revolutions == pytest.approx(one.revolutions, rel=1e-9)
    two = life("spectrum = [[0.5, 1.0], [0.5, 2.0]]")
    assert two.hours == pytest.approx(one.hours / 4.5, rel=1e-6)
    assert one.equivalent is not None and two.equivalent is not None
    assert two.equivalent.load == pytest.approx(one.equivalent.load * 4.5 ** (1 / 3), rel=1e-6)
    fast = life("spectrum = [[0.75, 0.0], [0.25, 1.0, 2.0]]")
    assert fast.hours == pytest.approx(one.hours / (0.25 * 2), rel=1e-6)


# ---------------------------------------------------------------------- the mesh


@pytest.mark.parametrize("case", MESHES, ids=lambda case: case["name"])
def test_given_meshes(case: dict[str, Any]) -> None:
    expected, mesh = case["expected"], mesh_of(case["inputs"])
    found = mesh.to_dict()
    for key in ("F_bt", "mean_line_load", "f_sh", "K_Hbeta_slices", "approach"):
        assert found[key] == pytest.approx(expected[key], rel=1e-6), key
    assert found["K_Hbeta_end_of_face"] == pytest.approx(expected["K_Hbeta_end_of_face"], rel=2e-3)
    assert found["line_load"] == pytest.approx(expected["line_load"], rel=1e-5, abs=1e-3)
    for name, gap in expected["gap_at_even_load_at_slices"].items():
        assert found["gap_at_even_load_at_slices"][name] == pytest.approx(gap, rel=1e-5, abs=1e-4), name
    for role, reactions in expected["reactions"].items():
        state = mesh.state(Role(role))
        assert state is not None
        for mine, theirs in zip(state.to_dict()["reactions"], reactions, strict=True):
            assert mine["force"] == pytest.approx(theirs["force"], rel=1e-5, abs=1e-2)


def test_rigid_shafts_give_the_closed_form_of_method_c() -> None:
    """1 + F c/(2 w) while the whole face carries, and sqrt(2 F c/w) where part of it does (ISO 6336-1, Method C)."""
    inputs = MESHES[0]["inputs"]
    rigid = {"shafts": PerGear(None, None), "slices": 400}
    for slope in (5.0, 60.0):
        mesh = mesh_of(inputs, misalignment=slope, **rigid)
        ratio = slope * inputs["stiffness"] / mesh.mean_load
        closed = 1 + ratio / 2 if ratio <= 2 else math.sqrt(2 * ratio)
        assert mesh.face_load_factor == pytest.approx(closed, rel=3e-3)


def test_load_and_stiffness_doubled_give_the_same_factor_and_so_does_a_turned_mesh() -> None:
    inputs = MESHES[0]["inputs"]
    one = mesh_of(inputs)
    assert mesh_of(inputs, mesh_angle=73.0).face_load_factor == pytest.approx(one.face_load_factor, rel=1e-12)
    assert mesh_of(inputs, torque=-inputs["torque"]).face_load_factor == pytest.approx(one.face_load_factor, rel=1e-12)
    assert mesh_of(inputs, torque=2 * inputs["torque"]).face_load_factor == pytest.approx(one.face_load_factor, rel=1e-9)
    for matrix in one.influence:
        assert np.abs(matrix - matrix.T).max() < 1e-12 * np.abs(matrix).max()


# ---------------------------------------------------------------------- specs

ALONE = """
[shafts]
speed = 1800.0
[[shaft]]
length = 200.0
outer_diameter = 30
[[bearing]]
name = "left"
position = 10.0
axial_stiffness = "rigid"
kind = "deep groove"
C = 29100
C0 = 17900
f0 = 14
[[bearing]]
position = 190.0
[[force]]
position = 100.0
force = [0.0, -2000.0, 300.0]
"""


def test_a_shaft_by_itself_is_read_and_told(tmp_path: Path) -> None:
    spec = tmp_path / "alone.toml"
    spec.write_text(ALONE, encoding="utf-8")
    document = Shafts().complete_document(Shafts().run(read_spec(spec)))
    (shaft,) = document["shafts"].values()
    assert [each["name"] for each in shaft["bearings"]] == ["left", "bearing 2"]
    assert shaft["reactions"][0]["force"] == pytest.approx([0.0, 1000.0, -300.0])
    assert shaft["bearings"][0]["L10"] == pytest.approx(
        (29100 / deep_groove_load(1000.0, 300.0, f0=14.0, static_rating=17900.0).load) ** 3
    )
    assert any("bearing 2: life: kind and C are not given" in each for each in document["not_judged"])
    assert len(shaft["stations"]) > 90 and document["warnings"]


@pytest.mark.parametrize(
    "change, words",
    [
        (("length = 200.0", "length = -1.0"), "line 5: shaft[0].length = -1 mm: must be"),
        (("position = 190.0", "position = 290.0"), "line 16: bearing[1].position = 290 mm: must be from 0 to 200 mm"),
        (("position = 190.0", "posiion = 190.0"), "bearing[1].posiion: unknown key"),
        (("position = 190.0", ""), "bearing[1].position is missing"),
        (('kind = "deep groove"', 'kind = "ball"'), "bearing[0].kind = 'ball': must be \"deep groove\""),
        (('axial_stiffness = "rigid"', ""), "must hold the shaft"),
        (("[shafts]", "[load]\ntorque = 1.0\n[shafts]"), "cannot stand beside [[shaft]]"),
        (("speed = 1800.0", "life_reliability = 93.0"), "must be one of 90, 95, 96, 97, 98, 99 %"),
    ],
)
def test_faults_of_specs_are_one_line(tmp_path: Path, change: tuple[str, str], words: str) -> None:
    spec = tmp_path / "alone.toml"
    spec.write_text(ALONE.replace(*change), encoding="utf-8")
    with pytest.raises(SpecError) as caught:
        read_spec(spec)
    assert words in str(caught.value) and "\n" not in str(caught.value)


PAIR = """
[pair]
normal_module = 2.5
face_width = 35.0
[pinion]
teeth = 21
mesh_position = 80.0
coupling = 150.0
[[pinion.shaft]]
length = 150
outer_diameter = 40.0
[[pinion.bearing]]
name = "left"
position = 20.0
axial_stiffness = "rigid"
offset = [1.0, 0]
[[pinion.bearing]]
position = 130.0
radial_stiffness = 200.0
[[pinion.force]]
position = 150.0
force = [0.0, -300.0, 0.0]
[wheel]
teeth = 40
[shafts]
mesh_angle = 90.0
"""


def pair_design(tmp_path: Path, text: str = PAIR) -> PairDesign:
    spec = tmp_path / "pair.toml"
    spec.write_text(text, encoding="utf-8")
    design = read_spec(spec)
    assert isinstance(design, PairDesign)
    return design


def test_the_shafts_of_a_pair_are_part_of_its_design_and_are_written_back(tmp_path: Path) -> None:
    design = pair_design(tmp_path)
    assert design.arrangement is not None and design.arrangement.mesh is None
    assert design.arrangement.positions == {"pinion": 80.0} and design.arrangement.shafts["pinion"].coupling == 150.0
    again = pair_design(tmp_path, pair_text(design))
    assert again.shafts == design.shafts and again == design
    loaded = replace(design, load=Load(torque=50.0, speed=600.0))
    assert loaded.arrangement is not None and loaded.arrangement.mesh is not None
    assert loaded.arrangement.mesh.torque == 50.0 and loaded.arrangement.speeds == {"pinion": 600.0}
    assert loaded.arrangement is loaded.arrangement
    unloaded = replace(design, load=Load(torque=0.0, speed=600.0))
    assert unloaded.arrangement is not None and unloaded.arrangement.mesh is None
    assert replace(design, shafts=None).arrangement is None


@pytest.mark.parametrize(
    "change, words",
    [
        (("outer_diameter", "diameter"), "line 11: pinion.shaft[0].diameter: unknown key"),
        (("radial_stiffness = 200.0", "stiffness = 200.0"), "line 19: pinion.bearing[1].stiffness: unknown key"),
        (("mesh_angle", "angle"), "shafts.angle: unknown key"),
        (("mesh_position = 80.0\n", ""), "pinion.mesh_position is missing"),
        (("mesh_position = 80.0", "mesh_position = 140.0"), "pinion.mesh_position = 140 mm: must be from 17.5 to 132.5 mm"),
        (("position = 130.0", "position = 151.0"), "pinion.bearing[1].position = 151 mm: must be from 0 to 150 mm"),
        (
            ("teeth = 40", "teeth = 40\nmesh_position = 3.0"),
            "wheel.mesh_position: needs the shaft: segments headed [[",
        ),
        (("coupling = 150.0", 'coupling = "left"'), "pinion.coupling = 'left': must be a number, in mm"),
        (('axial_stiffness = "rigid"\n', ""), "pinion.bearing = 2: must hold the shaft"),
        (("teeth = 40", "teeth = -80"), "the load over the face of a ring on shafts is not modelled"),
        (("mesh_angle", "gravity = [0.0, -9.8]\nmesh_angle"), "shafts.gravity = [0.0, -9.8]: must be a list of 3 numbers"),
        (("position = 130.0", "position = 130.0\noffset = 3.0"), "pinion.bearing[1].offset = 3: must be a list of 2 numbers"),
        (
            ("[[pinion.bearing]]", "[[pinion.force]]\nposition = 9.0\nforce = [1.0, nan, 0.0]\n[[pinion.bearing]]"),
            "pinion.force[0].force = [1.0, nan, 0.0]: must be a list of 3 numbers",
        ),
    ],
)
def test_faults_of_shafts_are_told_by_every_command(tmp_path: Path, change: tuple[str, str], words: str) -> None:
    with pytest.raises(SpecError) as caught:
        pair_design(tmp_path, PAIR.replace(*change))
    assert words in str(caught.value) and "\n" not in str(caught.value)


def test_the_report_has_a_picture_of_each_shaft_and_the_lives(tmp_path: Path) -> None:
    design = replace(pair_design(tmp_path), load=Load(torque=50.0, speed=600.0))
    result = Shafts().run(design)
    Shafts(head={"company": "Works"}).write(result, tmp_path / "out")
    text = (tmp_path / "out" / "shafts.html").read_text(encoding="utf-8")
    assert text.count("data:image/svg+xml") == 3 and "Works" in text  # one shaft, load and gap over the face
    document = json.loads((tmp_path / "out" / "shafts.json").read_text(encoding="utf-8"))
    state, stations = result.shafts["pinion"], document["shafts"]["pinion"]["stations"]
    greatest = max(math.hypot(*each["deflection"][:2]) for each in stations)
    assert state.greatest_deflection[0] == pytest.approx(greatest, rel=1e-12)
    sides = [each[side]["equivalent_stress"] for each in stations for side in ("left", "right") if side in each]
    assert state.greatest_stress[0] == pytest.approx(max(sides), rel=1e-12)
    assert "No life of a bearing is judged" in text and "life: kind and C are not given" in text


def test_options_of_shafts_need_a_shaft(tmp_path: Path) -> None:
    text = "[pair]\nnormal_module = 2\nface_width = 20\n[pinion]\nteeth = 20\n[wheel]\nteeth = 30\n[shafts]\nslices = 10\n"
    with pytest.raises(SpecError, match=r"line 8: \[shafts\]: needs a shaft: segments headed \[\[pinion.shaft\]\]"):
        pair_design(tmp_path, text)


def test_a_shaft_by_itself_has_data_and_other_commands_say_what_it_is_for(tmp_path: Path) -> None:
    """A hollow bar: mass, and moments of inertia m(D^2 + d^2)/8 and m((D^2 + d^2)/16 + l^2/12)."""
    spec = tmp_path / "bar.toml"
    spec.write_text(ALONE.replace("outer_diameter = 30", "outer_diameter = 30\ninner_diameter = 10"), encoding="utf-8")
    found = data(read_spec(spec))["shaft"]
    mass = 7850 * math.pi / 4 * (0.03**2 - 0.01**2) * 0.2
    assert found["mass"] == pytest.approx(mass, rel=1e-12)
    assert found["polar_inertia"] == pytest.approx(mass * (0.03**2 + 0.01**2) / 8, rel=1e-12)
    assert found["transverse_inertia"] == pytest.approx(mass * ((0.03**2 + 0.01**2) / 16 + 0.2**2 / 12), rel=1e-12)
    modulus = 206e9 / 2.6
    assert found["torsional_stiffness"] == pytest.approx(modulus * math.pi / 32 * (0.03**4 - 0.01**4) / 0.2, rel=1e-12)
    permitted = "must be a pair or a rack and pinion: a shaft by itself is for `gearcad data`"
    with pytest.raises(ParameterError, match=f"kind = 'shaft': {permitted}"):
        check(read_spec(spec))


def test_a_table_varies_the_keys_of_shafts(tmp_path: Path) -> None:
    spec, table = tmp_path / "pair.toml", tmp_path / "table.csv"
    spec.write_text(PAIR, encoding="utf-8")
    study = plan_study(spec, ["pinion.shaft[0].outer_diameter=30,40", "shafts.mesh_angle=0,90"])
    write_study(study, table)
    rows = list(open_table(table).rows())
    designs = [row.design() for row in rows]
    found = [each.shafts for each in designs if isinstance(each, PairDesign) and each.shafts is not None]
    given = pair_design(tmp_path).shafts
    assert given is not None and len(found) == 4 and found[3] == given
    assert [each.gears.pinion.shaft.segments[0].outer_diameter for each in found if each.gears.pinion] == [30, 30, 40, 40]
    assert [each.options.mesh_angle for each in found] == [0, 90, 0, 90]
    for text, words in (
        ("pinion.shaft[0].lenght=1,2", "permitted behind pinion.shaft[0]. are length"),
        ("shaft[0].length=1,2", "pair"),
    ):
        with pytest.raises(ParameterError, match=re.escape(words)):
            plan_study(spec, [text])


def test_a_table_of_shafts_by_themselves(tmp_path: Path) -> None:
    table = tmp_path / "table.csv"
    head = "name,shaft[0].length,shaft[0].outer_diameter,bearing[0].position,bearing[0].axial_stiffness,bearing[1].position"
    table.write_text(f"{head}\none,100,20,0,rigid,100\ntwo,100,20,0,rigid,101\nthree,100,20,0,rigid,\n", encoding="utf-8")
    one, two, three = open_table(table).rows()
    assert isinstance(design := one.design(), ShaftDesign) and design.shaft.bearings[1].position == 100.0
    assert two.all_faults() == [
        f"{table} row 3 column F (two): bearing[1].position = 101 mm: must be from 0 to 100 mm, on the shaft"
    ]
    assert "must hold the shaft" in three.all_faults()[0]
    table.write_text("name,shaft[0].length,shaft[0].width\none,1,2\n", encoding="utf-8")
    with pytest.raises(SpecError, match=r"column C: shaft\[0\].width: unknown key; permitted behind shaft\[0\]. are length"):
        open_table(table)


def test_a_bearing_of_the_shelf_fills_what_the_spec_leaves_open(tmp_path: Path) -> None:
    """The table of the design's folder counts before that of gearcad, and the spec before both."""
    named = ALONE.replace('name = "left"', 'name = "6206"').replace(
        'kind = "deep groove"\nC = 29100\nC0 = 17900\nf0 = 14\n', ""
    )
    spec = tmp_path / "alone.toml"
    spec.write_text(named, encoding="utf-8")

    def bearing() -> ShaftBearing:
        design = read_spec(spec)
        assert isinstance(design, ShaftDesign)
        return design.shaft.bearings[0]

    own = bearing()
    assert (own.kind, own.d, own.D, own.B, own.pitch_diameter, own.C) == ("deep groove", 30.0, 62.0, 16.0, 46.0, None)
    assert any("C are not given" in each for each in Shafts().run(read_spec(spec)).not_judged)
    shelf = tmp_path / "bearings.csv"
    shelf.write_text("name;kind;C;C0;f0\n6206;deep groove;20300;11200;13,8\n", encoding="utf-8")
    own = bearing()
    assert (own.C, own.C0, own.f0, own.D) == (20300.0, 11200.0, 13.8, None)
    spec.write_text(named.replace("[[bearing]]", "[[bearing]]\nC = 1000.0", 1), encoding="utf-8")
    assert bearing().C == 1000.0
    table = tmp_path / "table.csv"
    head = "name,shaft[0].length,shaft[0].outer_diameter,bearing[0].position,bearing[0].axial_stiffness,bearing[1].position"
    table.write_text(f"{head},bearing[0].name\none,100,30,0,rigid,100,6206\n", encoding="utf-8")
    (row,) = open_table(table).rows()
    design = row.design()
    assert isinstance(design, ShaftDesign) and design.shaft.bearings[0].C == 20300.0
    before = row.inputs
    shelf.write_text("name,kind,C\n6206,deep groove,20400\n", encoding="utf-8")
    assert row.inputs != before


@pytest.mark.parametrize(
    "text, words",
    [
        ("name,kind,Dm\n6206,deep groove,3\n", "bearings.csv row 1 column C: Dm: unknown column; did you mean"),
        ("name,kind\n6206,ball\n", "bearings.csv row 2 column B (6206): kind = 'ball': must be"),
        ("name,C\n6206,-3\n", "bearings.csv row 2 column B (6206): C = -3 N: must be"),
        ("name,C\n6206,30\n6206,31\n", "bearings.csv row 3 (6206): is there twice; keep one of them"),
        ("kind,C\ndeep groove,30\n", "bearings.csv row 1: has no column name; must have name"),
    ],
)
def test_faults_of_a_table_of_bearings_are_one_line(tmp_path: Path, text: str, words: str) -> None:
    (tmp_path / "bearings.csv").write_text(text, encoding="utf-8")
    spec = tmp_path / "alone.toml"
    spec.write_text(ALONE.replace('name = "left"', 'name = "6206"'), encoding="utf-8")
    with pytest.raises(SpecError) as caught:
        read_spec(spec)
    assert words in str(caught.value) and "\n" not in str(caught.value)


def test_sizes_of_the_own_shelf_are_those_of_a_public_table() -> None:
    """BOSL2 (BelfrySCAD), ball_bearings.scad: some that both have; from 04 on the number is a fifth of the bore."""
    public = {
        "6000": (10, 26, 8),
        "6003": (17, 35, 10),
        "6007": (35, 62, 14),
        "6200": (10, 30, 9),
        "6205": (25, 52, 15),
        "6212": (60, 110, 22),
        "6301": (12, 37, 12),
        "6306": (30, 72, 19),
        "6312": (60, 130, 31),
    }
    assert {name: tuple(bearing_of(name)[key] for key in "dDB") for name in public} == public
    for series in ("60", "62", "63"):
        for number in range(4, 13):
            assert bearing_of(f"{series}{number:02d}")["d"] == 5 * number


EXAMPLE = Shoulder(d=42.0, D=50.0, r=5.0, tensile_strength=1000.0, yield_strength=800.0, roughness=5.0)


def test_a_shoulder_of_a_published_example() -> None:
    """Shoulder 50/42, r 5 mm, 34CrMo4, Rz 5 µm: sydgtfzguhgfhtr/ME_Wellennachweis, Berechnung_Beispiel_Absatz.ipynb (GitHub).

    Its mean stresses are 500 MPa and 100 MPa of torsion, its amplitude of bending 50 MPa, its greatest torsion 130 MPa.
    """
    assert EXAMPLE.size_of_strength == pytest.approx(0.8713389943631755)
    assert EXAMPLE.size_of_yield == pytest.approx(0.8317509926287681)
    assert EXAMPLE.notch_factors == pytest.approx((1.5179405596067481, 1.2615866715165054))
    assert EXAMPLE.factors == pytest.approx((1.8242139172304368, 1.4854446175401899))
    assert EXAMPLE.alternating_limits == pytest.approx((238.82588169430872, 175.9753916250467))
    assert EXAMPLE.yield_limits == pytest.approx((838.4050005697983, 461.00319311323943))
    assert EXAMPLE.safeties(50.0, 100.0, 500.0)[0] == pytest.approx(154.79183517414634 / 50)
    assert EXAMPLE.safeties(50.0, 130.0, 500.0)[1] == pytest.approx(1.4004636102593677)
    assert EXAMPLE.safeties(0.0, 0.0, 0.0) == (math.inf, math.inf)


def test_a_stepped_shaft_is_judged_at_its_shoulder() -> None:
    """The moment at the shoulder is 1000 N 40 mm; what is not given is named."""
    strong = {"tensile_strength": 1000.0, "yield_strength": 800.0, "roughness": 5.0}
    parts = (
        ShaftSegment(length=80.0, outer_diameter=42.0, fillet_radius=5.0, **strong),
        ShaftSegment(length=120.0, outer_diameter=50.0),
    )
    rigid = (ShaftBearing(position=0.0, axial_stiffness="rigid"), ShaftBearing(position=200.0))
    force = ShaftForce(position=100.0, force=(0.0, -1000.0, 0.0))
    shaft = SteppedShaft(segments=parts, bearings=rigid, forces=(force,))
    (found,) = shoulder_safeties(shaft.solve())
    expected = EXAMPLE.safeties(500 * 80 / (math.pi * 42**3 / 32), 0.0, 0.0)
    assert (found.fatigue, found.static) == pytest.approx(expected)
    bare = replace(shaft, segments=(replace(parts[0], roughness=None, fillet_radius=None), parts[1]))
    assert shoulder_safeties(bare.solve())[0].reason == "fillet_radius, roughness not given"


def test_a_splined_segment_has_the_core_of_its_spline(tmp_path: Path) -> None:
    """DIN 5480-1: the root diameter of the shaft is d_B - 2.2 m, 27.25 mm for 30 x 1.25."""
    spec = """
[[shaft]]
length = 40.0
spline = "W 30 x 1.25 x 22 x 8f"
[[shaft]]
length = 60.0
outer_diameter = 35.0
[[bearing]]
position = 45.0
radial_stiffness = "rigid"
axial_stiffness = "rigid"
[[bearing]]
position = 95.0
radial_stiffness = "rigid"
[[force]]
position = 10.0
force = [0.0, 100.0, 0.0]
"""
    splined, plain = tmp_path / "splined.toml", tmp_path / "plain.toml"
    splined.write_text(spec, encoding="utf-8")
    plain.write_text(spec.replace('spline = "W 30 x 1.25 x 22 x 8f"', "outer_diameter = 27.25"), encoding="utf-8")
    results = [Shafts().complete_document(Shafts().run(read_spec(path))) for path in (splined, plain)]
    assert results[0]["shafts"] == results[1]["shafts"]
    for line, words in {
        'spline = "W 30 x 1.25 x 22 x 8f"\nouter_diameter = 28.0': "outer_diameter = 28 mm: must be left out, or 27.25 mm",
        'spline = "N 30 x 1.25 x 22 x 9H"': "must name a shaft",
        'spline = "W 30"': "spline = 'W 30': must",
    }.items():
        splined.write_text(spec.replace('spline = "W 30 x 1.25 x 22 x 8f"', line), encoding="utf-8")
        with pytest.raises(SpecError, match=words):
            read_spec(splined)
