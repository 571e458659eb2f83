"""Load over the face of a mesh on its shafts: closed forms, invariants, an iteration beside it, and ratings."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.specs import TEMPLATES

from gearcad import Gear, GearPair, Load, Mounting, modify, rate, shafts
from gearcad.check.task import check_task, face_factors
from gearcad.core.errors import GearcadError, GeometryError
from gearcad.core.records import PerGear, Role
from gearcad.designs import PairDesign, TrainDesign, read_spec
from gearcad.designs.train_meshes import train_meshes
from gearcad.geometry import DoubleHelix, FlankModification
from gearcad.jobs.shafts import Shafts
from gearcad.material import Material
from gearcad.rating import RatingOptions
from gearcad.rating.strength import StrengthRating
from gearcad.shafts.beam import GearForce, ShaftBearing, ShaftForce, ShaftSegment, SteppedShaft
from gearcad.shafts.face_load import MeshOnShafts
from gearcad.shafts.lead_search import propose_lead

EXACT = 1e-9
"""Relative: the same sums by another way."""

WIDTH = 30.0


def pair_of(helix: float = 0.0, *, widths: tuple[float, float] = (WIDTH, WIDTH), **modified: FlankModification) -> GearPair:
    gears = [
        Gear(
            teeth=teeth,
            normal_module=3.0,
            helix_angle=hand * helix,
            face_width=width,
            modification=modified.get(role.value, FlankModification()),
        )
        for role, teeth, hand, width in zip(Role, (19, 43), (1, -1), widths, strict=True)
    ]
    return GearPair(pinion=gears[0], wheel=gears[1])


def shaft_of(diameter: float = 32.0, left: float = 10.0, right: float = 150.0, stiffness: float = 400.0) -> SteppedShaft:
    """A stepped shaft of 170 mm, its gear from 45 to 75 mm."""
    parts = ((45.0, diameter), (WIDTH, 50.0), (95.0, diameter))
    return SteppedShaft(
        segments=tuple(ShaftSegment(length=length, outer_diameter=each) for length, each in parts),
        bearings=(
            ShaftBearing(position=left, radial_stiffness=stiffness, axial_stiffness=150.0),
            ShaftBearing(position=right, radial_stiffness=0.7 * stiffness),
        ),
        coupling=170.0,
    )


def mesh_of(pair: GearPair | None = None, **changed: Any) -> MeshOnShafts:
    given: dict[str, Any] = {
        "torque": 140.0,
        "shafts": PerGear(shaft_of(), shaft_of(40.0)),
        "positions": PerGear(60.0, 60.0),
        "mesh_angle": 30.0,
        "stiffness": 16.0,
    }
    return MeshOnShafts(pair=pair or pair_of(), **{**given, **changed})


RIGID: dict[str, Any] = {"shafts": PerGear(None, None)}


# ---------------------------------------------------------------------- closed forms


def test_end_relief_on_rigid_shafts() -> None:
    """A linear relief C over L at both ends: w_mean = c (delta - C L/b), the middle has c delta."""
    relieved = FlankModification(end_relief=4.0, end_relief_length=6.0)
    for role in Role:
        mesh = mesh_of(pair_of(**{role.value: relieved}), slices=60, **RIGID)
        expected = 1 + 16.0 * 4.0 * 6.0 / WIDTH / mesh.mean_load
        assert mesh.face_load_factor == pytest.approx(expected, rel=EXACT)


def test_crowning_is_over_the_width_of_its_own_gear() -> None:
    """A wheel of 50 mm, set off by 4 mm: the middle of its crowning C (2 z/b)^2 stands 4 mm from that of the common face."""
    pair = pair_of(widths=(WIDTH, 50.0), wheel=FlankModification(lead_crowning=12.0))
    mesh = mesh_of(replace(pair, axial_offset=4.0), **RIGID)
    depth = 12.0 * (2 * (mesh.places - 4.0) / 50.0) ** 2
    assert 1000 * mesh.given_gap == pytest.approx(depth, rel=EXACT)
    assert mesh.line_load == pytest.approx(mesh.mean_load + 16.0 * (depth.mean() - depth), rel=1e-6)


@pytest.mark.parametrize("torque", [140.0, -140.0])
@pytest.mark.parametrize("helix", [0.0, 14.0, -14.0])
@pytest.mark.parametrize("role", list(Role))
def test_helix_modification_opens_the_gap_as_in_a_check(role: Role, helix: float, torque: float) -> None:
    """The misalignment that a check's closed form takes from the flanks, whose signs its contacts confirm."""
    pair = pair_of(helix, **{role.value: FlankModification(helix_angle_modification=7.0)})
    off = face_factors(check_task(pair, Material(), Load(torque=torque))).misalignment
    assert abs(off) == pytest.approx(7.0)
    mesh = mesh_of(pair, torque=torque, **RIGID)
    assert 1000 * mesh.given_gap == pytest.approx(off * mesh.places / WIDTH, abs=1e-9)
    assert replace(mesh, misalignment=-off).face_load_factor == pytest.approx(1.0, abs=EXACT)


def test_profile_modifications_are_no_gaps_over_the_face() -> None:
    tip = FlankModification(tip_relief=20.0, tip_relief_length=2.0, profile_crowning=5.0, twist=6.0)
    assert np.abs(mesh_of(pair_of(pinion=tip)).given_gap).max() == 0


# ---------------------------------------------------------------------- invariants


def mirrored(shaft: SteppedShaft) -> SteppedShaft:
    """The shaft from right to left."""
    return replace(
        shaft,
        segments=shaft.segments[::-1],
        bearings=tuple(replace(each, position=shaft.length - each.position) for each in shaft.bearings),
        coupling=shaft.length - shaft.coupling,
    )


@pytest.mark.parametrize("helix", [0.0, 14.0])
def test_factor_does_not_depend_on_where_the_wheel_lies_or_which_end_is_left(helix: float) -> None:
    mesh = mesh_of(pair_of(helix), misalignment=5.0)
    for angle in (0.0, 77.0, 200.0):
        assert replace(mesh, mesh_angle=angle).face_load_factor == pytest.approx(mesh.face_load_factor, rel=1e-11)
    turned = replace(
        mesh,
        pair=pair_of(-helix),
        shafts=mesh.shafts.map(lambda each: None if each is None else mirrored(each)),
        positions=PerGear(110.0, 110.0),
        misalignment=-5.0,
        torque=140.0,
    )
    assert turned.line_load == pytest.approx(mesh.line_load[::-1], rel=1e-8)
    # A mirrored helix is loaded on its other flank by the same axial force.
    other = replace(mesh, pair=pair_of(-helix), torque=-140.0)
    assert other.line_load == pytest.approx(mesh.line_load, rel=1e-8)


def test_loads_and_stiffnesses_doubled_give_the_same_factor() -> None:
    def stiffer(shaft: SteppedShaft, factor: float) -> SteppedShaft:
        return replace(
            shaft,
            segments=tuple(replace(each, youngs_modulus=factor * each.youngs_modulus) for each in shaft.segments),
            bearings=tuple(
                replace(
                    each,
                    radial_stiffness=factor * float(each.radial_stiffness),
                    axial_stiffness=factor * float(each.axial_stiffness),
                )
                for each in shaft.bearings
            ),
            forces=(ShaftForce(position=170.0, force=(200.0 * factor, -900.0 * factor, 0.0)),),
        )

    one, two = (
        mesh_of(
            pair_of(14.0, pinion=FlankModification(lead_crowning=6.0)),
            shafts=PerGear(stiffer(shaft_of(), factor), stiffer(shaft_of(40.0), factor)),
            torque=140.0 * factor,
            stiffness=16.0 * factor,
            misalignment=8.0,
        )
        for factor in (1.0, 2.0)
    )
    assert two.face_load_factor == pytest.approx(one.face_load_factor, rel=EXACT)
    assert two.line_load == pytest.approx(2 * one.line_load, rel=1e-8)


@pytest.mark.parametrize("torque", [35.0, 280.0])
def test_forces_of_other_meshes_grow_with_the_torque(torque: float) -> None:
    """All loads grow alike, and nothing else opens the gap: the factor stays; a force that does not grow changes it."""
    force: dict[str, Any] = {"position": 20.0, "force": (700.0, -2600.0, 400.0), "at": (31.0, 8.0)}
    factors = {}
    for kind in (GearForce, ShaftForce):
        shaft = replace(shaft_of(), forces=(kind(**force),))
        mesh = mesh_of(pair_of(14.0), shafts=PerGear(shaft, shaft_of(40.0)), forces_torque=140.0)
        other = replace(mesh, torque=torque)
        factors[kind] = other.face_load_factor / mesh.face_load_factor
        states = [each.state(Role.PINION) for each in (mesh, other)]
        moved = [each.moved for each in states if each is not None]
        alike = np.allclose(moved[1], moved[0] * torque / 140, rtol=1e-7, atol=1e-12)
        assert alike == (kind is GearForce)
    assert factors[GearForce] == pytest.approx(1.0, rel=EXACT)
    assert abs(factors[ShaftForce] - 1) > 0.01


def test_meshes_of_a_train_know_the_torque_of_its_forces() -> None:
    """Of both stages of the starter: half the torque halves all loads of the train, so f_sh is half too."""
    design = read_spec(TEMPLATES / "two-stage.toml")
    assert isinstance(design, TrainDesign)
    meshes = [each.design.arrangement for each in train_meshes(design).meshes]
    for mesh in [each.mesh for each in meshes if each is not None and each.mesh is not None]:
        half = replace(mesh, torque=mesh.torque / 2)
        assert half.misalignment_of_shafts == pytest.approx(mesh.misalignment_of_shafts / 2, rel=1e-8)
        assert any(gap.any() for gap in mesh.face.gear_gaps)
    assert len(meshes) == 2


def by_iteration(mesh: MeshOnShafts, relaxation: float) -> np.ndarray:
    """w = c max(delta - gap(w), 0) again and again, its sum held by delta, as ISO 6336-1, annex E, has it."""
    step = mesh.width / mesh.slices
    springs = (mesh.influence.pinion + mesh.influence.wheel) * step
    apart = mesh.given_gap + mesh.outer_gaps.pinion + mesh.outer_gaps.wheel
    load = np.full(mesh.slices, mesh.mean_load)
    for _ in range(4000):
        gap, low, high = springs @ load + apart, -10.0, 10.0
        for _ in range(80):  # the approach at which the slices carry the force
            middle = (low + high) / 2
            carried = 1000 * mesh.stiffness * np.maximum(middle - gap, 0).sum() * step
            low, high = (middle, high) if carried < mesh.base_force else (low, middle)
        new = 1000 * mesh.stiffness * np.maximum(high - gap, 0)
        if np.abs(new - load).max() < 1e-11 * mesh.mean_load:
            break
        load = (1 - relaxation) * load + relaxation * new
    return np.asarray(load)


@pytest.mark.parametrize(
    ("misalignment", "crowning", "relaxation"),
    [(0.0, 0.0, 1.0), (6.0, 8.0, 0.7), (45.0, 10.0, 0.5)],
    ids=["even", "both", "part"],
)
def test_iteration_and_direct_solution_agree(misalignment: float, crowning: float, relaxation: float) -> None:
    mesh = mesh_of(
        pair_of(14.0, wheel=FlankModification(lead_crowning=crowning)),
        misalignment=misalignment,
        shafts=PerGear(shaft_of(), None),
    )
    assert (mesh.line_load == 0).any() == (misalignment > 40)
    assert mesh.line_load == pytest.approx(by_iteration(mesh, relaxation), rel=1e-8, abs=1e-8 * mesh.mean_load)
    assert mesh.line_load.sum() * mesh.width / mesh.slices == pytest.approx(mesh.base_force, rel=1e-12)
    for matrix in mesh.influence:
        assert np.abs(matrix - matrix.T).max() <= 1e-12 * max(np.abs(matrix).max(), 1e-300)


def test_forces_balance_the_load_over_the_face() -> None:
    """Reactions of both shafts and of their couplings hold what the teeth put on them: no force is left, and the torque is."""
    mesh = mesh_of(pair_of(14.0), misalignment=10.0)
    states = [mesh.state(role) for role in Role]
    total = sum(sum(each.reactions)[:3] for each in states if each is not None)  # type: ignore[index,misc]
    assert np.abs(total).max() < 1e-8 * mesh.base_force
    torques = [each.coupling_torque for each in states if each is not None]
    assert abs(torques[0]) == pytest.approx(140.0, rel=1e-9)
    assert torques[1] / torques[0] == pytest.approx(mesh.pair.gear_ratio, rel=1e-9)


def test_rings_and_double_helical_gears_are_refused() -> None:
    pinion, wheel = (Gear(teeth=teeth, normal_module=2, face_width=20) for teeth in (24, -80))
    ring = GearPair(pinion=pinion, wheel=wheel)
    with pytest.raises(GeometryError, match="the load over the face of a ring on shafts is not modelled"):
        mesh_of(ring)
    halves = [
        Gear(teeth=z, normal_module=2, face_width=40, helix_angle=beta, double_helix=DoubleHelix(gap_width=8.0))
        for z, beta in ((20, 25.0), (40, -25.0))
    ]
    with pytest.raises(GeometryError, match="double helical gears on shafts is not modelled"):
        mesh_of(GearPair(pinion=halves[0], wheel=halves[1]))


# ---------------------------------------------------------------------- the given meshes as specs

MESHES = json.loads((Path(__file__).parents[1] / "data" / "shafts.json").read_text(encoding="utf-8"))["meshes"]


def spec_of(inputs: dict[str, Any]) -> str:
    """A given mesh as a spec: all of its inputs under the keys that they have."""

    def shown(value: Any) -> str:
        return json.dumps(value)

    lines = ["[pair]", f"normal_module = {inputs['normal_module']}", f"face_width = {inputs['width']}"]
    lines += [f"rack.pressure_angle = {inputs['pressure_angle']}", f"helix_angle = {inputs['helix_angle']}"]
    lines += [f"centre_distance = {inputs['centre_distance']}"] if "centre_distance" in inputs else []
    for role, teeth in zip(Role, inputs["teeth"], strict=True):
        own = inputs[role.value]
        lines += [f"[{role.value}]", f"teeth = {teeth}", f"mesh_position = {own['mesh_position']}"]
        lines += [f"coupling = {own['coupling']}"]
        lines += ['profile_shift = "auto"'] if "centre_distance" in inputs else []
        if role is Role.PINION and "crowning" in inputs:
            lines += [f"modification.lead_crowning = {inputs['crowning']}"]
        for name, listed in (("shaft", own["segments"]), ("bearing", own["bearings"])):
            for each in listed:
                lines += [f"[[{role.value}.{name}]]", *(f"{key} = {shown(value)}" for key, value in each.items())]
    lines += ["[load]", f"torque = {inputs['torque']}", "[shafts]", f"mesh_angle = {inputs['mesh_angle']}"]
    lines += [f"slices = {inputs['slices']}", f"gravity = {inputs['pinion'].get('gravity', [0, 0, 0])}"]
    lines += ["[rating]", f"face_mesh_stiffness = {inputs['stiffness']}", 'misalignment_sides = "one"']
    lines += [f"manufacturing_misalignment = {inputs.get('misalignment', 0.0)}"]
    return "\n".join([*lines, 'face_load_factor = "shafts"', "dynamic_factor = 1.0", ""])


@pytest.mark.parametrize("case", MESHES, ids=lambda case: case["name"].partition(" ")[0])
def test_given_meshes_run_as_specs(tmp_path: Path, case: dict[str, Any]) -> None:
    """shafts.json and the rating, to 1e-4; carried on to the end of the face by other slices 2e-3."""
    design, expected = design_of(tmp_path, lambda _: spec_of(case["inputs"])), case["expected"]
    document = Shafts().complete_document(shafts(design))
    found = document["mesh"]
    for key in ("f_sh", "K_Hbeta_slices", "approach"):
        assert found[key] == pytest.approx(expected[key], rel=1e-4), key
    assert found["K_Hbeta_end_of_face"] == pytest.approx(expected["K_Hbeta_end_of_face"], rel=2e-3)
    assert found["line_load"] == pytest.approx(expected["line_load"], rel=1e-4, abs=1e-3)
    assert found["gap_at_even_load_at_slices"].keys() == expected["gap_at_even_load_at_slices"].keys()
    for name, gap in expected["gap_at_even_load_at_slices"].items():
        assert found["gap_at_even_load_at_slices"][name] == pytest.approx(gap, rel=1e-4, abs=1e-4), name
    for role, reactions in expected["reactions"].items():
        for mine, theirs in zip(document["shafts"][role]["reactions"], reactions, strict=True):
            assert mine["force"] == pytest.approx(theirs["force"], rel=1e-4, abs=1e-2)
    rated = rating_of(design)
    assert rated.load_factors is not None
    assert rated.load_factors.face_flank == pytest.approx(expected["K_Hbeta_slices"], rel=1e-4)


# ---------------------------------------------------------------------- modifications for the shafts


@pytest.mark.parametrize("torque", [140.0, -140.0])
@pytest.mark.parametrize("side", [0.0, 9.0])
def test_proposed_lead_is_the_best_of_all_whole_micrometres(torque: float, side: float) -> None:
    """Against pairs that have the modifications, one by one around the proposal; less crowning may cost 1e-4 each."""
    pair = pair_of(14.0, wheel=FlankModification(helix_angle_modification=5.0))
    mesh = mesh_of(pair, torque=torque, shafts=PerGear(shaft_of(24.0), shaft_of(34.0)))
    found = propose_lead(mesh, (side, -side))

    def worst(crowning: float, helix: float) -> float:
        changed = FlankModification(lead_crowning=crowning, helix_angle_modification=helix)
        own = replace(pair, pinion=replace(pair.pinion, modification=changed))
        sides = [replace(mesh, pair=own, misalignment=each).face_load_factor for each in (side, -side)]
        return max(sides)

    crowning, helix = found.lead_crowning, found.helix_angle_modification
    assert found.before == pytest.approx(worst(0.0, 0.0), rel=1e-8)
    assert found.after == pytest.approx(worst(crowning, helix), rel=1e-8)
    assert found.after < found.before - 0.05
    for more, turn in [(i, j) for i in (-3, -1, 0, 1, 3) for j in (-3, -1, 0, 1, 3) if (i, j) != (0, 0)]:
        if crowning + more >= 0:
            assert found.after <= worst(crowning + more, helix + turn) + 3e-4 + 1e-9
    if not side:  # the wheel's own modification and f_sh are made up for, to a micrometre
        line = np.polyfit(mesh.places, mesh.given_gap, 1)[0] * WIDTH * 1000 + mesh.misalignment_of_shafts
        assert abs(helix) == pytest.approx(abs(line), abs=1.5)


# ---------------------------------------------------------------------- ratings

SPEC = """
[pair]
normal_module = 3
helix_angle = 14
face_width = 30
[pinion]
teeth = 19
mesh_position = 60
coupling = 170
modification.lead_crowning = 5
[[pinion.shaft]]
length = 170
outer_diameter = 34
[[pinion.bearing]]
position = 10
radial_stiffness = 300
axial_stiffness = 100
[[pinion.bearing]]
position = 150
radial_stiffness = 200
[wheel]
teeth = 43
[load]
torque = 140
speed = 1200
[material]
name = "Eh MQ"
[shafts]
mesh_angle = 90
[rating]
face_load_factor = "shafts"
"""


def design_of(folder: Path, change: Callable[[str], str] = str) -> PairDesign:
    spec = folder / "pair.toml"
    spec.write_text(change(SPEC), encoding="utf-8")
    design = read_spec(spec)
    assert isinstance(design, PairDesign)
    return design


def rating_of(design: PairDesign) -> StrengthRating:
    found = rate(design)
    assert isinstance(found, StrengthRating)
    return found


def test_rating_takes_the_load_over_the_face_of_its_design(tmp_path: Path) -> None:
    """With K_v = K_A = K_gamma = 1 it is that of `gearcad shafts`; else that of the torque times these factors."""
    given = "dynamic_factor = 1.0\nmanufacturing_misalignment = 7.0\nface_mesh_stiffness = 15.0\n"
    design = design_of(tmp_path, lambda text: text + given)
    assert design.arrangement is not None and design.arrangement.mesh is not None
    mesh, found = design.arrangement.mesh, rating_of(design)
    assert found.load_factors is not None
    assert found.load_factors.face_flank == pytest.approx(mesh.face_load_factor, rel=EXACT)
    assert found.load_factors.details["K_Hbeta_end_of_face"] == pytest.approx(mesh.face_load_factor_at_end, rel=EXACT)
    assert (mesh.stiffness, abs(mesh.misalignment)) == (15.0, 7.0)
    other = replace(mesh, misalignment=-mesh.misalignment)
    assert other.face_load_factor < mesh.face_load_factor  # the worse side counts
    assert any("the wheel has no shaft in the design and is held rigidly" in each for each in found.assumed)
    more = rating_of(design_of(tmp_path, lambda text: text.replace("speed = 1200", "application_factor = 1.3") + given))
    assert more.load_factors is not None
    assert more.load_factors.face_flank == pytest.approx(replace(mesh, torque=1.3 * 140).face_load_factor, rel=EXACT)


def test_each_load_of_a_spectrum_has_its_own_factor(tmp_path: Path) -> None:
    spectrum = "spectrum = [[0.3, 1.2], [0.7, 0.5]]\nlife = 1000\ndynamic_factor = 1.0\nmanufacturing_misalignment = 7.0\n"
    design = design_of(tmp_path, lambda text: text + spectrum + "face_mesh_stiffness = 15.0\n")
    found = rating_of(design)
    assert design.arrangement is not None and design.arrangement.mesh is not None
    for case, share in zip(found.cases, (1.2, 0.5), strict=True):
        sides = [
            replace(design.arrangement.mesh, torque=share * 140, misalignment=side).face_load_factor for side in (7.0, -7.0)
        ]
        assert case.factors.face_flank == pytest.approx(max(sides), rel=EXACT)
    assert found.cases[1].factors.face_flank > found.cases[0].factors.face_flank


def test_mounting_turns_the_flanks_on_shafts_too(tmp_path: Path) -> None:
    """Its misalignment has a side: that of the mesh without it, whose f_ma has one side."""
    options = "manufacturing_misalignment = 0.0\ndynamic_factor = 1.0\n"
    design = design_of(tmp_path, lambda text: text + options)
    tilted = replace(design, mounting=Mounting(misalignment=-9.0))
    by_hand = replace(
        design,
        rating=RatingOptions(
            face_load_factor="shafts",
            dynamic_factor=1.0,
            manufacturing_misalignment=-9.0,
            misalignment_sides="one",  # type: ignore[arg-type]
        ),
    )
    first, second = (rating_of(each).load_factors for each in (tilted, by_hand))
    assert first is not None and second is not None
    assert first.face_flank == pytest.approx(second.face_flank, rel=EXACT)


def test_a_rating_on_shafts_without_shafts_is_one_line(tmp_path: Path) -> None:
    pair = design_of(tmp_path).pair
    with pytest.raises(GearcadError, match="no gear has a shaft with its bearings, such as") as error:
        rate(pair, Load(torque=140.0, speed=1200.0), rating=RatingOptions(face_load_factor="shafts"))
    assert "\n" not in str(error.value)
    with pytest.raises(GearcadError, match="mesh_position = 3 mm: must be from 15 to 155 mm"):
        design_of(tmp_path, lambda text: text.replace("mesh_position = 60", "mesh_position = 3"))


def test_thin_shafts_carry_with_a_part_of_the_face(tmp_path: Path) -> None:
    """Overhung on 16 mm: the shares of the face that the notice and the line load name are equal."""
    thin = design_of(tmp_path, lambda text: text.replace("diameter = 34", "diameter = 16").replace("ion = 150", "ion = 30"))
    found = rating_of(thin)
    (notice,) = (each for each in found.notices if each.code == "narrow-bearing")
    assert thin.arrangement is not None and thin.arrangement.mesh is not None and found.load_factors is not None
    details = found.load_factors.details
    mesh = replace(
        thin.arrangement.mesh,
        torque=140.0 * found.load_factors.dynamic,
        stiffness=float(details["c_gamma_beta"]),  # type: ignore[arg-type]
        misalignment=float(details["f_ma"]),  # type: ignore[arg-type]
    )
    assert f"only {(mesh.line_load > 0).mean():.0%} of the face width carries on its shafts" in notice.text
    assert found.load_factors.face_flank > 2


@pytest.mark.long
@pytest.mark.parametrize("torque", [60.0, -60.0])
def test_modify_proposes_for_the_shafts(tmp_path: Path, torque: float) -> None:
    """Of a spur pair: the design that it proposes has K_Hbeta as told, and bodies on its shafts are loaded more evenly."""
    spur = SPEC.replace("helix_angle = 14\n", "").replace("modification.lead_crowning = 5", "tooth_thinning = 0.05")
    text = spur.replace("teeth = 43", "teeth = 43\ntooth_thinning = 0.05").replace("torque = 140", f"torque = {torque}")
    text = text.replace("position = 150", "position = 165").replace("outer_diameter = 34", "outer_diameter = 26")
    text += "manufacturing_misalignment = 0\n[check]\npositions = 12\nrefinement = 0.5\nbody_teeth = 3\n"
    design = design_of(tmp_path, lambda _: text)
    found = modify(design, pressure=2000.0, shape="linear")
    assert found.lead is not None
    assert design.arrangement is not None and design.arrangement.mesh is not None
    after = replace(design.arrangement.mesh, pair=found.pair)
    assert found.lead.K_Hbeta_before == pytest.approx(design.arrangement.mesh.face_load_factor, rel=1e-8)
    assert found.lead.K_Hbeta_after == pytest.approx(after.face_load_factor, rel=1e-8)
    assert found.lead.K_Hbeta_after < 1.05 < 1.3 < found.lead.K_Hbeta_before  # whole µm are left over
    assert found.after.face_load_factor < found.before.face_load_factor
    helix = found.pair.pinion.modification.helix_angle_modification
    assert abs(helix) == pytest.approx(abs(found.lead.f_sh), abs=1.0)
    assert found.to_dict()["shafts"] == found.lead._asdict()
