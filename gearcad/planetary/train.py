"""PlanetaryTrain: a set of planets with one carrier, of any type, and the pairs before and behind it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

from gearcad.errors import GeometryError, ParameterError, require_name
from gearcad.notice import Notice
from gearcad.planetary.assembly import check_angles, check_assembly, check_errors
from gearcad.planetary.coaxial import settle_centre_distance
from gearcad.planetary.document import train_document
from gearcad.planetary.heights import settle_heights
from gearcad.planetary.members import Carrier, Central, PairStage, Rim
from gearcad.planetary.phases import MeshPhases, mesh_phases
from gearcad.planetary.poses import TrainPose, train_pose
from gearcad.planetary.shafts import check_shafts
from gearcad.planetary.speeds import speeds
from gearcad.planetary.train_data import TrainData
from gearcad.planetary.train_notices import train_notices
from gearcad.reprs import concise
from gearcad.schema import require_fields

__all__ = ["PlanetaryTrain"]


@dataclass(frozen=True, kw_only=True)
class PlanetaryTrain(TrainData):
    """Planets on one carrier between two centrals: types A to D are one class, simple or stepped, any member fixed or none.

    Lengths in mm, angles in degrees, speeds in rpm. Raises ParameterError, and GeometryError where it cannot be assembled.
    """

    __repr__ = concise

    def __post_init__(self) -> None:
        require_name("name", self.name)
        self._check_parts()
        require_fields(self)
        self._check_names()
        check_shafts(self)
        check_angles(self)
        settle_heights(self)
        settle_centre_distance(self)
        check_assembly(self)
        check_errors(self)  # last: another number of planets is looked at for its assembly first

    @property
    def ratio(self) -> float | None:
        """i, speed of the input over that of the output; None of a differential, where a second speed decides it."""
        if self.fixed is None:
            return None
        found = speeds(self, {self.input: 1.0}).members
        return found[self.input] / found[self.output]

    def to_dict(self) -> dict[str, Any]:
        """What is given and derived, for JSON (the gears have their own)."""
        return {"ratio": self.ratio, **train_document(self)}

    def _check_parts(self) -> None:
        """The right number of parts of the right types."""
        for name, kind, least, most in (("centrals", Central, 2, 2), ("rims", Rim, 1, 2), ("stages", PairStage, 0, 8)):
            given = getattr(self, name)
            if not isinstance(given, tuple) or not all(isinstance(each, kind) for each in given):
                raise ParameterError(name, given, f"must be a tuple of {kind.__name__}")
            if not least <= len(given) <= most:
                count = f"{least}" if least == most else f"{least} to {most}"
                raise ParameterError(name, len(given), f"must be {count}")
        if not isinstance(self.carrier, Carrier):
            raise ParameterError("carrier", self.carrier, "must be a Carrier")

    def _check_names(self) -> None:
        """Every name once, and each that is spoken of is there."""
        rims = [rim.name for rim in self.rims]
        shafts = [*self.members, *(end for stage in self.stages for end in (stage.pinion, stage.wheel))]
        named = [*self.members, *rims]
        for name in named:
            if named.count(name) > 1:
                raise ParameterError("name", name, "must be given once: members and rims need names of their own")
        for central in self.centrals:
            if central.meshes not in rims:
                raise ParameterError(f"{central.name}.meshes", central.meshes, f"must be {' or '.join(rims)}")
        if unused := set(rims) - {central.meshes for central in self.centrals}:
            raise GeometryError("rims", min(unused), "must mesh with a central")
        for role in ("input", "output", "fixed"):
            value = getattr(self, role)
            if value not in shafts and not (role == "fixed" and value is None):
                raise ParameterError(role, value, f"must be {', '.join(dict.fromkeys(shafts))}")
        if len({self.input, self.output, self.fixed}) < 3:
            raise ParameterError("output", self.output, "must be another member than input and fixed")

    def pose(self, carrier_angle: float = 0.0, central_turn: float = 0.0) -> TrainPose:
        """All gears in mesh, with the carrier at an angle and the fixed central (or else the second) turned (deg)."""
        return train_pose(self, carrier_angle, central_turn)

    @cached_property
    def phases(self) -> dict[str, MeshPhases]:
        """Of both meshes by name, at carrier angle 0, where the input turns counter-clockwise and drives (`mesh_phases`)."""
        return mesh_phases(self)

    @cached_property
    def notices(self) -> tuple[Notice, ...]:
        """What to know before making it."""
        return tuple(train_notices(self))
