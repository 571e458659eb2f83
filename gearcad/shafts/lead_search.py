"""Search of lead crowning and helix angle modification that spread the load over the face of a mesh on its shafts."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from gearcad.core.records import Floats, Role
from gearcad.shafts.face_load import MeshOnShafts

_STEPS = (16, 4, 1)
"""Steps (µm) of the search, one after the other."""

_MOST_CROWNING = 200
_MOST_HELIX = 1000
"""Largest amounts (µm)."""

_CROWNING_PRICE = 1e-4
"""Permitted rise of K_Hbeta for each µm of crowning that is saved: crowning that nothing asks for is left out."""


@dataclass(frozen=True)
class LeadProposal:
    """Amounts (whole µm) of the pinion in place of its own, and K_Hbeta of the worse side before and after."""

    lead_crowning: float
    helix_angle_modification: float
    before: float
    after: float


def propose_lead(mesh: MeshOnShafts, sides: tuple[float, ...]) -> LeadProposal:
    """Return the pinion's lead crowning and helix angle modification of the least K_Hbeta under the load of a mesh.

    `sides` are misalignments (µm over the face) by manufacture, added to that of the mesh: the worst of them counts. Other
    modifications of both gears stay.
    """
    fixed = mesh.given_gap - mesh.lead_gap(Role.PINION)
    own = replace(mesh.pair.pinion.modification, lead_crowning=0.0, helix_angle_modification=0.0)
    bare = mesh.lead_gap(Role.PINION, own)
    crowned = mesh.lead_gap(Role.PINION, replace(own, lead_crowning=1.0)) - bare
    turned = mesh.lead_gap(Role.PINION, replace(own, helix_angle_modification=1.0)) - bare
    tilt = mesh.places / mesh.width / 1000
    known: dict[tuple[int, int], float] = {}

    def worst(gap: Floats) -> float:
        return max(float(mesh.carried(gap + side * tilt)[0].max()) for side in sides) / mesh.mean_load

    def factor(place: tuple[int, int]) -> float:
        if place not in known:
            known[place] = worst(fixed + bare + place[0] * crowned + place[1] * turned)
        return known[place]

    def price(place: tuple[int, int]) -> float:
        return factor(place) + _CROWNING_PRICE * place[0]

    best = (0, _start(mesh, fixed + bare, turned))
    for step in _STEPS:
        while True:
            beside = [(best[0] + step * i, best[1] + step * j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
            inside = [each for each in beside if 0 <= each[0] <= _MOST_CROWNING and abs(each[1]) <= _MOST_HELIX]
            found = min(inside, key=lambda each: (price(each), each != best))
            if price(found) >= price(best):
                break
            best = found
    return LeadProposal(float(best[0]), float(best[1]), worst(mesh.given_gap), factor(best))


def _start(mesh: MeshOnShafts, gap: Floats, turned: Floats) -> int:
    """Return the helix angle modification (whole µm) that makes up for the slope of shafts and gap under an even load."""
    slope = mesh.misalignment_of_shafts / mesh.width / 1000 + float(np.polyfit(mesh.places, gap, 1)[0])
    each = float(np.polyfit(mesh.places, turned, 1)[0])
    return int(np.clip(round(-slope / each), -_MOST_HELIX, _MOST_HELIX))
