"""Random planetary sets of types A to D, spur and helical, simple and stepped, that can be assembled or not."""

from __future__ import annotations

import math
from random import Random
from typing import Any

from hypothesis import strategies as st

from gearcad import BasicRack, Gear
from gearcad.core.records import PerGear
from gearcad.geometry.pair_data import profile_shift_sum, zero_backlash_centre_distance
from gearcad.planetary import Central, PlanetaryTrain, Rim
from gearcad.planetary.train import most_planets
from gearcad.planetary.train_data import TrainData

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
