"""Mesh stiffness by finite element contact, as in the structural check: of a plane section, and of solid bodies."""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import ClassVar, NamedTuple

import numpy as np

from gearcad.arrays import Floats
from gearcad.contact.plane.elasticity import Plane
from gearcad.contact.plane.limits import thin_faces
from gearcad.contact.plane.pair import PlanePair, plane_pair
from gearcad.contact.shared.engaged import EngagedPair
from gearcad.contact.shared.loaded_left import loaded_left
from gearcad.contact.solid.cost import POSITION_SECONDS
from gearcad.contact.solid.pair import SolidPair, SolidSizes, expected_bodies, solid_pair
from gearcad.errors import GeometryError
from gearcad.load import Load
from gearcad.mesh_cycle import MeshCycle
from gearcad.notice import Notice
from gearcad.per_gear import PerGear
from gearcad.progress import Expected
from gearcad.stiffness.method import StiffnessMethod, left_out

__all__ = ["ContactMethod", "PlaneStrainContact", "PlaneStressContact", "SolidContact"]


_STEP = 0.02
"""Relative change of the torque on both sides of the load between which the tangent stiffness is taken."""


_SOLUTIONS = 2
"""What all loads at a position take, for slopes and load dependence, over what the first takes."""


class _Position(NamedTuple):
    """One under load: approach, its rigid part and the parts of pinion and wheel (mm), forces of the pairs (N)."""

    approach: float
    rigid: float
    parts: PerGear[float]
    forces: Mapping[int, float]


@dataclass(frozen=True, kw_only=True)
class ContactMethod(StiffnessMethod):
    """Flexible gears pressed together at every position; pairs of teeth share the load as their bodies and gaps make them."""

    holds = ("contact under each pair's own load", "teeth", "bodies down to where they are held", "neighbouring teeth")

    @abstractmethod
    def _position(self, roll_angle: float, torque: float) -> _Position:
        """The mesh at a roll angle (deg) under a torque on the pinion (N·m), signed."""

    @abstractmethod
    def _single(self, torque: float) -> float:
        """Greatest stiffness of one pair alone (N/(mm·µm))."""

    def _cycle(self, load: Load, count: int) -> MeshCycle:
        torque, force = math.copysign(self.torque(load), load.torque), self.force(load)
        angles = EngagedPair(self.mounted).roll_angles(count)
        # All torques at one position after another: what a model knows of flanks there serves all of them.
        loads = [torque * (1 + sign * _STEP) for sign in (0, -1, 1)]
        found, softer, harder = zip(
            *([self._position(angle, each) for each in loads] for angle in angles.tolist()), strict=True
        )
        further = np.array([more.approach - less.approach for more, less in zip(harder, softer, strict=True)])
        approach, rigid = (np.array([getattr(each, name) for each in found]) for name in ("approach", "rigid"))
        parts = np.array([each.parts for each in found])
        pairs = tuple(sorted(set().union(*(each.forces for each in found))))
        shares = np.array([[each.forces.get(pair, 0.0) for pair in pairs] for each in found])
        gaps = approach - rigid - parts.sum(1)
        um = 1000 / force
        return MeshCycle(
            **self.inputs(load),
            roll_angle=np.r_[angles, angles[0] + 360 / self.mounted.pinion.teeth],
            mesh_stiffness=_closed(1 / (um * (approach - rigid))),
            tangent_stiffness=_closed(2 * _STEP / (um * further)),
            transmission_error=_closed(1000 * approach),
            pairs=pairs,
            load_share=_closed(shares / shares.sum(1, keepdims=True)),
            compliance_parts={
                "pinion": _closed(um * parts[:, 0]),
                "wheel": _closed(um * parts[:, 1]),
                "gaps closed": _closed(um * gaps),
            },
            single_stiffness=self._single(torque) * self.width,
        )

    def notices(self, load: Load) -> Iterator[Notice]:
        """None: bodies and flanks are taken as they are."""
        return iter(())


@dataclass(frozen=True, kw_only=True)
class PlaneContact(ContactMethod):
    """Contact in the transverse section, for spur gears."""

    bodies: PlanePair | None = field(default=None, repr=False)
    """Those of a check, if there was one; else they are made."""

    plane: ClassVar[Plane]
    default_positions: ClassVar[int] = 120
    seconds: ClassVar[float] = 3.0

    def __post_init__(self) -> None:
        super().__post_init__()
        if helix := self.pair.pinion.helix_angle:
            permitted = f"must be 0 for {self.name}: lines of contact of helical teeth run across the flank, as 3d has them"
            raise GeometryError("pair.helix_angle", helix, permitted, "deg")

    @cached_property
    def model(self) -> PlanePair:
        """The bodies, factorised."""
        if self.bodies is not None:
            return self.bodies
        error = self.mounting.pitch_error
        return plane_pair(self.mounted, self.material, plane=self.plane, body=self.body, pitch_error=error)

    def _position(self, roll_angle: float, torque: float) -> _Position:
        found = self.model.solve(roll_angle, torque)
        forces = {
            pair.tooth: float(force) * self.width for pair, force in zip(found.pairs, found.forces, strict=True) if force > 0
        }
        return _Position(found.approach, self.model.rigid_approach(roll_angle), found.parts, forces)

    def _single(self, torque: float) -> float:
        return self.model.single_stiffness(torque)

    def notices(self, load: Load) -> Iterator[Notice]:
        """Of thin gears, and of what a section leaves out."""
        yield from thin_faces(self.mounted, self.material, self.plane)
        along = any(gear.modification.along_face for gear in self.mounted.gears)
        found = [
            *(["modifications along the face width"] if along else []),
            *(["misalignment"] if self.mounting.tilted else []),
        ]
        yield from left_out(found)


@dataclass(frozen=True, kw_only=True)
class PlaneStressContact(PlaneContact):
    """FE contact in plane stress: a section that is free to change its thickness."""

    name = "plane-stress"
    title = "FE contact, plane stress"
    plane = Plane.STRESS


@dataclass(frozen=True, kw_only=True)
class PlaneStrainContact(PlaneContact):
    """FE contact in plane strain: a section of a gear that is wide."""

    name = "plane-strain"
    title = "FE contact, plane strain"
    plane = Plane.STRAIN


@dataclass(frozen=True, kw_only=True)
class SolidContact(ContactMethod):
    """FE contact of solid bodies over their face widths, along the lines of contact."""

    name = "3d"
    title = "FE contact, solid bodies"
    default_positions: ClassVar[int] = 60
    load_positions: ClassVar[int] = 0  # the bodies' responses are known there

    bodies: SolidPair | None = field(default=None, repr=False)
    """Those of a check, if there was one, for the sign of torque that it had; else they are made."""

    def model(self, torque: float) -> SolidPair:
        """The bodies, condensed; under a negative torque on the pinion those of the mirrored pair."""
        if self.bodies is not None:
            return self.bodies
        return self._loaded_left if torque > 0 else self._loaded_right

    @cached_property
    def _loaded_left(self) -> SolidPair:
        return self._made(1.0)

    @cached_property
    def _loaded_right(self) -> SolidPair:
        return self._made(-1.0)

    def _made(self, torque: float) -> SolidPair:
        """The bodies for the sign of a torque."""
        mounting, share = replace(self.mounting, centre_distance_change=0.0), self._bodies.seconds / self.expected.seconds
        pair = loaded_left(self.mounted, torque)
        return solid_pair(pair, self.material, body=self.body, mounting=mounting, tell=lambda done: self.tell(share * done))

    @cached_property
    def _bodies(self) -> Expected:
        return expected_bodies(self.mounted, self.body, SolidSizes())

    @property
    def expected(self) -> Expected:
        positions = self.positions or self.default_positions
        return Expected(self._bodies.seconds + _SOLUTIONS * positions * POSITION_SECONDS, self._bodies.memory)

    def _position(self, roll_angle: float, torque: float) -> _Position:
        model = self.model(torque)
        found = model.solve(roll_angle, torque)
        flat, forces = math.cos(model.helix), dict[int, float]()
        for line, cells in zip(found.given.lines, found.given.split(found.forces), strict=True):
            if cells.sum() > 0:
                forces[line.tooth] = float(cells.sum()) * flat
        return _Position(found.approach / flat, found.rigid / flat, found.parts.map(lambda part: part / flat), forces)

    def _single(self, torque: float) -> float:
        return self.model(torque).single_stiffness(torque)


def _closed(values: Floats) -> Floats:
    """Values (n, ...) over a base pitch, and the first again at its end."""
    return np.concatenate([values, values[:1]])
