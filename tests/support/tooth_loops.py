"""All sets for a ratio by plain loops over whole numbers and real gears, one by one: what a search is held against."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from typing import NamedTuple

from gearcad.core.errors import GeometryError
from gearcad.core.records import PerGear
from gearcad.geometry import Gear, GearPair
from gearcad.geometry.pair_data import profile_shift_sum, zero_backlash_centre_distance
from gearcad.planetary.members import SetType
from gearcad.planetary.power import efficiency
from gearcad.planetary.tooth_numbers import SearchTask
from gearcad.planetary.train_data import SetTeeth, fit_planets
from support.sets import unchecked_set

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
