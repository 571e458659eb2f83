"""Random planetary sets of types A to D, and all sets for a ratio by plain loops."""

import math
from collections.abc import Iterator
from dataclasses import replace
from itertools import product
from random import Random
from typing import Any, NamedTuple

from hypothesis import strategies as st

from gearcad import BasicRack, Gear
from gearcad.core.errors import GeometryError
from gearcad.core.records import PerGear
from gearcad.geometry import GearPair
from gearcad.geometry.pair_data import profile_shift_sum, zero_backlash_centre_distance
from gearcad.planetary import Central, PlanetaryTrain, Rim
from gearcad.planetary.members import SetType
from gearcad.planetary.power import efficiency
from gearcad.planetary.tooth_numbers import SearchTask
from gearcad.planetary.train import most_planets
from gearcad.planetary.train_data import SetTeeth, TrainData, fit_planets
from support.planetary_trains import unchecked_set

POSITION = 70.0
"""Height (mm) of the second rim: clear of all widths that are drawn."""


def train_inputs() -> st.SearchStrategy[dict[str, Any]]:
    """Numbers of a set; the second mesh's module and shift follow from the first one's centre distance.

    Drawn evenly from a seed: least and equal numbers, which hypothesis prefers, make sets that are too simple.
    """
    return st.integers(0, 2**48).map(_inputs)


def _inputs(seed: int) -> dict[str, Any]:
    random = Random(seed)

    def helix() -> float:
        return random.choice([0.0, 1.0, -1.0]) * random.uniform(1, 28)

    return {
        "seed": seed,
        "kind": random.choice("ABCD"),
        "rims": (random.randint(14, 34), random.randint(14, 34)),
        "suns": (random.randint(14, 45), random.randint(14, 45)),
        "more": (random.randint(24, 70), random.randint(24, 70)),
        "changed": random.choice([0, 0, 0, 1, -1]),
        "module": random.choice([1.0, 2.0, 3.0]),
        "helix": (helix(), helix()),
        "shifts": (random.uniform(0.0, 0.45), random.uniform(0.05, 0.5), random.uniform(0.05, 0.5)),
        "wider": random.uniform(-0.25, 0.35),
        "thinning": tuple(random.choice([0.0, 0.01, 0.03, 0.05]) for _ in range(4)),
        "widths": tuple(random.uniform(10, 30) for _ in range(4)),
        "clocking": random.choice([0.0, random.uniform(-20, 20), random.uniform(-20, 20), "adjusted"]),
        "head": random.choice([1.0, 0.85, 0.7]),
        "crowd": random.choice([0, 0, 0, 0, 0, 0, 0, 1]),
        "share": random.uniform(0, 1),
        "angles": random.choice(["equal", "permitted"]),
        "carrier_angle": random.uniform(0, 360),
    }


def build_train(inputs: dict[str, Any], kind: type[TrainData] = PlanetaryTrain) -> TrainData:
    """The train, or (TrainData) the same unchecked. Raises GearcadError where a gear or the train is refused."""
    suns, rims, more = inputs["suns"], inputs["rims"], inputs["more"]
    stepped, m, x = inputs["kind"] != "A", inputs["module"], inputs["shifts"]
    first = -(rims[0] + more[0]) if inputs["kind"] == "D" else suns[0]
    second_rim = rims[1] if stepped else rims[0]
    second = {"A": -(suns[0] + 2 * rims[0] + inputs["changed"]), "C": suns[1]}.get(inputs["kind"], -(second_rim + more[1]))
    helix = inputs["helix"] if stepped else (inputs["helix"][0],) * 2
    central_a, rim_a = _mates(first, rims[0], m, x[0] if first > 0 else -x[1] - 0.1, x[1], helix[0], inputs, 0)
    distance = abs(_distance(first, rims[0], m, central_a.profile_shift + rim_a.profile_shift, helix[0]))
    if stepped:
        cosine = math.cos(math.radians(helix[1]))
        m = 2 * (distance - inputs["wider"] * m * (-1 if second < 0 else 1)) * cosine / abs(second + second_rim)
    shift = x[2] if stepped else x[1]
    side = -1 if second < 0 else 1
    total = profile_shift_sum(
        normal_module=m,
        teeth=PerGear(second_rim, second),
        helix_angle=helix[1],
        pressure_angle=20.0,
        centre_distance=side * distance,
    )
    central_b, rim_b = _mates(second, second_rim, m, total - shift, shift, helix[1], inputs, 2)
    named = [Rim(name="rim_a", gear=rim_a, axial_position=0.0)]
    if stepped:
        named.append(Rim(name="rim_b", gear=rim_b, axial_position=POSITION, clocking=inputs["clocking"]))
    centrals = Central(name="a", gear=central_a, meshes="rim_a"), Central(name="b", gear=central_b, meshes=named[-1].name)
    fields = {"planet_angles": inputs["angles"], "centre_distance": distance, "fixed": "b", "input": "a", "output": "carrier"}
    parts = {"centrals": centrals, "rims": tuple(named)}
    most = most_planets(TrainData(planets=1, **parts, **fields))
    planets = most + 1 if inputs["crowd"] else min(max(most, 2), 2 + int(5 * inputs["share"]))
    return kind(planets=planets, **parts, **fields)


def _mates(
    central: int, rim: int, m: float, shift: float, rim_shift: float, helix: float, inputs: dict[str, Any], at: int
) -> tuple[Gear, Gear]:
    """A central and its rim."""
    thin, widths = inputs["thinning"], inputs["widths"]

    def gear(teeth: int, x: float, beta: float, index: int) -> Gear:
        return Gear(
            teeth=teeth,
            normal_module=m,
            profile_shift=x,
            helix_angle=beta,
            face_width=widths[index],
            tooth_thinning=thin[index] * m,
            rack=BasicRack(addendum=inputs["head"] if teeth < 0 else 1.0),
        )

    # The rim of a plain planet is the same in both meshes.
    rim_index = 1 if inputs["kind"] == "A" else at + 1
    own = gear(rim, rim_shift, helix, rim_index)
    return gear(central, shift, helix if central < 0 else -helix, at), own


def _distance(central: int, rim: int, m: float, shift_sum: float, helix: float) -> float:
    return zero_backlash_centre_distance(
        normal_module=m, teeth=PerGear(rim, central), helix_angle=helix, pressure_angle=20.0, shift_sum=shift_sum
    )


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
