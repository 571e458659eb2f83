"""PlanePair: two flexible sections in mesh, loaded at any position and torque.

Everything is per mm of face width, in the transverse section.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property, lru_cache
from itertools import pairwise, product

import numpy as np

from gearcad.contact.plane.flank import Fillets, PlaneCompliance, flank_compliance
from gearcad.contact.plane.rack_body import rack_body
from gearcad.contact.plane.ring import Ring, assemble
from gearcad.contact.plane.sector import Plane, PlaneElasticity
from gearcad.contact.shared.bodies import BodyModel, Support
from gearcad.contact.shared.line_of_action import (
    AS_PLACED,
    LineOfAction,
    RackLine,
    facing_gap,
    facing_pairs,
    line_of_action,
    overlap,
    pairs_within,
    rigid_approach,
    tip_places,
)
from gearcad.contact.shared.loaded import TOOTH_ORDER, FlexiblePair
from gearcad.contact.shared.local_contact import onsets, start_distance
from gearcad.contact.shared.tip_edge import LoadedTip, TipEdges
from gearcad.core.complementarity import complementary
from gearcad.core.errors import GeometryError, SolverError
from gearcad.core.records import Bools, Floats, Indices, PerGear, Role
from gearcad.geometry import Gear, GearPair, RackPair
from gearcad.geometry.gear import refuse_halves
from gearcad.geometry.tooth_friction import MeshFriction
from gearcad.material import Materials, of_both
from gearcad.meshing.outline import MeshSizes
from gearcad.meshing.sector import mesh_sector
from gearcad.rating.contact_stress import half_width


@dataclass(frozen=True)
class ContactCells:
    """Cells of constant pressure on one pair of flanks, `place` (n,) in mm along the common tangent from the line of action.

    `lengths` are the roll lengths (n,) in mm that face each other there, `gap` (n,) their distance (mm) before loading.
    """

    place: Floats
    width: float
    lengths: PerGear[Floats]
    gap: Floats


_NO_LEVERS = PerGear(0.0, 0.0)


@dataclass(frozen=True)
class ContactPair:
    """A pair of flanks: tooth `tooth` of the pinion (0 is the middle one), in contact at roll `lengths` (mm).

    `added_curvature` (1/mm) is what modified flanks have more than the two involutes, where they come nearest. `edges` are the
    forces of the cells where the edge of a tip ends the contact. `flat`: the wheel is a rack, whose flanks are straight.
    `friction` is the force along the flanks towards their tips over the normal force, `friction_levers` its lever arms, over
    the base radii.
    """

    tooth: int
    lengths: PerGear[float]
    cells: ContactCells
    added_curvature: float = 0.0
    edges: TipEdges | None = None
    flat: bool = False
    friction: float = 0.0
    friction_levers: PerGear[float] = _NO_LEVERS

    @property
    def arms(self) -> PerGear[Floats]:
        """Lever arms (n,) of the normal forces on the cells, over the base radii."""
        return (self.edges or TipEdges.none(len(self.cells.place))).arms

    @property
    def lever_arms(self) -> PerGear[Floats]:
        """Lever arms (n,) of the normal forces and their friction together, over the base radii."""
        levers = zip(self.arms, self.friction_levers, strict=True)
        return PerGear(*(arm + self.friction * lever for arm, lever in levers))

    @property
    def plain_radius(self) -> float:
        """Reduced radius of curvature (mm) of the two involutes, or of one and a straight flank."""
        pinion, wheel = self.lengths
        return pinion if self.flat else pinion * wheel / (pinion + wheel)

    @property
    def radius(self) -> float:
        """Reduced radius of curvature (mm); infinite where one flank is hollower than the other is round."""
        pinion, wheel = self.lengths
        curvature = (1 / pinion if self.flat else (pinion + wheel) / (pinion * wheel)) + self.added_curvature
        return 1 / curvature if curvature > 0 else math.inf


@dataclass(frozen=True)
class ContactSolution:
    """Pressures (MPa) by pair and cell, and the approach of the flanks along the line of action (mm).

    `parts` are the pinion's and the wheel's shares of the approach; what is left is gaps that were closed.
    """

    pairs: tuple[ContactPair, ...]
    pressures: tuple[Floats, ...]
    approach: float
    parts: PerGear[float]

    @property
    def forces(self) -> Floats:
        """Normal force on each pair (N per mm)."""
        return np.array([pressure.sum() * pair.cells.width for pair, pressure in zip(self.pairs, self.pressures, strict=True)])


def solve_contact(
    pairs: tuple[ContactPair, ...], bodies: PerGear[PlaneCompliance], force: float, like: ContactSolution | None = None
) -> ContactSolution:
    """Press the gears together with the normal force `force` (N per mm of width).

    What touches is sought from where it does in a solution `like` this one, if there is one. The gears are pressed by the
    torque on the pinion while the wheel stands: so the approach is the pinion's, and a cell takes part in both by its arm.
    Friction takes part in the torque only: its force follows from the pressures, round by round.
    """
    sizes = [len(pair.cells.place) for pair in pairs]
    width = np.concatenate([np.full(size, pair.cells.width) for size, pair in zip(sizes, pairs, strict=True)])
    arms = np.concatenate([pair.arms.pinion for pair in pairs])
    gap = np.concatenate([pair.cells.gap for pair in pairs])
    matrices = PerGear.each(lambda role: compliance_matrix(pairs, bodies.pick(role), role))
    touching = _middles(pairs) if like is None else _touching(pairs, like)
    if any(pair.friction for pair in pairs):
        levers = np.concatenate([pair.lever_arms.pinion for pair in pairs])
        rubbed = PerGear.each(lambda role: _rubbed_matrix(pairs, bodies.pick(role), role))
        pressed = _with_friction(matrices, rubbed, (gap * width, width * arms, width * levers), force, touching)
    else:
        pressed = *complementary(matrices.pinion + matrices.wheel, gap * width, width * arms, force, touching), force
        rubbed = None
    pressure, approach, normal = pressed
    by_all = matrices if rubbed is None else PerGear(*(one + other for one, other in zip(matrices, rubbed, strict=True)))
    parts = by_all.map(lambda matrix: float(pressure @ matrix @ pressure) / normal)
    return ContactSolution(pairs, tuple(np.split(pressure, np.cumsum(sizes)[:-1])), approach, parts)


def _with_friction(
    matrices: PerGear[Floats], rubbed: PerGear[Floats], sizes: tuple[Floats, Floats, Floats], force: float, touching: Bools
) -> tuple[Floats, float, float]:
    """Return pressures (n,), the approach, and the sum of normal forces by their arms. Raises SolverError.

    `sizes` are gap, arm and lever arm with friction, each times the width of a cell; `rubbed` are the displacements by
    friction. These are found from the pressures of the round before.
    """
    gap, arms, levers = sizes
    normal, before = force, np.zeros_like(gap)
    both, by_friction = matrices.pinion + matrices.wheel, rubbed.pinion + rubbed.wheel
    for _ in range(_FRICTION_ROUNDS):
        pressure, approach = complementary(both, gap + by_friction @ before, arms, normal, touching)
        change = float(np.abs(pressure - before).max())
        normal, before, touching = force * float(arms @ pressure) / float(levers @ pressure), pressure, pressure > 0
        if change < _FRICTION_SETTLED * float(pressure.max()):
            return pressure * (force / float(levers @ pressure)), approach, normal
    raise SolverError("the contact with friction did not settle: reduce check.friction")


def _middles(pairs: tuple[ContactPair, ...]) -> Bools:
    """Return the cells (n,) in the middle third of what is around the least gap of each pair:
    half widths of windows of three.
    """
    places = [pair.cells.place for pair in pairs]
    away = [np.abs(place - place[pair.cells.gap.argmin()]) for place, pair in zip(places, pairs, strict=True)]
    return np.concatenate([each <= each.max() / 3 for each in away])


def _touching(pairs: tuple[ContactPair, ...], like: ContactSolution) -> Bools:
    """Return the cells (n,) that lie where another solution presses."""
    pressed = {pair.tooth: (pair.cells.place, pressure) for pair, pressure in zip(like.pairs, like.pressures, strict=True)}
    nowhere = np.zeros(1), np.zeros(1)
    return np.concatenate([np.interp(pair.cells.place, *pressed.get(pair.tooth, nowhere)) > 0 for pair in pairs])


def compliance_matrix(pairs: tuple[ContactPair, ...], body: PlaneCompliance, role: Role) -> Floats:
    """Return the displacement of a gear's flank over cell i, times its width, by the pressure on cell j.

    (n, n) in mm²/MPa.
    """
    lengths = [pair.cells.lengths.pick(role) for pair in pairs]
    begin = np.cumsum([0, *map(len, lengths)])
    spans = [slice(first, last) for first, last in pairwise(begin.tolist())]
    moved, parts = body.by_unit_loads(np.concatenate(lengths)), body.parts_of_loads(np.concatenate(lengths))
    matrix = np.zeros((begin[-1], begin[-1]))
    for (one, other), (there, here) in zip(product(pairs, pairs), product(spans, spans), strict=True):
        apart = (one.tooth - other.tooth) * TOOTH_ORDER.pick(role)
        if abs(apart) <= body.neighbours:
            block = moved[there, apart + body.neighbours] @ parts[here].T
            matrix[there, here] = block * (one.cells.width * other.cells.width)
        if body.edge_taken_off and not apart:
            matrix[there, here] += _edge_block(one.cells, body)
    result: Floats = (matrix + matrix.T) / 2
    if any(pair.edges for pair in pairs):
        result += _tilted_matrix(pairs, body, role, spans)
    return result


def _tilted_matrix(pairs: tuple[ContactPair, ...], body: PlaneCompliance, role: Role, spans: list[slice]) -> Floats:
    """Return what is added to the compliance (n, n) in mm²/MPa where forces are not normal to the flank.

    A force that is tilted by a small angle t moves the flank's point in its own direction by u_n - t u_s, with u_s towards the
    tip; and so does a normal force that which moves towards the tip, by reciprocity.
    """
    matrix = np.zeros((spans[-1].stop, spans[-1].stop))
    for one, there in zip(pairs, spans, strict=True):
        if one.edges is not None:
            slid = np.hstack([each * (one.cells.width * other.cells.width) for other, each in _slid(pairs, one, body, role)])
            matrix[there] = -one.edges.tilts.pick(role)[:, None] * slid
    result: Floats = matrix + matrix.T
    return result


def _rubbed_matrix(pairs: tuple[ContactPair, ...], body: PlaneCompliance, role: Role) -> Floats:
    """Return the displacement of a gear's flank over cell i, times its width, by the friction of the pressure on cell j.

    (n, n) in mm²/MPa. By reciprocity a force along the flank at j moves i along its normal as a normal force at i moves j
    towards the tip. Under a straight edge that is (1 - nu')/(2 E') towards the load, on both of its sides.
    """
    lengths = [pair.cells.lengths.pick(role) for pair in pairs]
    begin = np.cumsum([0, *map(len, lengths)])
    spans = [slice(first, last) for first, last in pairwise(begin.tolist())]
    parts = body.parts_of_loads(np.concatenate(lengths))
    straight = -(1 - body.elasticity.ratio) / (2 * body.elasticity.modulus)
    matrix = np.zeros((begin[-1], begin[-1]))
    for one, there in zip(pairs, spans, strict=True):
        slid = body.along_by_unit_loads(one.cells.lengths.pick(role))
        for other, here in zip(pairs, spans, strict=True):
            apart = (one.tooth - other.tooth) * TOOTH_ORDER.pick(role)
            if abs(apart) > body.neighbours:
                continue
            block = slid[:, apart + body.neighbours] @ parts[here].T
            if body.edge_taken_off and not apart:
                up = TOOTH_ORDER.pick(role) * one.cells.place
                block = block + straight * np.sign(up[:, None] - up)
            matrix[here, there] += one.friction * block.T * (one.cells.width * other.cells.width)
    return matrix


def _slid(
    pairs: tuple[ContactPair, ...], one: ContactPair, body: PlaneCompliance, role: Role
) -> Iterator[tuple[ContactPair, Floats]]:
    """Yield each pair and the displacements (n, m) towards the tip of the cells of `one` by 1 N per mm on the cells of that."""
    along = body.along_by_unit_loads(one.cells.lengths.pick(role))
    for other in pairs:
        apart = (one.tooth - other.tooth) * TOOTH_ORDER.pick(role)
        known = abs(apart) <= body.neighbours
        parts = body.parts_of_loads(other.cells.lengths.pick(role)).T
        yield other, along[:, apart + body.neighbours] @ parts if known else np.zeros((len(along), parts.shape[1]))


def slid(solution: ContactSolution, pair: ContactPair, body: PlaneCompliance, role: Role) -> float:
    """Return how far (mm) the loads slide a gear's flank towards its tip where a pair presses."""
    carried = dict(zip((each.tooth for each in solution.pairs), solution.pressures, strict=True))
    own = carried[pair.tooth] / carried[pair.tooth].sum()
    along = _slid(solution.pairs, pair, body, role)
    return float(sum(own @ each @ carried[other.tooth] * other.cells.width for other, each in along))


def _edge_block(cells: ContactCells, body: PlaneCompliance) -> Floats:
    """Return the straight edge's part: k(d) integrated over both cells in closed form."""
    log = -2 / (np.pi * body.elasticity.modulus)
    constant = -(1 + body.elasticity.ratio) / (np.pi * body.elasticity.modulus)
    count, h = len(cells.place), cells.width
    by_step, steps = _even_cells(count)
    result: Floats = (h * h * (log * (by_step + math.log(h)) + constant))[steps]
    return result


@lru_cache(256)
def _even_cells(count: int) -> tuple[Floats, Indices]:
    """ln|d| integrated over two cells of width 1 by the steps (n,) between them, and the steps (n, n) between all."""
    steps = np.arange(count)
    second = _second(np.arange(-1.0, count + 1))
    return second[2:] - 2 * second[1:-1] + second[:-2], np.abs(steps[:, None] - steps)


def _second(x: Floats) -> Floats:
    """Twice integrated ln|x|: x^2/2 (ln|x| - 3/2)."""
    size = np.abs(x)
    result: Floats = np.where(size > 0, x * x / 2 * (np.log(np.where(size > 0, size, 1.0)) - 1.5), 0.0)
    return result


_FRICTION_ROUNDS, _FRICTION_SETTLED = 60, 1e-10
"""Rounds of finding friction from pressures, and the change of a pressure, over the greatest, at which they have settled."""

_SAME = 1e-9
"""Distance (mm) below which two places are one."""

_FEWEST = 6
"""Cells of a pair of flanks, however narrow its window."""

_OF_TRANSITION, _MOST = 8, 800
"""Cells over the transition of a linear relief that lies in the window, and the most cells of a pair of flanks."""

_BEND = 0.01
"""Distance (mm per mm of normal module) over which the curvature of a gap is taken."""


def contact_pairs(
    line: LineOfAction,
    pinion_length: float,
    span: Callable[[int, float], float],
    cells: int,
    farthest_gap: float,
    least_width: float = 0.0,
    *,
    single: bool = False,
    tips: Mapping[int, LoadedTip] | None = None,
) -> tuple[ContactPair, ...]:
    """Return the pairs of flanks when the middle pair touches at `pinion_length` (mm from T1).

    Each has `cells` within `span(tooth, reduced radius)` (mm) on both sides of its contact, or fewer that are not narrower
    than `least_width` (mm). Beyond the path of contact the corner of a tip can touch while teeth bend: such pairs count up
    to `farthest_gap` (mm) from where exact involutes would touch. `single` leaves all but the middle pair out. `tips` are the
    edges of tips that are known to press, by tooth.
    """
    known = tips or {}
    return tuple(
        _contact_pair(line, tooth, pinion_length + tooth * line.pitch, place, span, cells, least_width, known.get(tooth))
        for tooth, place in touching_teeth(line, pinion_length, farthest_gap, single=single).items()
    )


def touching_teeth(line: LineOfAction, pinion_length: float, farthest_gap: float, *, single: bool = False) -> dict[int, float]:
    """Return the teeth whose flanks come as near as `farthest_gap` (mm), and where along the tangent (mm) they are nearest."""
    near = facing_pairs(line, pinion_length).items()
    return {tooth: place for tooth, (gap, place) in near if gap <= farthest_gap and not (single and tooth)}


def _contact_pair(
    line: LineOfAction,
    tooth: int,
    pinion_length: float,
    middle: float,
    span: Callable[[int, float], float],
    cells: int,
    least_width: float,
    tip: LoadedTip | None = None,
) -> ContactPair:
    turns = tip.turns if tip else AS_PLACED
    low, high = overlap(line, pinion_length, turns)
    if tip and not low < high:  # a load far beyond elasticity moves the flanks past each other
        return _contact_pair(line, tooth, pinion_length, middle, span, cells, least_width)
    middle = min(max(middle, low), high)
    touching = line.lengths(pinion_length)
    radius = line.radius(pinion_length)
    reach = span(tooth, radius)
    first, last = max(low, middle - reach), min(high, middle + reach)
    finest = max(min(2 * reach / cells, _of_transition(line, touching, radius, reach)), 2 * reach / _MOST, least_width)
    count = max(round((last - first) / finest), _FEWEST)
    width = (last - first) / count
    place = np.linspace(first + width / 2, last - width / 2, count)
    facing, gap = facing_gap(line, tooth, pinion_length, place, turns)
    # The mean gap over a cell is that of its middle and what the curvature adds.
    gap = gap + width**2 / 24 / radius
    added = 0.0 if line.exact else _curvature(line, tooth, pinion_length, middle) - 1 / radius
    flat = isinstance(line, RackLine)
    if tip is None and not low <= 0 <= high:  # beyond the path of contact
        tip = next((LoadedTip(role) for role, at in tip_places(line, pinion_length).items() if at in (low, high)), None)
    if tip is None:
        return ContactPair(tooth, touching, ContactCells(place, width, facing, gap), added, flat=flat)
    edges = tip.forces(line, pinion_length, place)
    return ContactPair(tooth, touching, ContactCells(place, width, facing, gap + tip.gap(edges)), added, edges, flat)


def _of_transition(line: LineOfAction, touching: PerGear[float], radius: float, reach: float) -> float:
    """Return the width (mm) of cells that the transitions within `reach` of a contact ask for; infinite without one."""
    finest = math.inf
    for flank, length in zip(line.flanks, touching, strict=True):
        for onset in onsets(flank):
            if onset.length and start_distance(flank.base_radius, onset, np.array(length), radius) < reach:
                finest = min(finest, onset.length / _OF_TRANSITION)
    return finest


def _curvature(line: LineOfAction, tooth: int, pinion_length: float, place: float) -> float:
    """Relative curvature (1/mm) of two flanks at a place along the tangent: second difference of their gap."""
    step = _BEND * line.module
    _, (before, here, after) = facing_gap(line, tooth, pinion_length, place + step * np.array([-1.0, 0.0, 1.0]))
    return float(before - 2 * here + after) / step**2


_CELLS = 66
_FIRST_CELLS = 24
_WINDOW = 3.0
"""Cells in the window of contact - fewer to find out how wide it is - and its half width in Hertz half widths."""

_LEAST_SHARE = 0.03
"""Share of the load for which the window of a pair is wide enough, however little it carries."""

_SOFT = 4000.0
"""A stiffness (N/mm per mm of width) that no pair of teeth falls below: bounds how far a tip corner can get."""

_BENT = 0.02
"""Deflection (normal modules) of teeth under great loads, so that pairs touch whose flanks are no further apart."""

_SINGLE = 25
"""Positions of one pair of teeth along its path of contact, among which it is stiffest."""


class KnownContacts(dict[tuple[float, float, bool], ContactSolution]):
    """Contacts by roll angle (deg), torque (N·m) and whether the middle pair is alone; grows as positions are solved."""


@dataclass(frozen=True)
class PlanePair(FlexiblePair[PlaneCompliance]):
    """A pair of sections: both bodies in the transverse section through the middle of the common face width."""

    known: KnownContacts = field(default_factory=KnownContacts, repr=False)
    friction: MeshFriction | None = None

    def rubbing(self, friction: MeshFriction | None) -> PlanePair:
        """Return the same pair with another friction of its flanks, None for none."""
        return self if friction == self.friction else replace(self, friction=friction, known=KnownContacts())

    @property
    def repeats(self) -> bool:
        """True unless the middle pair of teeth stands proud."""
        return not self.line.proud

    def with_flanks(self, pair: GearPair | RackPair) -> PlanePair:
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
        """Return the approach (mm) of the unloaded gears at a roll angle (deg) until the first pair of teeth touches."""
        return rigid_approach(self.line, self.roll_length(roll_angle), single=single)

    def solve(self, roll_angle: float, torque: float, *, single: bool = False) -> ContactSolution:
        """Return the contact at a roll angle (deg) and torque (N·m); `single` lets no other pair of teeth touch.

        Raises SolverError, and GeometryError where nothing can touch.
        """
        asked = roll_angle, abs(torque), single
        if (found := self.known.get(asked)) is None:
            self.require_narrow_contact(torque, self.modulus)
            found = self.known[asked] = self._solved(roll_angle, self.force(torque), single)
        return found

    def _solved(self, roll_angle: float, force: float, single: bool) -> ContactSolution:
        """Return the contact at a roll angle (deg) and a normal force (N per mm)."""
        farthest = self._farthest(roll_angle, force, single)
        if len(touching_teeth(self.line, self.roll_length(roll_angle), farthest, single=single)) == 1:  # it carries all
            return self._pressed(roll_angle, force, lambda _tooth: force, single, _CELLS)
        # The first solution tells what each pair carries, and so how wide its contact is.
        carried = self._pressed(roll_angle, force, lambda _tooth: force, single, _FIRST_CELLS)
        shares = dict(zip((pair.tooth for pair in carried.pairs), carried.forces.tolist(), strict=True))

        def thought(tooth: int) -> float:
            return float(max(shares.get(tooth, 0.0), _LEAST_SHARE * force))

        return self._pressed(roll_angle, force, thought, single, _CELLS, carried, self._loaded_tips(roll_angle, carried))

    def _loaded_tips(self, roll_angle: float, solution: ContactSolution) -> dict[int, LoadedTip]:
        """Return the edges of tips that press in a solution at a roll angle (deg), by tooth: the cells beside them carry."""
        found = dict[int, LoadedTip]()
        for pair, pressures in zip(solution.pairs, solution.pressures, strict=True):
            length, aside = self.roll_length(roll_angle) + pair.tooth * self.line.pitch, pair.cells.width / 2
            ends = PerGear((pair.cells.place[-1] + aside, pressures[-1]), (pair.cells.place[0] - aside, pressures[0]))
            tips = tip_places(self.line, length)
            reached = [role for role, (end, there) in ends.items() if there > 0 and abs(end - tips.pick(role)) < _SAME]
            if reached:
                role = min(reached, key=lambda each: abs(tips.pick(each)))
                found[pair.tooth] = self._loaded_tip(role, self.line.lengths(length), solution, pair)
        return found

    def _loaded_tip(self, role: Role, touching: PerGear[float], solution: ContactSolution, pair: ContactPair) -> LoadedTip:
        """Return the edge of a gear's tip on a pair of flanks that touch at roll lengths (mm), as a solution moves them."""
        flanks = self.line.flanks
        by_load = PerGear.each(
            lambda each: flanks.pick(each).turn_of(slid(solution, pair, self.bodies.pick(each), each), touching.pick(each))
        )
        turns = PerGear(solution.approach - by_load.pinion, by_load.wheel)
        return LoadedTip(role, turns, flanks.pick(role).turned(by_load.pick(role)))

    def _pressed(
        self,
        roll_angle: float,
        force: float,
        carried: Callable[[int], float],
        single: bool,
        cells: int,
        like: ContactSolution | None = None,
        tips: Mapping[int, LoadedTip] | None = None,
    ) -> ContactSolution:
        """Return the contact, with windows for what each pair of teeth is thought to carry (N per mm); about `like` another
        one, which has told the `tips` that press.
        """

        def span(tooth: int, radius: float) -> float:
            return _WINDOW * float(half_width(carried(tooth), radius, self.modulus))

        least_width = max(body.resolution for body in self.bodies)
        farthest = self._farthest(roll_angle, force, single)
        length = self.roll_length(roll_angle)
        pairs = contact_pairs(self.line, length, span, cells, farthest, least_width, single=single, tips=tips)
        if not pairs:
            raise GeometryError("roll_angle", roll_angle, "must be an angle at which teeth can touch", "deg")
        if self.friction is not None:
            pairs = tuple(self._rubbed(pair, self.friction, force) for pair in pairs)
        return solve_contact(pairs, self.bodies, force, like)

    def _rubbed(self, contact: ContactPair, friction: MeshFriction, force: float) -> ContactPair:
        """Return a pair of flanks with the friction under a transverse force (N per mm) of all."""
        signed = float(friction.signed(self.gear_pair, contact.lengths.pinion, force))
        levers = (length / flank.base_radius for length, flank in zip(contact.lengths, self.line.flanks, strict=True))
        return replace(contact, friction=signed, friction_levers=PerGear(*levers))

    def _farthest(self, roll_angle: float, force: float, single: bool) -> float:
        """Return the gap (mm) from which flanks can touch as teeth bend."""
        return self.rigid_approach(roll_angle, single=single) + force / _SOFT

    def single_stiffness(self, torque: float, count: int = _SINGLE) -> float:
        """Return the greatest stiffness (N/(mm·µm)) of one pair of teeth alone, at `count` places of its path of contact.

        It is that without friction.
        """
        if self.friction is not None:
            return self.rubbing(None).single_stiffness(torque, count)
        lengths = np.linspace(*self.pair.usable_path, count + 2)[1:-1]
        approaches = [
            self.solve(angle, torque, single=True).approach - self.rigid_approach(angle, single=True)
            for angle in self.roll_angle(lengths).tolist()
        ]
        return self.force(torque) / (min(approaches) * 1000)


def plane_pair(
    pair: GearPair | RackPair,
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
    if isinstance(pair, RackPair):
        return _with_rack(pair, material, plane, body, sizes, pitch_error, solve)
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


def _with_rack(
    pair: RackPair,
    material: Materials,
    plane: Plane,
    body: BodyModel,
    sizes: MeshSizes,
    pitch_error: float,
    solve: Callable[[Gear, Ring, PlaneElasticity], PlaneCompliance],
) -> PlanePair:
    """Return a pinion and a rack, which is held along its back."""
    neighbours = max(1, math.floor(pair.transverse_contact_ratio + 0.2))
    own, of_rack = (PlaneElasticity(each, plane) for each in of_both(material))
    radius, support = body.of_pinion(pair.pinion)
    pinion = flank_body(pair.pinion, radius, own, body, neighbours, sizes, solve, support)
    return PlanePair(pair, line_of_action(pair, pitch_error), PerGear(pinion, rack_body(pair.rack, of_rack, neighbours, sizes)))


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
    """Return one gear, held at `held_radius` (mm), with so many `neighbours` in full on each side of the loaded tooth."""
    sizes = sizes or MeshSizes()
    if (held := body.teeth_held(gear)) is not None:
        held = max(held, 2 * neighbours + 1)
    fine, coarse = mesh_sector(gear, held_radius, sizes), mesh_sector(gear, held_radius, sizes.coarse())
    ring = assemble(
        fine, coarse, gear.tooth_count, min(neighbours, (gear.tooth_count - 1) // 2), elasticity, held, body.cuts, support
    )
    return solve(gear, ring, elasticity)
