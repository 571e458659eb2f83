"""Load over the face on shafts that give way: K_Hbeta of the solid contact beside annex E and Method C of ISO 6336-1."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from gearcad.check.task import CheckTask, method_c_on_shafts
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.core.records import Floats, JsonObject, Notice, PerGear, Role, freeze

if TYPE_CHECKING:
    from gearcad.shafts.beam import ShaftState
    from gearcad.shafts.face_load import MeshOnShafts

_PLACES = 5
"""Places over the face at which the state of shafts is told."""


@dataclass(frozen=True, kw_only=True)
class LoadOnShafts:
    """The load over the face of a solid cycle on shafts, and of the same pair on rigid ones.

    `across` (n,) in mm from the middle of the common face width; `load` and `rigid_load` (n,) in N/mm, transverse, mean of the
    even positions; `gap` (n,) in µm along the base tangent, which the shafts leave on that mean, from its least on;
    `face_load_factor` and `rigid_face_load_factor` are K_Hbeta. `approach` and `turn` (µm along the base tangent) are the means
    of what shafts give way under load, and of their twist up to the middles of the faces. `mesh` is the mesh as annex E has it.
    `method_c` are f_sh (µm) and K_Hbeta of Method C.
    """

    mesh: MeshOnShafts
    across: Floats
    load: Floats
    rigid_load: Floats
    gap: Floats
    face_load_factor: float
    rigid_face_load_factor: float
    approach: float
    turn: float
    method_c: tuple[float, float]

    def __post_init__(self) -> None:
        freeze(self)

    @cached_property
    def annex_e_on_rigid_shafts(self) -> float:
        """K_Hbeta by annex E of the same mesh on rigid shafts."""
        return replace(self.mesh, shafts=PerGear(None, None)).face_load_factor

    @property
    def annex_e_load(self) -> Floats:
        """Line load (n,) in N/mm by annex E at the same places."""
        return np.asarray(np.interp(self.across, self.mesh.places, self.mesh.line_load), float)

    @cached_property
    def states(self) -> dict[Role, ShaftState]:
        """The shafts under the load of the solid contact; rigid ones are left out."""
        load = np.interp(self.mesh.places, self.across, self.load)
        load = load * self.mesh.mean_load / load.mean()
        found = {role: self.mesh.state(role, load) for role in Role}
        return {role: state for role, state in found.items() if state is not None}

    def face_states(self, role: Role) -> Iterator[tuple[float, Floats]]:
        """Yield places (mm from the middle of the face) with displacement and turn (6,) of a shaft there (mm, rad)."""
        places = self.mesh.places[np.linspace(0, self.mesh.slices - 1, _PLACES).round().astype(int)]
        for place in places.tolist():
            yield place, self.states[role].at(self.mesh.positions.pick(role) + place)

    def to_dict(self) -> JsonObject:
        """Return the content of "shafts" in check.json."""
        deflection, factor = self.method_c
        return {
            "K_Hbeta": {
                "solid": self.face_load_factor,
                "solid_rigid_shafts": self.rigid_face_load_factor,
                "annex_E": self.mesh.face_load_factor,
                "annex_E_rigid_shafts": self.annex_e_on_rigid_shafts,
                "method_C": factor,
            },
            "f_sh": {"annex_E": self.mesh.misalignment_of_shafts, "method_C": deflection},
            "across": self.across.tolist(),
            "line_load": self.load.tolist(),
            "line_load_rigid_shafts": self.rigid_load.tolist(),
            "line_load_annex_E": self.annex_e_load.tolist(),
            "gap": self.gap.tolist(),
            "approach": self.approach,
            "turn": self.turn,
            **{role.value: self._shaft(role) for role in self.states},
        }

    def _shaft(self, role: Role) -> JsonObject:
        state = self.states[role]
        reactions = [
            {
                "name": bearing.name,
                "position": bearing.position,
                "force": own[:3].tolist(),
                "moment": (own[3:5] / 1000).tolist(),
            }
            for bearing, own in zip(state.shaft.bearings, state.reactions, strict=True)
        ]
        return {
            "reactions": reactions,
            "face": [
                {
                    "across": place,
                    "deflection": (1000 * moved[:3]).tolist(),
                    "inclination": [1000 * float(moved[4]), -1000 * float(moved[3])],
                    "twist": float(np.degrees(moved[5])),
                }
                for place, moved in self.face_states(role)
            ],
        }


def load_on_shafts(task: CheckTask, cycle: SolidCycle) -> LoadOnShafts | None:
    """Return the load over the face of a cycle on shafts, and on rigid ones; None if the pair has none. Raises SolverError."""
    mesh, model = task.on_shafts, cycle.model
    if mesh is None or model.supports is None:
        return None
    rigid = SolidCycle.run(model.on(None), cycle.torque, len(cycle.positions))
    across, load = cycle.load_along_face
    return LoadOnShafts(
        mesh=mesh,
        across=across,
        load=load,
        rigid_load=rigid.load_along_face[1],
        gap=_gap(cycle, across, load),
        face_load_factor=cycle.face_load_factor,
        rigid_face_load_factor=rigid.face_load_factor,
        approach=float(1000 * cycle.values("support_approach").mean()),
        turn=float(1000 * cycle.values("support_turn").mean()),
        method_c=method_c_on_shafts(task),
    )


def _gap(cycle: SolidCycle, across: Floats, load: Floats) -> Floats:
    """Return the gap (n,) in µm along the base tangent that supports leave under a load (n,) in N/mm, from its least on.

    The load acts where lines of contact cross the line of action at the pitch point, which is their mean over a base pitch.
    """
    pair, supports = cycle.model.pair, cycle.model.supports
    assert supports is not None
    place = pair.path_of_contact.C
    lengths = PerGear(place, pair.base_tangent.length - place).map(lambda length: np.full(len(across), length))
    cells, flat = supports.cells(across, lengths), np.cos(cycle.model.helix)
    forces = load * cycle.model.width / len(across) / flat
    gap = (cells.gap + cells.matrix @ forces) / flat
    return np.asarray(1000 * (gap - gap.min()), float)


_THINNER = 0.99
"""Diameter of a shaft in the face over that of the gear's root below which a body is taken to be missing."""


def shaft_notices(task: CheckTask) -> Iterator[Notice]:
    """Yield what is to be known of shafts in the solid contact, and shafts that lack the body of their gear in the face."""
    mesh = task.on_shafts
    if mesh is None:
        return
    for role, shaft in mesh.shafts.items():
        if shaft is None:
            yield Notice("rigid-shaft", f"no shaft of the {role.value} is described: it is taken for rigid")
            continue
        middle, half = mesh.positions.pick(role), mesh.width / 2
        inside = [
            segment.outer_diameter
            for segment, low, high in zip(shaft.segments, shaft.ends, shaft.ends[1:], strict=False)
            if low < middle + half - 1e-6 and high > middle - half + 1e-6
        ]
        root = task.gears[role].root_diameter
        if min(inside) < _THINNER * root:
            text = (
                f"the shaft of the {role.value} is {min(inside):.4g} mm thick in the face, its gear {root:.4g} mm at the root: "
                "the body of a gear bends with its shaft, so give that segment about the reference diameter"
            )
            yield Notice("shaft-in-face", text)
