"""The edge of a tip and its mate's fillet: where bounds say that it stays off, no point of its path is inside."""

from __future__ import annotations

import random
from typing import Any

from gearcad import BasicRack, Body, Gear, GearcadError, GearPair, ShaperCutter
from gearcad.core.records import Role
from gearcad.geometry.interference import RollingEdge, deepest_cut, tip_edges

COUNT = 60


def gear(chance: random.Random, teeth: int, helix: float) -> Gear:
    given: dict[str, Any] = {"teeth": teeth, "normal_module": 1.0, "face_width": 8.0, "helix_angle": helix}
    given["profile_shift"] = chance.choice([0.0, round(chance.uniform(-0.3, 0.7), 2)])
    given["body"] = Body(tip_chamfer=chance.choice([0.0, 0.05]))
    given["rack"] = BasicRack(root_radius=chance.choice([0.0, 0.2, 0.38, "full"]), addendum=chance.choice([1.0, 1.1]))
    given["cutter"] = ShaperCutter(teeth=chance.choice([None, None, 25]))
    return Gear(**given)


def pairs() -> list[GearPair]:
    chance, found = random.Random(4), list[GearPair]()
    while len(found) < COUNT:
        helix = chance.choice([0.0, 15.0, 30.0])
        try:
            both = gear(chance, chance.randint(8, 60), helix), gear(chance, chance.randint(12, 120), -helix)
            found.append(GearPair(pinion=both[0], wheel=both[1]))
        except GearcadError:
            continue
    return found


def test_edge_that_bounds_keep_off_the_fillet_is_beside_it_everywhere() -> None:
    sure, unsure, cuts = 0, 0, 0
    for pair in pairs():
        for role in Role:
            own, mate = pair.gears.pick(role).profile, pair.gears.pick(role.mate).profile
            for radius, angle in tip_edges(mate):
                edge = RollingEdge.of(own, mate, radius, angle, pair.centre_distance, pair.working_transverse_pressure_angle)
                if edge is None or own.undercut:
                    continue
                depth = deepest_cut(own, edge.path, edge.farthest).depth
                if edge.stays_off(own.fillet):
                    sure += 1
                    assert depth < 0
                else:
                    unsure += 1
                    cuts += depth > 0
    assert sure > 2 * unsure > 0 and cuts > 0
