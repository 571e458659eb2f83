"""TrainData: what one gives of a planetary train, and what follows from it by formula."""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Annotated, Literal

from gearcad.geometry import Gear
from gearcad.geometry.derived import NOT_GIVEN
from gearcad.planetary.fitting import SetTeeth, permitted_steps
from gearcad.planetary.members import Carrier, Central, PairStage, Rim
from gearcad.planetary.mesh import SetMesh, SetType
from gearcad.ranges import Range, Whole
from gearcad.schema import Words

__all__ = ["ADJUSTED", "EQUAL", "PERMITTED", "TrainData"]

EQUAL: Literal["equal"] = "equal"
"""Planets at equal angles."""

PERMITTED: Literal["permitted"] = "permitted"
"""Planets where the teeth let them stand, as near to equal angles as can be."""

ADJUSTED: Literal["adjusted"] = "adjusted"
"""A clocking of each planet by itself."""

ANGLE_ROUNDING = 1e-3
"""Degrees between an angle as it is given and where the teeth fit that come from printed digits."""


@dataclass(frozen=True, kw_only=True)
class TrainData:
    """The fields of a `PlanetaryTrain`, unchecked. Lengths in mm, angles in degrees.

    `centrals` are two, each of which meshes with a rim of every planet; `rims` one, or two of a stepped planet. `fixed`,
    `input` and `output` are names of centrals, of the carrier, or of the free shaft of a stage; without `fixed` it is a
    differential. `centre_distance` is a magnitude, of both meshes; not given it is the one without backlash.
    """

    name: Annotated[str, Words("name")] = "train"
    planets: Annotated[int, Whole(1, 24), Words("number of planets", "N")]
    centrals: tuple[Central, ...]
    rims: tuple[Rim, ...]
    carrier: Carrier = field(default_factory=Carrier)
    input: Annotated[str, Words("input member")]
    output: Annotated[str, Words("output member")]
    fixed: Annotated[str | None, Words("fixed member")] = None
    stages: tuple[PairStage, ...] = ()
    centre_distance: Annotated[float, Range("mm", 0.0, None, ends="(]"), Words("centre distance", "a", "5.2")] = NOT_GIVEN
    planet_angles: Annotated[
        tuple[float, ...] | Literal["equal", "permitted"], Range("deg", -360.0, 360.0), Words("angles of the planets", "ψ")
    ] = EQUAL
    tip_distance: Annotated[float, Range("mm", 0.0, None), Words("distance planets' tips must keep")] = 0.0

    @cached_property
    def meshes(self) -> tuple[SetMesh, SetMesh]:
        """The mesh of each central with its rim, in the order of the centrals. Raises GeometryError where one cannot mesh."""
        first, second = (SetMesh.of(central, self.rim_of(central), float(self.centre_distance)) for central in self.centrals)
        return first, second

    def rim_of(self, central: Central) -> Rim:
        """The rim that a central meshes with."""
        return next(rim for rim in self.rims if rim.name == central.meshes)

    @property
    def gears(self) -> dict[str, Gear]:
        """Those of the set by the names of their members and rims, then those of the stages by their own."""
        of_set = {central.name: central.gear for central in self.centrals} | {rim.name: rim.gear for rim in self.rims}
        return of_set | {gear.name: gear for stage in self.stages for gear in stage.pair.gears}

    @property
    def stepped(self) -> bool:
        """Whether the planets have two rims."""
        return len(self.rims) == 2

    @property
    def adjusted(self) -> bool:
        """Whether the rims of each planet are turned against each other by themselves until they fit."""
        return any(rim.clocking == ADJUSTED for rim in self.rims)

    @property
    def set_type(self) -> SetType:
        """A to D, by the rings among the centrals, and by whether the planets are stepped."""
        rings = sum(central.gear.internal for central in self.centrals)
        if rings == 1:
            return SetType.B if self.stepped else SetType.A
        return SetType.D if rings else SetType.C

    @property
    def basic_ratio(self) -> float:
        """i_0 = (w_a - w_c)/(w_b - w_c) = z_2 z_b/(z_a z_2') with the carrier at rest, a and b the centrals in their order."""
        a, b = self.meshes
        return (a.rim.gear.teeth * b.central.gear.teeth) / (a.central.gear.teeth * b.rim.gear.teeth)

    @property
    def teeth(self) -> SetTeeth:
        """z_a, z_2, z_2', z_b, with signs."""
        a, b = self.meshes
        return SetTeeth(a.central.gear.teeth, a.rim.gear.teeth, b.rim.gear.teeth, b.central.gear.teeth)

    @property
    def positions(self) -> int:
        """q = |z_a z_2' - z_2 z_b|/gcd(z_2, z_2'): planets fit at multiples of a full turn by q, and nowhere else."""
        return self.teeth.positions

    @cached_property
    def angles(self) -> tuple[float, ...]:
        """Where the planets stand on the carrier (degrees); given ones exactly where the teeth have them."""
        if self.planet_angles == EQUAL or not self.positions:
            return tuple(360 * number / self.planets for number in range(self.planets))
        step = 360 / self.positions
        if self.planet_angles == PERMITTED:
            return tuple(steps * step for steps in permitted_steps(self.positions, self.planets))
        first, *_ = given = [float(angle) for angle in self.planet_angles]
        if self.adjusted:
            return tuple(given)
        exact = [first + round((angle - first) / step) * step for angle in given]
        return tuple(near if abs(near - angle) <= ANGLE_ROUNDING else angle for near, angle in zip(exact, given, strict=True))

    @property
    def unbalance(self) -> float:
        """|sum exp(i psi)|: 0 where the planets balance each other, 1 of a planet alone."""
        return abs(sum(cmath.exp(1j * math.radians(angle)) for angle in self.angles))

    @property
    def members(self) -> tuple[str, ...]:
        """The members of the set: both centrals, and the carrier."""
        return (*(central.name for central in self.centrals), self.carrier.name)
