"""CalculiX confirms beams by solids of stepped shafts, and the load over the face of pairs on their shafts."""

import re
from io import StringIO
from pathlib import Path

import numpy as np
import pytest
from support.calculix import needs_ccx, run_ccx
from support.solid_shafts import SolidShaft

from gearcad import Body, FlankModification, Gear, GearPair, Load, Material
from gearcad.check.options import CheckOptions
from gearcad.check.task import check_task
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.core.errors import ParameterError
from gearcad.core.records import PerGear
from gearcad.decks.shafts import DeckShaft, with_bare_section
from gearcad.decks.solid import SolidDecks, shaft_task, solid_task
from gearcad.meshing import MeshSizes
from gearcad.shafts.beam import ShaftBearing, ShaftForce, ShaftSegment, SteppedShaft
from gearcad.shafts.face_load import MeshOnShafts

BEAM, TURN = 0.02, 0.03
"""Of the greatest deflection, and of the greatest turn: sections of solids warp under shear and beside steps."""


def random_shaft(seed: int) -> SteppedShaft:
    """A shaft with steps up to 1.3: beams leave out that a higher step does not carry at once."""
    draw = np.random.default_rng(seed)
    segments = tuple(
        ShaftSegment(length=float(draw.uniform(30, 60)), outer_diameter=float(draw.uniform(32, 42)), inner_diameter=8.0)
        for _ in range(int(draw.integers(4, 7)))
    )
    length = sum(each.length for each in segments)

    def at(low: float, high: float) -> float:
        return float(draw.uniform(low, high) * length)

    bearings = tuple(
        ShaftBearing(position=at(*span), radial_stiffness=float(draw.uniform(200, 600)), axial_stiffness=axial)
        for span, axial in (((0.05, 0.15), "rigid"), ((0.7, 0.85), 0.0))
    )
    forces = tuple(
        ShaftForce(position=at(*span), force=(float(draw.uniform(-3000, 3000)), 0.0, 0.0))
        for span in ((0.3, 0.6), (0.92, 0.97))
    )
    return SteppedShaft(segments=segments, bearings=bearings, forces=forces)


@needs_ccx
@pytest.mark.long
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_solids_of_stepped_shafts_bend_as_our_beams(seed: int, tmp_path: Path) -> None:
    shaft = random_shaft(seed)
    solid, state = SolidShaft(shaft), shaft.solve()
    solid.write(tmp_path / "shaft.inp")
    run_ccx(tmp_path, "shaft")
    places = [each.position for each in (*shaft.bearings, *shaft.forces)]
    theirs = np.array([solid.found(tmp_path / "shaft.dat", place) for place in places])
    ours = np.array([state.at(place)[[0, 4]] for place in places])
    for column, tolerance in ((0, BEAM), (1, TURN)):
        greatest = np.abs(theirs[:, column]).max()
        assert np.abs(ours[:, column] - theirs[:, column]).max() < tolerance * greatest


# ---------------------------------------------------------------------- pairs on their shafts

COARSE = MeshSizes(flank=1.0, corner=1.0, fillet=0.4, outline=1.6, cut=1.5, rim=4.0, growth=1.0)
LINE_LOAD, HELICAL, FACTOR, ERROR = 0.03, 0.04, 0.01, 0.01
"""Of a line load at five stations of the face, of helical gears, of K_Hbeta over the stations, and of the transmission error
between couplings. Measured with five layers of elements: spur 2.2 %, 0.04 % and 0.05 %; helical 2.6 % at four stations and
3.5 % in the middle, 0.6 % and 0.4 %.
"""


def decks(helix: float, torque: float = 60.0) -> SolidDecks:
    """Whole rings of 20 and 23 teeth on shafts as thick as their bores; bearings give way, the pinion is overhung."""
    common = {"normal_module": 2.0, "profile_shift": 0.2, "face_width": 8.0}
    flanks = FlankModification(tip_relief=10.0, tip_relief_length=1.0, lead_crowning=2.0)
    pinion, wheel = (
        Gear(teeth=z, helix_angle=sign * helix, body=Body(bore=bore), modification=flanks, **common)
        for z, sign, bore in ((20, 1, 26), (23, -1, 30))
    )
    pair = GearPair(pinion=pinion, wheel=wheel)

    def segments(diameter: float, gear: Gear, right: float) -> tuple[ShaftSegment, ...]:
        sizes = ((40.0, diameter), (8.0, gear.reference_diameter), (right, diameter))
        return tuple(ShaftSegment(length=length, outer_diameter=outer) for length, outer in sizes)

    first = (
        ShaftBearing(position=4.0, radial_stiffness=300.0, axial_stiffness=100.0),
        ShaftBearing(position=32.0, radial_stiffness=150.0),
    )
    second = (
        ShaftBearing(position=4.0, radial_stiffness=300.0, axial_stiffness="rigid"),
        ShaftBearing(position=70.0, radial_stiffness=150.0),
    )
    shafts = PerGear(
        SteppedShaft(segments=segments(26.0, pinion, 4.0), bearings=first),
        SteppedShaft(segments=segments(30.0, wheel, 30.0), bearings=second, coupling=70.0),
    )
    mesh = MeshOnShafts(pair=pair, torque=torque, shafts=shafts, positions=PerGear(44.0, 44.0), mesh_angle=70.0)
    options = CheckOptions(model="3d", convergence="off", pinion_support="rigid", wheel_support="rigid")
    task = check_task(pair, Material(), Load(torque=torque), options, shafts=mesh)
    return SolidDecks(shaft_task(task), sizes=COARSE, layers=5)


@needs_ccx
@pytest.mark.long
@pytest.mark.parametrize("helix", [0.0, 12.0], ids=["spur", "helical"])
def test_calculix_lays_the_load_over_the_face_on_shafts_as_we_do(helix: float, tmp_path: Path) -> None:
    made_of = decks(helix)
    made = made_of.at(0.0)
    made.write(tmp_path / "pair.inp")
    run_ccx(tmp_path, "pair", timeout=7200)
    ours, theirs = made_of.line_loads(made.position), made_of.found_line_loads(made, tmp_path / "pair")
    assert len(ours) == 5
    assert np.abs(ours / theirs - 1).max() < (HELICAL if helix else LINE_LOAD)
    assert ours.max() / ours.mean() == pytest.approx(theirs.max() / theirs.mean(), rel=FACTOR)
    on_rigid = SolidCycle(made_of.cycle.model.on(None), made_of.cycle.torque).solve(0.0)
    assert np.abs(made_of.line_loads(on_rigid) / theirs - 1).max() > 0.5  # what the shafts do
    found = made.found(tmp_path / "pair")
    assert found["transmission_error"] == pytest.approx(made.expected["transmission_error"], rel=ERROR)


def test_springs_of_a_deck_are_the_stiffness_of_its_shaft() -> None:
    """Springs and their ends, read back from the text, give the shaft the flexibility of the beam, free and on its bearings."""
    beam = random_shaft(4)
    bare = with_bare_section(beam, 20.0, 45.0, 26.0, np.linspace(20.0, 45.0, 5))
    assert bare.length == pytest.approx(beam.length)
    assert {20.0, 26.25, 32.5, 38.75, 45.0} <= set(np.round(bare.nodes, 9).tolist())
    at = [part.outer_diameter for part, node in zip(bare.parts, bare.nodes[:-1], strict=True) if 19.9 < node < 44.9]
    assert at and set(at) == {26.0}
    shaft = DeckShaft(name="pinion", beam=bare, x=0.0, start=0.0, turn=0.0, first=7, held=np.zeros(0, int), driver=None)
    file = StringIO()
    assert shaft.write_springs(file, 100) > 100
    count = 3 * shaft.count
    found, numbers = np.zeros((count, count)), range(7, 7 + shaft.count)
    pattern = r"\*ELEMENT, TYPE=SPRING\d, ELSET=pinion_spring_\d+\n\d+, ([\d, ]+)\n\*SPRING, ELSET=\S+\n([\d, ]+)\n(\S+)\n"
    for nodes, dofs, spring in re.findall(pattern, file.getvalue()):
        ends = [3 * numbers.index(int(n)) + int(dof) - 1 for n, dof in zip(nodes.split(","), dofs.split(","), strict=True)]
        way = np.zeros(count)
        way[ends[0]] = 1.0
        if len(ends) == 2:
            way[ends[1]] = -1.0
        found += float(spring) * np.outer(way, way)
    free = np.flatnonzero(np.abs(bare.compliance).max(axis=1) > 0)
    flexible, expected = np.linalg.inv(found[np.ix_(free, free)]), bare.compliance[np.ix_(free, free)]
    assert np.abs(flexible - expected).max() < 1e-6 * np.abs(expected).max()


def test_decks_have_shafts_only_where_they_are_asked_for() -> None:
    with_shafts = decks(0.0).task
    assert solid_task(with_shafts).shafts is None
    with pytest.raises(ParameterError, match="a shaft is described of neither gear"):
        shaft_task(solid_task(with_shafts))
