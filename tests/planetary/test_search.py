"""The search for tooth numbers against plain loops over all of them, gear by gear."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from typing import NamedTuple

import numpy as np
import pytest
from support.sets import unchecked_set

from gearcad.errors import GeometryError, ParameterError
from gearcad.geometry import Gear, GearPair
from gearcad.geometry.shift import profile_shift_sum, zero_backlash_centre_distance
from gearcad.per_gear import PerGear
from gearcad.planetary.fitting import SetTeeth, fit_planets
from gearcad.planetary.mesh import SetType
from gearcad.planetary.power import efficiency
from gearcad.planetary.search import SearchTask, search
from gearcad.planetary.search.grid import grids

A, B, C, D = SetType


class Mesh(NamedTuple):
    """A central with a rim, without any gears."""

    central: int
    rim: int
    module: float
    helix: float

    @property
    def sign(self) -> int:
        return 1 if self.central > 0 else -1

    @property
    def sizes(self) -> dict[str, object]:
        teeth = PerGear(self.rim, self.central)
        return {"normal_module": self.module, "teeth": teeth, "helix_angle": self.helix, "pressure_angle": 20.0}

    @property
    def reference(self) -> float:
        return self.module * abs(self.central + self.rim) / 2 / math.cos(math.radians(self.helix))

    def distance(self, shift_sum: float) -> float:
        return abs(zero_backlash_centre_distance(**self.sizes, shift_sum=shift_sum))

    def shift_sum(self, distance: float) -> float:
        return profile_shift_sum(**self.sizes, centre_distance=self.sign * distance)

    def least_shift(self, teeth: int) -> float:
        """Of ISO 53 A: 1.25 - 0.38 (1 - sin 20) - z sin^2 alpha_t/(2 cos beta)."""
        cosine = math.cos(math.radians(self.helix))
        sine = math.sin(math.atan(math.tan(math.radians(20)) / cosine))
        return 1.25 - 0.38 * (1 - math.sin(math.radians(20))) - teeth * sine**2 / 2 / cosine


def up(value: float, digits: int) -> float:
    return round(math.ceil(value * 10**digits - 1e-6) / 10**digits, digits)


def chosen_distance(meshes: tuple[Mesh, Mesh]) -> float | None:
    """The rule of the search; None where no centre distance serves both meshes."""
    low = max(mesh.reference for mesh in meshes)
    high = min(mesh.distance(1.2 * mesh.sign) for mesh in meshes)
    if low > high + 1e-9 * meshes[0].module:
        return None
    wanted = min(max([low, *(mesh.distance(0.5) for mesh in meshes if mesh.sign > 0)]), high)
    figures = up(wanted, -math.floor(math.log10(meshes[0].module / 50)))
    return max(figures, low) if figures <= high else wanted


def rim_shift(mesh: Mesh, distance: float) -> float:
    total = mesh.shift_sum(distance)
    wanted = min(total / 2, total - mesh.least_shift(mesh.central)) if mesh.sign > 0 else 0.25
    return up(max(wanted, mesh.least_shift(mesh.rim)), 4)


def clear(ring: Gear, rim: Gear, distance: float) -> float:
    """Tip alteration with which the flank of a ring ends on the root form circle of the rim."""
    reach = math.sqrt(rim.form_diameter**2 - rim.base_diameter**2) / 2
    across = math.sqrt(distance**2 - (ring.base_diameter + rim.base_diameter) ** 2 / 4) + reach
    least = math.hypot(ring.base_diameter / 2, across)
    return -up(max(least - abs(ring.tip_diameter) / 2, 0.0) / ring.normal_module, 4)


def made(task: SearchTask, kind: SetType, teeth: SetTeeth) -> tuple[list[GearPair], float] | None:
    """Both pairs of real gears and the diameter over all of them; None where they cannot be."""
    helix = task.helix_angle
    meshes = (Mesh(teeth.a, teeth.rim_a, task.modules[0], helix), Mesh(teeth.b, teeth.rim_b, task.modules[1], helix))
    distance = chosen_distance(meshes)
    if distance is None:
        return None
    shifts = [rim_shift(mesh, distance) for mesh in meshes]
    tips = [min((distance - mesh.reference) / mesh.module - mesh.shift_sum(distance), 0.0) * (mesh.sign > 0) for mesh in meshes]
    rim_tips = tips
    if kind is A:
        shifts, rim_tips = [shifts[0]] * 2, [min(tips)] * 2
    pairs, diameters = [], []
    for mesh, shift, tip, rim_tip in zip(meshes, shifts, tips, rim_tips, strict=True):
        common = {"normal_module": mesh.module, "face_width": task.width}
        own = mesh.shift_sum(distance) - shift
        try:
            rim = Gear(teeth=mesh.rim, profile_shift=shift, tip_alteration=rim_tip, helix_angle=-helix, **common)
            central = Gear(teeth=mesh.central, profile_shift=own, tip_alteration=tip, helix_angle=mesh.sign * helix, **common)
            if mesh.sign < 0:
                central = replace(central, tip_alteration=clear(central, rim, distance))
            pair = GearPair(pinion=rim, wheel=central, centre_distance=mesh.sign * distance)
        except GeometryError:
            return None
        if rim.undercut or (mesh.sign > 0 and central.undercut) or pair.transverse_contact_ratio < 1:
            return None
        margins = pair.interference_margins
        if margins and min(margins.involute, margins.trochoid, *pair.tip_clearances) < 0:
            return None
        pairs.append(pair)
        diameters += [2 * distance + rim.tip_diameter, abs(central.root_diameter) if mesh.sign < 0 else 0.0]
    return pairs, max(diameters)


def all_teeth(task: SearchTask, kind: SetType) -> Iterator[SetTeeth]:
    planets, rings = (range(low, high + 1) for low, high in (task.teeth, task.ring_teeth))
    inner = [-teeth for teeth in rings]
    for a in inner if kind is D else planets:
        for rim_a, rim_b, b in product(planets, planets, planets if kind is C else inner):
            if (kind is A and rim_b != rim_a) or (kind is B and rim_a == rim_b and task.module_2 is None):
                continue
            yield SetTeeth(a, rim_a, rim_b, b)


def ratio_of(kind: SetType, teeth: SetTeeth) -> float | None:
    """A and B: sun in, carrier out, ring fixed. C and D: carrier in, second out, first fixed."""
    basic = teeth.rim_a * teeth.b / (teeth.a * teeth.rim_b)
    if basic == 1:
        return None
    return 1 - basic if kind in (A, B) else 1 / (1 - 1 / basic)


def loops(task: SearchTask) -> list[tuple[object, ...]]:
    """Keys that rank, and last type and teeth with the number of planets."""
    found = []
    for kind in task.types:
        for teeth in all_teeth(task, kind):
            if (ratio := ratio_of(kind, teeth)) is None or abs(ratio / task.ratio - 1) > task.tolerance / 100:
                continue
            if (built := made(task, kind, teeth)) is None:
                continue
            for planets in range(task.planets[0], task.planets[1] + 1):
                found += key_of(task, kind, teeth, ratio, built, planets)
    return sorted(found)


def key_of(
    task: SearchTask, kind: SetType, teeth: SetTeeth, ratio: float, built: tuple[list[GearPair], float], planets: int
) -> list[tuple[object, ...]]:
    pairs, diameter = built
    equal = [math.tau * number / planets for number in range(planets)]
    if max(map(abs, fit_planets(teeth, equal).misfits)) > 1e-6:
        return []
    apart = 2 * abs(pairs[0].centre_distance) * math.sin(math.pi / planets)
    if planets > 1 and apart < max(pair.pinion.tip_diameter for pair in pairs) + task.least_distance:
        return []
    if task.diameter is not None and diameter > task.diameter:
        return []
    in_phase = (teeth.a % planets == 0) + (teeth.b % planets == 0)
    common = math.gcd(teeth.a, teeth.rim_a) * math.gcd(teeth.b, teeth.rim_b)
    sizes = tuple(map(abs, teeth))
    deviation = round(abs(ratio / task.ratio - 1), 12)
    kept = efficiency_of(task, kind, teeth)
    return [(deviation, round(diameter, 6), in_phase, common, -round(kept, 9), planets, *sizes, kind.value)] if kept > 0 else []


def efficiency_of(task: SearchTask, kind: SetType, teeth: SetTeeth) -> float:
    fixed, driving, driven = ("b", "a", "carrier") if kind in (A, B) else ("a", "carrier", "b")
    train = unchecked_set(*teeth, stepped=kind is not A, fixed=fixed, input=driving, output=driven)
    return efficiency(train, task.mesh_efficiency)


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
        ({"fixed": "sun", "input": "sun"}, "fixed = 'sun': must be another member"),
        ({"types": ()}, "types = ()"),
        ({"module_2": 2.0}, "module_2 = 2 mm: is of types B, C and D"),
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
