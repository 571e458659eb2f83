"""Two gears in mesh, each a flexible section: the model that is loaded at any position and torque."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from gearcad.contact.plane.contact import ContactSolution, solve_contact
from gearcad.contact.plane.contact_pairs import contact_pairs, touching_teeth
from gearcad.contact.plane.elasticity import Plane, PlaneElasticity
from gearcad.contact.plane.flank import PlaneCompliance, flank_compliance
from gearcad.contact.plane.ring import Ring, assemble
from gearcad.contact.plane.root import Fillets
from gearcad.contact.shared.bodies import BodyModel
from gearcad.contact.shared.engaged import FlexiblePair
from gearcad.contact.shared.holding import Support
from gearcad.contact.shared.line_of_action import line_of_action, pairs_within, rigid_approach
from gearcad.errors import GeometryError
from gearcad.geometry import Gear, GearPair
from gearcad.geometry.halves import refuse_halves
from gearcad.material import Materials, of_both
from gearcad.meshing.section import MeshSizes, mesh_sector
from gearcad.per_gear import PerGear
from gearcad.rating.hertz import half_width

__all__ = ["PlanePair", "flank_body", "plane_pair"]


_CELLS = 66
_FIRST_CELLS = 24
_WINDOW = 3.0
"""Cells in the window of contact - fewer to find out how wide it is - and its half width in Hertz half widths."""

_LEAST_SHARE = 0.03
"""Share of the load for which the window of a pair is wide enough, however little it carries."""

_SOFT = 4000.0
"""A stiffness (N/mm per mm of width) that no pair of teeth falls below: bounds how far a tip corner can get."""

_BENT = 0.02
"""How far (normal modules) teeth under great loads give way, so that pairs touch whose flanks are no further apart."""

_SINGLE = 25
"""Positions of one pair of teeth along its path of contact, among which it is stiffest."""


class KnownContacts(dict[tuple[float, float, bool], ContactSolution]):
    """Contacts by roll angle (deg), torque (N·m) and whether the middle pair is alone; grows as positions are solved."""


@dataclass(frozen=True)
class PlanePair(FlexiblePair[PlaneCompliance]):
    """Both bodies in the transverse section through the middle of the common face width."""

    known: KnownContacts = field(default_factory=KnownContacts, repr=False)

    @property
    def repeats(self) -> bool:
        """True unless the middle pair of teeth stands proud."""
        return not self.line.proud

    def with_flanks(self, pair: GearPair) -> PlanePair:
        """Return the same bodies with other modifications of an otherwise equal pair, as it is mounted."""
        return replace(self, pair=pair, line=line_of_action(pair, 1000 * self.line.proud), known=KnownContacts())

    @cached_property
    def fillets(self) -> PerGear[Fillets]:
        """Stresses of the roots of both gears, as responses to loads on their flanks."""
        return self.bodies.map(Fillets)

    @cached_property
    def modulus(self) -> float:
        """Reduced modulus of the contact (MPa): 1/E* = 1/E'_1 + 1/E'_2."""
        return 1 / (1 / self.pinion.elasticity.modulus + 1 / self.wheel.elasticity.modulus)

    def rigid_approach(self, roll_angle: float, *, single: bool = False) -> float:
        """How far (mm) the gears would approach at a roll angle (deg) before the first pair of teeth touches, unloaded."""
        return rigid_approach(self.line, self.roll_length(roll_angle), single=single)

    def solve(self, roll_angle: float, torque: float, *, single: bool = False) -> ContactSolution:
        """The contact at a roll angle (deg) and torque (N·m); `single` lets no other pair of teeth touch.

        Raises SolverError, and GeometryError where nothing can touch.
        """
        asked = roll_angle, abs(torque), single
        if (found := self.known.get(asked)) is None:
            self.require_narrow_contact(torque, self.modulus)
            found = self.known[asked] = self._solved(roll_angle, self.force(torque), single)
        return found

    def _solved(self, roll_angle: float, force: float, single: bool) -> ContactSolution:
        """The contact at a roll angle (deg) and a normal force (N per mm)."""
        farthest = self._farthest(roll_angle, force, single)
        if len(touching_teeth(self.line, self.roll_length(roll_angle), farthest, single=single)) == 1:  # it carries all
            return self._pressed(roll_angle, force, lambda _tooth: force, single, _CELLS)
        # The first solution tells what each pair carries, and so how wide its contact is.
        carried = self._pressed(roll_angle, force, lambda _tooth: force, single, _FIRST_CELLS)
        shares = dict(zip((pair.tooth for pair in carried.pairs), carried.forces.tolist(), strict=True))

        def thought(tooth: int) -> float:
            return float(max(shares.get(tooth, 0.0), _LEAST_SHARE * force))

        return self._pressed(roll_angle, force, thought, single, _CELLS, carried)

    def _pressed(
        self,
        roll_angle: float,
        force: float,
        carried: Callable[[int], float],
        single: bool,
        cells: int,
        like: ContactSolution | None = None,
    ) -> ContactSolution:
        """The contact, with windows for what each pair of teeth is thought to carry (N per mm); about `like` another one."""

        def span(tooth: int, radius: float) -> float:
            return _WINDOW * float(half_width(carried(tooth), radius, self.modulus))

        least_width = max(body.resolution for body in self.bodies)
        farthest = self._farthest(roll_angle, force, single)
        pairs = contact_pairs(self.line, self.roll_length(roll_angle), span, cells, farthest, least_width, single=single)
        if not pairs:
            raise GeometryError("roll_angle", roll_angle, "must be one at which teeth can touch", "deg")
        return solve_contact(pairs, self.bodies, force, like)

    def _farthest(self, roll_angle: float, force: float, single: bool) -> float:
        """Gap (mm) from which flanks can touch as teeth bend."""
        return self.rigid_approach(roll_angle, single=single) + force / _SOFT

    def single_stiffness(self, torque: float, count: int = _SINGLE) -> float:
        """Greatest stiffness (N/(mm·µm)) of one pair of teeth alone, at `count` places of its path of contact."""
        lengths = np.linspace(*self.pair.usable_path, count + 2)[1:-1]
        approaches = [
            self.solve(angle, torque, single=True).approach - self.rigid_approach(angle, single=True)
            for angle in self.roll_angle(lengths).tolist()
        ]
        return self.force(torque) / (min(approaches) * 1000)


def plane_pair(
    pair: GearPair,
    material: Materials,
    *,
    plane: Plane = Plane.STRAIN,
    body: BodyModel | None = None,
    sizes: MeshSizes | None = None,
    pitch_error: float = 0.0,
    solve: Callable[[Gear, Ring, PlaneElasticity], PlaneCompliance] = flank_compliance,
) -> PlanePair:
    """Mesh, assemble, factorise and `solve` both gears. Raises SolverError, ParameterError and GeometryError.

    The pair is taken as it is mounted; `pitch_error` (µm) is how far the flanks of its middle pair of teeth stand proud.
    """
    refuse_halves(pair.pinion, "contact")
    body, sizes = body or BodyModel(), sizes or MeshSizes()
    # As many neighbours as can touch at once, with one more place for a corner that touches early or late.
    neighbours = max(1, math.floor(pair.transverse_contact_ratio + 0.2))
    line = line_of_action(pair, pitch_error)
    if pair.internal:  # flanks stay close to each other beyond the path of contact: more pairs touch as teeth bend
        near = pairs_within(line, pair.path_of_contact.C, _BENT * pair.pinion.normal_module)
        neighbours = max(neighbours, near - 1)
    pinion, wheel = (
        flank_body(gear, radius, PlaneElasticity(of, plane), body, neighbours, sizes, solve, support)
        for gear, of, radius, support in zip(
            pair.gears, of_both(material), body.inner_radii(pair), body.supports(pair), strict=True
        )
    )
    return PlanePair(pair, line, PerGear(pinion, wheel))


def flank_body(
    gear: Gear,
    held_radius: float,
    elasticity: PlaneElasticity,
    body: BodyModel,
    neighbours: int,
    sizes: MeshSizes | None = None,
    solve: Callable[[Gear, Ring, PlaneElasticity], PlaneCompliance] = flank_compliance,
    support: Support | None = None,
) -> PlaneCompliance:
    """One gear, held at `held_radius` (mm), with so many `neighbours` in full on each side of the loaded tooth."""
    sizes = sizes or MeshSizes()
    if (held := body.teeth_held(gear)) is not None:
        held = max(held, 2 * neighbours + 1)
    fine, coarse = mesh_sector(gear, held_radius, sizes), mesh_sector(gear, held_radius, sizes.coarse())
    ring = assemble(
        fine, coarse, gear.tooth_count, min(neighbours, (gear.tooth_count - 1) // 2), elasticity, held, body.cuts, support
    )
    return solve(gear, ring, elasticity)
