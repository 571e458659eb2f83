"""Our contact of solid gears proved by somebody else's solver: CalculiX runs decks of loaded pairs, and of single gears."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from support.calculix import needs_ccx, run_ccx

import gearcad
from gearcad import Body, Gear, GearPair, Load, Material
from gearcad.check.options import CheckOptions
from gearcad.check.task import check_task
from gearcad.core.errors import ParameterError
from gearcad.core.records import Role
from gearcad.decks.calculix import CalculixDeviations, deviations
from gearcad.decks.solid import SolidDecks, solid_task, solid_tooth_deck
from gearcad.designs import PairDesign, read_spec
from gearcad.geometry import FlankModification
from gearcad.meshing import MeshSizes

TEMPLATES = Path(gearcad.__file__).parents[1] / "templates"

ERROR, ROOT = 1.0, 2.0
"""What default decks promise, in %."""

COARSE = MeshSizes(flank=0.8, corner=0.6, fillet=0.2, outline=1.0, cut=1.0, rim=4.0, growth=1.0)
COARSE_ERROR, COARSE_ROOT, FORCE = 2.0, 5.0, 0.2
"""In %, of two layers of elements like these, which take CalculiX 5 s: 1.1, 4.0 and 0.1 were measured."""

RELIEVED = FlankModification(tip_relief=10.0, tip_relief_length=1.0, lead_crowning=2.0)


@cache
def _small(torque: float = 40.0, *, offset: float = 0.0, refinement: float = 1.0) -> SolidDecks:
    """A helical pair, one gear wider, whose check and decks take few elements."""
    common = {"normal_module": 2.0, "profile_shift": 0.2, "modification": RELIEVED}
    pinion = Gear(teeth=14, face_width=4, helix_angle=12, body=Body(bore=18), **common)
    wheel = Gear(teeth=17, face_width=5, helix_angle=-12, body=Body(bore=24), **common)
    pair = GearPair(pinion=pinion, wheel=wheel, axial_offset=offset)
    options = CheckOptions(body_teeth=3, refinement=refinement)
    return SolidDecks(solid_task(check_task(pair, Material(), Load(torque=torque), options)), sizes=COARSE, layers=2)


def _compared(decks: SolidDecks, roll_angle: float, folder: Path) -> CalculixDeviations:
    made = decks.at(roll_angle)
    made.deck.write(folder / "pair.inp")
    run_ccx(folder, "pair", timeout=3600)
    found = made.found(folder / "pair")
    assert found["normal_force"] == pytest.approx(made.expected["normal_force"], rel=FORCE / 100)
    return deviations(made.expected, found)


def _agree(of: CalculixDeviations, error: float = ERROR, root: float = ROOT) -> None:
    assert abs(of.transmission_error) < error
    assert max(map(abs, of.root_stress)) < root


@needs_ccx
@pytest.mark.long
def test_calculix_loads_a_small_helical_pair_about_as_we_do(tmp_path: Path) -> None:
    _agree(_compared(_small(), 0.0, tmp_path), COARSE_ERROR, COARSE_ROOT)


@needs_ccx
@pytest.mark.long
@pytest.mark.parametrize(("torque", "offset"), [(-40.0, 0.0), (40.0, 0.8)], ids=["right flanks", "offset"])
def test_calculix_loads_right_flanks_and_shifted_gears_about_as_we_do(torque: float, offset: float, tmp_path: Path) -> None:
    _agree(_compared(_small(torque, offset=offset), 0.0, tmp_path), COARSE_ERROR, COARSE_ROOT)


@needs_ccx
@pytest.mark.long
def test_calculix_loads_the_fzg_pair_as_we_do(tmp_path: Path) -> None:
    _agree(_compared(_template("fzg-c", body_teeth=3), 0.1875, tmp_path))


@needs_ccx
@pytest.mark.long
def test_calculix_loads_a_helical_pair_as_we_do(tmp_path: Path) -> None:
    """Three pairs of teeth carry. Flanks have reliefs: at sharp tips that dig in, lines of contact are not what ours are."""
    _agree(_compared(_helical(), 0.0, tmp_path))


def _helical() -> SolidDecks:
    relieved = FlankModification(tip_relief=25.0, tip_relief_length=2.0, lead_crowning=4.0)
    common = {"normal_module": 3.0, "face_width": 20.0, "modification": relieved}
    pinion = Gear(teeth=21, helix_angle=20, body=Body(bore=40), **common)
    wheel = Gear(teeth=29, helix_angle=-20, body=Body(bore=66), **common)
    return SolidDecks(solid_task(check_task(GearPair(pinion=pinion, wheel=wheel), Material(), Load(torque=250.0))))


def _template(name: str, **options: object) -> SolidDecks:
    design = read_spec(TEMPLATES / f"{name}.toml")
    assert isinstance(design, PairDesign)
    assert design.load is not None
    task = check_task(design.pair, design.material or Material(), design.load, CheckOptions(**options))  # type: ignore[arg-type]
    return SolidDecks(solid_task(task))


# ---------------------------------------------------------------------- one gear


@needs_ccx
@pytest.mark.parametrize("role", Role)
def test_calculix_finds_our_root_stress_under_our_loads(role: Role, tmp_path: Path) -> None:
    made = solid_tooth_deck(_small(), 0.0, role)
    made.write(tmp_path / "tooth.inp")
    run_ccx(tmp_path, "tooth")
    found = made.found(tmp_path / "tooth")["root_stress"]
    assert found == pytest.approx(made.expected["root_stress"], rel=COARSE_ROOT / 100)


@pytest.mark.parametrize("torque", [40.0, -40.0])
@pytest.mark.parametrize("role", Role)
def test_loads_on_nodes_are_those_of_the_lines(role: Role, torque: float) -> None:
    made = solid_tooth_deck(_small(torque, refinement=0.5), 0.0, role)
    pair, normal = made.decks.pair, sum(contact.force for contact in made.position.contacts)
    along = np.tan(np.radians(pair.gears.pick(role).base_helix_angle))
    x, y, axial = made.forces.sum(axis=0)
    assert np.hypot(x, y) * np.hypot(1, along) == pytest.approx(normal, rel=1e-9)
    # It presses into the tooth: that of a right-hand gear towards larger z on its left flank.
    assert axial == pytest.approx(np.sign(torque) * along * np.hypot(x, y), rel=1e-9)
    # Right-hand rule: what presses on left flanks turns clockwise. Flanks between nodes are parabolas.
    turning = np.cross(made.mesh.points[made.nodes], made.forces)[:, 2].sum()
    lever = -np.sign(torque) * pair.gears.pick(role).base_diameter / 2
    assert turning == pytest.approx(np.hypot(x, y) * lever, rel=1e-4)


# ---------------------------------------------------------------------- what is refused


def test_contacts_too_narrow_for_a_deck_are_refused() -> None:
    with pytest.raises(ParameterError, match=r"load.torque .* must be at least .* N·m in size for a deck"):
        _small(0.01, refinement=0.5).at(0.0)


def test_bodies_without_teeth_that_carry_are_refused() -> None:
    pinion, wheel = (
        Gear(teeth=24, normal_module=2.0, face_width=34, helix_angle=turn, body=Body(bore=36)) for turn in (30, -30)
    )
    options = CheckOptions(body_teeth=3, refinement=0.25)
    task = check_task(GearPair(pinion=pinion, wheel=wheel), Material(), Load(torque=300.0), options)
    with pytest.raises(ParameterError, match=r"check.body_teeth = 3: must be at least 5 for a deck"):
        SolidDecks(solid_task(task)).at(0.0)


def test_rings_become_few_teeth() -> None:
    """But those that others' loads can move are there."""
    spur, helical = (GearPair(pinion=gear, wheel=replace(gear, helix_angle=-gear.helix_angle)) for gear in _WIDE)
    teeth = [solid_task(check_task(pair, Material(), Load(torque=9.0))).body.teeth for pair in (spur, helical)]
    assert teeth == [7, 11]


_WIDE = [Gear(teeth=30, normal_module=2.0, face_width=50, helix_angle=turn) for turn in (0, 30)]
