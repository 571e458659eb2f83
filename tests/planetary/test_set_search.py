"""The search for tooth numbers against plain loops, and planetary sets sized for a task."""

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from support.random_trains import loops

from gearcad import Gear
from gearcad.core.errors import ParameterError, SolverError
from gearcad.designs.reader import read_spec
from gearcad.designs.spec_writers import sized_set_text, write_sized_sets
from gearcad.designs.table import open_table
from gearcad.geometry.mating import internal_tips
from gearcad.geometry.pair_data import PairData
from gearcad.material import Material
from gearcad.planetary.members import SetType, material_of
from gearcad.planetary.power import efficiency
from gearcad.planetary.search import search
from gearcad.planetary.tooth_numbers import MeshedTeeth, SearchTask, _tip_margin, grids
from gearcad.planetary.train_data import SetTeeth
from gearcad.rating import RatingOptions
from gearcad.rating.strength import RatedPart
from gearcad.sizing.planetary_sets import SetSizeTask, SizedSets, made, size_sets

A, B, C, D = SetType


TASKS = {
    "A": SearchTask(ratio=4.1, module=2.0, teeth=(15, 20), ring_teeth=(40, 70), tolerance=3.0, planets=(2, 7)),
    "A helical": SearchTask(ratio=5.0, module=1.5, teeth=(18, 30), ring_teeth=(60, 98), tolerance=3.9, helix_angle=18.0),
    "A, diameter": SearchTask(ratio=3.7, module=0.5, teeth=(17, 22), ring_teeth=(40, 66), tolerance=3.0, diameter=33.0),
    "B": SearchTask(ratio=6.4, module=2.0, module_2=1.75, teeth=(17, 25), ring_teeth=(55, 70), tolerance=8.0, types=(B,)),
    "C": SearchTask(ratio=-19.0, module=2.0, teeth=(17, 28), tolerance=8.0, types=(C,)),
    "C, modules far apart": SearchTask(ratio=3.0, module=3.0, module_2=2.25, teeth=(17, 30), tolerance=3.0, types=(C,)),
    "A and D": SearchTask(
        ratio=5.0, module=2.0, teeth=(20, 25), ring_teeth=(58, 75), tolerance=16.0, types=(A, D), planets=(3, 3)
    ),
}

WIDE = {
    "A": SearchTask(ratio=4.1, module=2.0, teeth=(13, 30), ring_teeth=(40, 90), tolerance=6.0, planets=(2, 7)),
    "A small": SearchTask(ratio=3.7, module=0.5, teeth=(14, 26), ring_teeth=(40, 70), tolerance=8.0, planets=(1, 4)),
    "D": SearchTask(ratio=12.0, module=2.0, teeth=(20, 26), ring_teeth=(58, 80), tolerance=6.0, types=(D,)),
    "C helical": SearchTask(
        ratio=-9.0, module=1.0, teeth=(15, 32), tolerance=9.0, types=(C,), helix_angle=-25.0, planets=(2, 5)
    ),
}


def compare(task: SearchTask) -> None:
    """The search finds what plain loops find, in their order."""
    expected = loops(task)
    result = search(task, count=len(expected) + 100)
    found = [(each.planets, *(abs(z) for z in set_teeth(each.teeth)), each.kind.value) for each in result.found]
    assert found == [each[5:] for each in expected]
    assert len(expected) > 10
    assert result.left == 0
    assert result.considered == sum(result.removed.values()) + len(result.unmade) + len(found)


@pytest.mark.parametrize("task", TASKS.values(), ids=TASKS)
def test_nothing_is_missed_and_the_order_is_right(task: SearchTask) -> None:
    compare(task)


@pytest.mark.long
@pytest.mark.parametrize("task", WIDE.values(), ids=WIDE)
def test_nothing_is_missed_in_wide_searches(task: SearchTask) -> None:
    compare(task)


def set_teeth(teeth: dict[str, int]) -> SetTeeth:
    first, rim, *rest = teeth.values()
    return SetTeeth(first, rim, *rest) if len(rest) == 2 else SetTeeth(first, rim, rim, rest[0])


@pytest.mark.parametrize("kind", SetType)
@pytest.mark.parametrize("module_2", [0.7, 1.0, 3.0])
def test_grids_keep_within_limits_and_to_their_type(kind: SetType, module_2: float) -> None:
    task = SearchTask(ratio=1.0, module=1.0, types=(B,), module_2=module_2, teeth=(11, 60), ring_teeth=(25, 90))
    for grid in grids(task, kind):
        for teeth, ring in ((grid.a, kind is D), (grid.b, kind is not C), (grid.rim_a, False), (grid.rim_b, False)):
            size = -teeth if ring else teeth
            low, high = task.ring_teeth if ring else task.teeth
            assert ((low <= size) & (size <= high)).all()
        assert (grid.row[2] != 0).all()


def test_wide_limits_and_tolerances_are_searched() -> None:
    result = search(SearchTask(ratio=5.0, module=2.0, types=(C,), teeth=(9, 40), tolerance=300.0, planets=(1, 2)), count=1)
    assert result.considered > 1e5
    assert len(result.found) == 1


# ---------------------------------------------------------------------- candidates


@pytest.mark.parametrize("task", TASKS.values(), ids=TASKS)
def test_trains_of_what_is_found_are_what_was_said_of_them(task: SearchTask) -> None:
    for each in search(task, count=5).found:
        train = each.train()
        assert train.name == each.name
        assert train.set_type is each.kind
        assert train.ratio == pytest.approx(each.ratio, rel=1e-13)
        assert train.positions == each.positions
        assert efficiency(train, task.mesh_efficiency) == pytest.approx(each.efficiency, rel=1e-12)
        assert each.deviation == pytest.approx((each.ratio / task.ratio - 1) * 100, rel=1e-12)
        for mesh, phase, common in zip(train.meshes, each.phases, each.common, strict=True):
            assert mesh.central.gear.teeth % each.planets == phase
            assert math.gcd(mesh.central.gear.teeth, mesh.rim.gear.teeth) == common
            assert mesh.pair.circumferential_backlash == pytest.approx(0.0, abs=1e-9)
            assert not [notice for notice in mesh.pair.notices if notice.code == "low-contact-ratio"]


def test_the_error_share_is_that_of_a_floating_central() -> None:
    """(N - 3)/N: the diagonal of I - A (A^T A)^-1 A^T with A of 1, cos psi, sin psi."""
    for each in search(SearchTask(ratio=3.2, module=2.0, planets=(2, 6), tolerance=20.0), count=20).found:
        psi = np.arange(each.planets) * math.tau / each.planets
        sides = np.array([np.ones_like(psi), np.cos(psi), np.sin(psi)])
        left = np.eye(each.planets) - np.linalg.pinv(sides) @ sides
        assert each.error_share == pytest.approx(left[0, 0], abs=1e-12)


def test_roles_decide_the_ratio() -> None:
    """24/21/-66: 3.75 with the ring fixed, -2.75 with the carrier, 1.3636 from the ring with the sun fixed."""
    task = SearchTask(ratio=3.75, module=2.0, teeth=(21, 24), ring_teeth=(66, 66), tolerance=0.1)
    for ratio, roles in (
        (3.75, {}),
        (-2.75, {"fixed": "carrier", "output": "ring"}),
        (90 / 66, {"fixed": "sun", "input": "ring"}),
        (1 / 3.75, {"input": "carrier", "output": "sun"}),
    ):
        found = search(replace(task, ratio=ratio, **roles), count=50).found
        assert "A-24-21-66-n3" in [each.name for each in found]
    assert replace(task, fixed="sun").roles(A) == ("ring", "carrier", "sun")
    assert replace(task, fixed="carrier").roles(A) == ("sun", "ring", "carrier")
    assert SearchTask(ratio=5.0, module=1.0, types=(D,), output="carrier").roles(D) == ("ring_2", "carrier", "ring")


def test_a_set_that_locks_itself_is_not_found() -> None:
    """A central cannot drive the carrier at i0 = 48·51/49/50 with meshes of 0.97."""
    task = SearchTask(
        ratio=0.0008, module=2.0, teeth=(48, 51), types=(C,), tolerance=80.0, mesh_efficiency=0.97, planets=(1, 1)
    )
    task = replace(task, fixed="sun", input="sun_2", output="carrier", tip_distance=0.0)
    locked = search(task)
    assert not locked.found
    assert locked.removed["no self-locking"] > 0
    assert search(replace(task, mesh_efficiency=1.0)).found


def test_nothing_found_says_what_is_nearest() -> None:
    result = search(SearchTask(ratio=5.2, module=2.0, teeth=(17, 21), ring_teeth=(50, 60)))
    assert not result.found
    assert result.removed["ratio"] == result.considered
    (below,) = result.nearest
    assert below == pytest.approx(1 + 59 / 17, rel=1e-12)
    assert min(search(SearchTask(ratio=-5.2, module=2.0)).nearest) > 1


@pytest.mark.parametrize(
    ("rim", "ring", "helix_angle", "shifts"),
    [(30, 60, 0.0, (0.25, -0.25)), (36, 43, 0.0, (0.1, 0.0)), (36, 43, 20.0, (0.2, -0.1)), (40, 50, 10.0, (0.1, 0.1))],
)
def test_tips_beside_the_mesh_have_the_margin_of_the_pair(
    rim: int, ring: int, helix_angle: float, shifts: tuple[float, float]
) -> None:
    """Many pairs by arrays, and one by its profiles: the same distance along the ring's tip circle, also where tips foul."""
    given = {"normal_module": 2.0, "face_width": 20.0, "helix_angle": helix_angle}
    planet, wheel = (Gear(teeth=z, profile_shift=x, **given) for z, x in zip((rim, -ring), shifts, strict=True))
    mesh = MeshedTeeth(central=np.array([-ring]), rim=np.array([rim]), module=2.0, helix_angle=math.radians(helix_angle))
    distance = mesh.distance_for(sum(shifts))
    tips = tuple(np.array([abs(gear.tip_diameter) / 2]) for gear in (planet, wheel))
    found = _tip_margin(mesh, distance, tips, tuple(np.array([x]) for x in shifts)) * tips[1]
    pair = internal_tips(PairData(pinion=planet, wheel=wheel, centre_distance=-float(distance[0])))
    assert found == pytest.approx(pair.trochoid_margin, abs=1e-9)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"ratio": 0.0}, "ratio = 0: must be at least 0.0001 in size"),
        ({"ratio": math.nan}, "ratio = nan: must be a number"),
        ({"module": -1.0}, "module = -1 mm"),
        ({"planets": (5, 3)}, "planets = (5, 3): must have the least first"),
        ({"planets": (3, 25)}, "planets = 25: must be a whole number from 1 to 24"),
        ({"teeth": (4, 20)}, "teeth = 4"),
        ({"teeth": 20}, "teeth = 20: must be two whole numbers"),
        ({"fixed": "ring_2"}, "fixed = 'ring_2': must be sun, ring, carrier in a set of type A"),
        ({"fixed": "sun", "input": "sun"}, "fixed = 'sun': must differ from the members"),
        ({"types": ()}, "types = ()"),
        ({"module_2": 2.0}, "module_2 = 2 mm: applies to types B, C and D"),
        ({"mesh_efficiency": 0.0}, "mesh_efficiency = 0"),
        ({"ring_teeth": (10, 17)}, "ring_teeth = (10, 17): must reach above 17"),
    ],
)
def test_tasks_that_make_no_sense_are_refused(change: dict[str, object], message: str) -> None:
    with pytest.raises(ParameterError) as caught:
        replace(SearchTask(ratio=5.2, module=2.0), **change)
    assert message in str(caught.value)


def test_as_a_document() -> None:
    document = search(SearchTask(ratio=5.2, module=2.0), count=2).to_dict()
    assert [each["name"] for each in document["found"]] == ["A-20-31-84-n4", "A-20-32-84-n4"]
    assert document["found"][0]["teeth"] == {"sun": 20, "planet": 31, "ring": -84}


EH = Material(name="Eh MQ")


def task(**changes: Any) -> SetSizeTask:
    sets = SearchTask(ratio=4.0, module=1.0, planets=(3, 3), teeth=(20, 30), ring_teeth=(30, 90), tolerance=1.0)
    load = {"torque": 300.0, "speed": 1500.0, "rating": RatingOptions(life=10_000.0)}
    given: dict[str, Any] = {"sets": sets, "material": EH, "modules": (2.0, 2.5), "considered": 2, **load}
    return SetSizeTask(**given | changes)


@pytest.fixture(scope="module")
def sized() -> SizedSets:
    return size_sets(task(), 2)


def test_sets_hold_and_are_no_wider_than_they_must_be(sized: SizedSets) -> None:
    assert len(sized.found) == 2
    assert sized.found[0].mass <= sized.found[1].mass
    for each in sized.found:
        assert each.holds
        assert min(each.margins.values()) >= 1
        own = each.candidate
        step = 0.5 if own.task.width <= 20 else 1.0
        if own.task.width - step >= 5 * own.task.module:
            assert not made(sized.task, own, own.task.module, own.task.width - step).holds


def test_the_spec_is_what_was_rated(sized: SizedSets, tmp_path: Path) -> None:
    best = sized.found[0]
    (tmp_path / "best.toml").write_text(sized_set_text(best, ["a set"]), encoding="utf-8")
    design = read_spec(tmp_path / "best.toml")
    assert design.train.gears.keys() == best.train.gears.keys()
    for name, gear in design.train.gears.items():
        own = best.train.gears[name]
        assert gear.teeth == own.teeth
        assert gear.profile_shift == pytest.approx(own.profile_shift, abs=1e-9)
        assert gear.tip_diameter == pytest.approx(own.tip_diameter, rel=1e-9)
        assert gear.body.rim_diameter == own.body.rim_diameter
    assert design.load == best.load
    assert {name: material_of(design.material, name) for name in best.materials} == best.materials
    assert design.rating == best.strength.options
    write_sized_sets(sized, tmp_path / "sets.csv")
    table = open_table(tmp_path / "sets.csv")
    assert [row.design().name for row in table.rows()] == [each.name for each in sized.found]


def test_what_is_asked_for_decides_and_not_its_order(sized: SizedSets) -> None:
    turned = size_sets(task(modules=(2.5, 2.0)), 1)
    assert turned.found[0].to_dict() == sized.found[0].to_dict()
    alone = size_sets(task(considered=1), 1).found[0]
    heavier = size_sets(task(torque=380.0, considered=1), 1).found[0]
    assert heavier.mass > alone.mass


def test_nothing_holds_and_what_is_not_known() -> None:
    with pytest.raises(SolverError, match=r"no module and width within the limits let it hold"):
        size_sets(task(torque=1e5), 1)
    with pytest.raises(ParameterError, match=r"^material\.contact_endurance_limit"):
        task(material=Material())
    with pytest.raises(ParameterError, match=r"^torque"):
        task(torque=-5.0)
    with pytest.raises(SolverError, match=r"^no set has ratio 99"):
        size_sets(task(sets=replace(task().sets, ratio=99.0)), 1)


def test_margins(sized: SizedSets) -> None:
    best = sized.found[0]
    assert best.margins[RatedPart.ROOT] == pytest.approx(best.least[RatedPart.ROOT] / 1.4)
    assert best.load.mesh_load_factor == 1.0
    assert best.bears >= 1
