"""SolidPair: two solid gears in mesh, factorised once, loaded at any position, torque, modification and mounting."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor, wait
from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from typing import NamedTuple

import numpy as np

from gearcad.contact.shared.bodies import BodyModel
from gearcad.contact.shared.line_of_action import gears_loaded_left, line_of_action
from gearcad.contact.shared.loaded import FlexiblePair
from gearcad.contact.solid.body import assemble_body
from gearcad.contact.solid.flank import SolidCompliance, solid_compliance
from gearcad.contact.solid.line_contact import LineSolution, Responses, contact_lines, gaps, near_path, responses, solve_lines
from gearcad.contact.solid.relief_start import press_starts
from gearcad.contact.solid.root import SolidFillets, solid_fillets
from gearcad.contact.solid.rubbing import KnownSlips, pressed_with_friction, slips, with_friction
from gearcad.core.errors import GeometryError, SolverError
from gearcad.core.records import PerGear, Role
from gearcad.core.runtime import Expected, Share, unheard
from gearcad.geometry import Gear, GearPair
from gearcad.geometry.curves import CurveKind
from gearcad.geometry.gear import refuse_halves
from gearcad.geometry.tooth_friction import MeshFriction
from gearcad.material import Materials, of_both
from gearcad.meshing.outline import MeshSizes
from gearcad.meshing.quads import mesh_quads
from gearcad.meshing.sector import SweptMesh, sweep
from gearcad.mounting import MOST_DEVIATION, Mounting, SupportCompliance
from gearcad.rating.contact_stress import reduced_modulus

POSITION_SECONDS = 0.025
"""Time (s) for one position of a mesh cycle."""

_ROWS = 8
"""Unit loads in each layer, at the most."""

_OPERATIONS, _FACTORS = 4.0e3, 370.0
"""Operations of the condensation, per squared quadrangles and layers^1.93, and numbers that are kept of it, per quadrangles^1.4
and layers^1.3: within a fifth for 126 to 324 quadrangles and 5 to 63 layers.
"""

_ELIMINATING, _ASSEMBLING = 3.5e-11, 4.5e-4
_FIELDS = 3.5e-6
_SOLVING = 1.6e-10
_JOINING = 3.4e-11
"""Seconds: per operation, and per hexahedron; per quadrangle, layer and load; per number that is kept, load and tooth, and the
loaded one once more; per cube of a cut's dofs and step of putting rows together. Measured on one core of a server of the 2020s:
within a third for some 5 to 30 thousand nodes; the smallest meshes, which are more than dense algebra, up to 2.2 times that.
"""

_SPAN, _DOUBLED = 5.0, 3.0
"""Steps of putting one more tooth on both sides of a row, and of doubling a row."""

_FRONTS, _ROWS_OF_CUTS, _COPIES, _AT_ONCE = 2.2, 8.0, 1.6, 72
"""Numbers in memory: copies of what is kept, matrices of a cut, and copies of all dofs for so many loads at once."""

_READ = 0.35
"""Numbers in memory per dof, load and tooth that is told: the displacements that are read, and their copies.

With these the greatest memory of pairs on two cores is told at 0.99 to 1.09 of what was measured, libraries included, for 5 to
30 thousand nodes and 6 to 32 layers, a ring among them.
"""

LEFT, KEPT = 0.2, 0.72
"""Memory that is left of bodies without factors, and with them, over the most that they take."""


class BodyCost(NamedTuple):
    """Seconds of the steps of one body - fields of the loads, condensation, the rest - and bytes while they run."""

    fields: float
    condensation: float
    solution: float
    memory: float

    @property
    def seconds(self) -> float:
        """Seconds of all steps."""
        return self.fields + self.condensation + self.solution


def body_cost(mesh: SweptMesh, teeth: int, neighbours: int) -> BodyCost:
    """Return the cost of the body of a ring of `teeth`, with so many `neighbours` on each side of the loaded one."""
    quads, layers, dofs = len(mesh.section.quads), mesh.layers, 3 * mesh.nodes
    loads, told = _ROWS * layers, 2 * neighbours + 1
    cut = 3 * len(mesh.over(mesh.section.ahead))
    operations, factors = _OPERATIONS * quads**2 * layers**1.93, _FACTORS * quads**1.4 * layers**1.3
    steps = _SPAN * neighbours + _DOUBLED * math.log2(max(teeth - 2 * neighbours, 2))
    numbers = _FRONTS * factors + _ROWS_OF_CUTS * cut**2 + _COPIES * dofs * min(loads, _AT_ONCE) + _READ * told * dofs * loads
    return BodyCost(
        fields=_FIELDS * quads * layers * loads,
        condensation=_ELIMINATING * operations + _ASSEMBLING * quads * layers,
        solution=_SOLVING * factors * loads * (told + 1) + _JOINING * cut**3 * steps,
        memory=8 * numbers,
    )


_SOFT = 8000.0
"""A stiffness (N/mm per mm of width) that bounds, at first, how far a tip edge can get."""

_STEP = 0.05
"""Step (mm) of that bound, so that loads and modifications that differ little share their responses."""


_BENT = 0.02
"""Deflection (normal modules) of teeth under great loads, so that pairs touch whose flanks are no further apart."""

_SINGLE = 15
"""Positions of one pair of teeth along its path of contact, among which it is stiffest."""

_ON_ALL_CORES = 0.75
"""Time of a body on all cores, over that on one: not measured, but what two cores make of it that share half of the work."""

_TICK = 0.2
"""Time (s) between two reports of progress."""

_SECTION = MeshSizes(flank=0.34, corner=0.045, fillet=0.11, outline=0.45, cut=0.3, rim=6.0, growth=0.45)
"""Sizes of which halving any one changes the stiffness of the FZG pair by less than 0.1 %, and its root stress by less than 0.5
%.
"""

_BEND, _SHORTEST = 0.3, 0.02
"""Edges of a ring's fillets over their least radius of curvature, about as of a hob's, and the least in normal modules: root
stresses are then within 0.5 % (measured for cutters' tip radii from 0.05 m_n on).
"""


@dataclass(frozen=True, kw_only=True)
class SolidSizes:
    """Mesh of the solid bodies: edge lengths in the `section`, mean thickness of a `layer`, in normal modules."""

    section: MeshSizes = _SECTION
    layer: float = 0.8
    fewest_layers: int = 6

    def layers(self, gear: Gear) -> int:
        """Return the layers of elements over the face width."""
        return max(self.fewest_layers, round(gear.face_width / (self.layer * gear.normal_module)))

    def section_of(self, gear: Gear) -> MeshSizes:
        """Edge lengths in the section of a gear: of a ring shorter along fillets that are sharper than a hob's."""
        if not gear.internal:
            return self.section
        longest = max(_BEND * _least_fillet_radius(gear) / gear.normal_module, _SHORTEST)
        return replace(self.section, fillet=self.section.fillet * min(longest / _SECTION.fillet, 1.0))

    def refined(self, factor: float) -> SolidSizes:
        """Return all edges shorter by `factor`."""
        return SolidSizes(
            section=self.section.scaled(factor),
            layer=self.layer / factor,
            fewest_layers=round(self.fewest_layers * factor),
        )


def _least_fillet_radius(gear: Gear) -> float:
    """Return the least radius of curvature (mm) of a fillet in the transverse section."""
    s, least = np.linspace(0.0, 1.0, 257), math.inf
    for piece in gear.profile.curves:
        if piece.kind is CurveKind.FILLET:
            lengths = np.hypot(*np.diff(piece.points(s), axis=0).T)
            least = min(least, float((lengths / np.abs(np.diff(np.unwrap(piece.direction(s))))).min()))
    return least


class KnownResponses(dict[tuple[float, float, bool], Responses]):
    """Responses by roll angle (deg), farthest gap (mm) and whether the middle pair is alone; grows as positions are solved.

    Pairs of the same bodies at the same centre distance share it.
    """


class KnownSolutions(dict[tuple[float, float, bool], LineSolution]):
    """Contacts by roll angle (deg), torque (N·m) and whether the middle pair is alone; grows as positions are solved."""


@dataclass(frozen=True)
class SolidPair(FlexiblePair[SolidCompliance]):
    """A pair of bodies over their face widths, in contact along lines of `cells` over the common one.

    Modifications and mounting may be changed by `remade`: the bodies are those of the exact gears. Left flanks carry. Bodies
    are held rigidly where they sit on their `supports`, which give way as a whole; None stands for rigid ones.
    """

    pair: GearPair
    mounting: Mounting
    cells: int
    fillets: PerGear[SolidFillets] = field(repr=False)
    supports: SupportCompliance | None = field(default=None, repr=False)
    known: KnownResponses = field(default_factory=KnownResponses, repr=False)
    solved: KnownSolutions = field(default_factory=KnownSolutions, repr=False)
    friction: MeshFriction | None = None
    slips: KnownSlips = field(default_factory=KnownSlips, repr=False)

    def rubbing(self, friction: MeshFriction | None) -> SolidPair:
        """Return the same pair with another friction of its flanks, None for none; what is known of its bodies is shared."""
        return self if friction == self.friction else replace(self, friction=friction, solved=KnownSolutions())

    def remade(self, pair: GearPair, mounting: Mounting) -> SolidPair:
        """Return the same bodies with other modifications of the flanks, or another mounting, of an otherwise equal pair."""
        mounted = mounting.mounted(pair)
        same = mounted.centre_distance == self.pair.centre_distance
        known, slid = (self.known, self.slips) if same else (KnownResponses(), KnownSlips())
        line = line_of_action(mounted)
        return replace(self, pair=mounted, mounting=mounting, line=line, known=known, slips=slid, solved=KnownSolutions())

    def with_flanks(self, pair: GearPair) -> SolidPair:
        """Return the same bodies with other modifications of an otherwise equal pair, as it is mounted."""
        return replace(self, pair=pair, line=line_of_action(pair), solved=KnownSolutions())

    def on(self, supports: SupportCompliance | None) -> SolidPair:
        """Return the same pair on other supports; what is known of its bodies is shared."""
        return replace(self, supports=supports, solved=KnownSolutions())

    def let_go(self) -> None:
        """Keep no factors of the bodies: the next field of a tooth makes them again."""
        for body in self.bodies:
            body.body.let_go()

    @property
    def repeats(self) -> bool:
        """True unless the middle pair of teeth stands proud."""
        return not self.mounting.pitch_error

    @property
    def helix(self) -> float:
        """Base helix angle of the pinion (rad), signed."""
        return self.pinion.flank.helix

    @cached_property
    def modulus(self) -> float:
        """Reduced modulus of the contact (MPa): 1/E_r = sum (1 - nu^2)/E."""
        pinion, wheel = (body.material for body in self.bodies)
        return reduced_modulus((pinion.youngs_modulus, wheel.youngs_modulus), (pinion.poisson_ratio, wheel.poisson_ratio))

    def common_heights(self, role: Role) -> tuple[float, float]:
        """Return the heights z (mm) of a gear at which the common face width begins and ends."""
        aside = PerGear(0.0, self.pair.axial_offset).pick(role)
        middle = self.pair.gears.pick(role).face_width / 2 + self.pair.common_width.offset - aside
        return middle - self.width / 2, middle + self.width / 2

    @cached_property
    def _deviation(self) -> float:
        """Greatest distance (mm) by which modifications and mounting can move a contact."""
        depths = []
        for gear in self.pair.gears:
            form = gear.flank_form
            depths.append(np.ptp(form.depth(np.linspace(form.first, form.last, 25), np.linspace(0, form.width, 25)[:, None])))
        out_of_place = (abs(self.mounting.misalignment) + abs(self.mounting.pitch_error)) / 1000
        return sum(depths) + out_of_place + (0.0 if self.supports is None else self.supports.greatest_gap)

    def _mounted(self, torque: float) -> Mounting:
        """Return the mounting with what supports slide the wheel square to the plane of action at a torque (N·m)."""
        if self.supports is None:
            return self.mounting
        slid = 1000 * self.width * self.supports.slide(self.force(torque) * self.width)
        most = MOST_DEVIATION - abs(self.mounting.misalignment_across)
        return replace(self.mounting, misalignment_across=self.mounting.misalignment_across + max(min(slid, most), -most))

    def responses(self, roll_angle: float, farthest: float, *, single: bool = False) -> Responses:
        """Return the responses of the bodies for the contact at a roll angle (deg).

        It has cells where the exact flanks are nearer than `farthest` (mm), and what supports add. Raises GeometryError where
        nothing can touch.
        """
        key = (round(roll_angle, 9), farthest, single)
        if (found := self.known.get(key)) is None:
            lines = contact_lines(self.pair, self.line, self.pinion.flank, self.roll_length(roll_angle), self.cells, farthest)
            if single:
                lines = tuple(line for line in lines if line.tooth == 0)
            if not lines:
                raise GeometryError("roll_angle", roll_angle, "must be an angle at which teeth can touch", "deg")
            found = self.known[key] = responses(lines, self.bodies, self.modulus)
        return found if self.supports is None else found.on(self.supports)

    def solve(self, roll_angle: float, torque: float, *, single: bool = False) -> LineSolution:
        """Return the contact at a roll angle (deg) and torque (N·m); `single` lets no other pair of teeth touch.

        Raises SolverError, and GeometryError where nothing can touch.
        """
        asked = roll_angle, abs(torque), single
        if (found := self.solved.get(asked)) is None:
            found = self.solved[asked] = self._solved(roll_angle, torque, single)
        return found

    def _solved(self, roll_angle: float, torque: float, single: bool) -> LineSolution:
        self.require_narrow_contact(torque, self.modulus)
        force, farthest, mounting = self.force(torque), self.farthest(torque), self._mounted(torque)
        while True:
            given = self.responses(roll_angle, farthest, single=single)
            found = self._pressed(given, mounting, force, (round(roll_angle, 9), farthest, single))
            # What supports move all cells alike brings no others into contact.
            alike = 0.0 if given.supports is None else float((given.supports.matrix @ found.forces).min())
            if found.approach - found.rigid - alike + self._deviation < farthest * math.cos(self.helix):
                self._require_in_range(found, torque)
                return found
            farthest *= 2

    def _pressed(self, given: Responses, mounting: Mounting, force: float, known: tuple[float, float, bool]) -> LineSolution:
        """Return the contact under a transverse force (N per mm); `slips` are known by `known`."""

        def press(given: Responses, normal: float) -> LineSolution:
            found = solve_lines(given, gaps(given.lines, self.pair, mounting, self.helix), normal)
            return press_starts(self.pair, self.line, mounting, self.helix, found)

        normal = force * self.width / math.cos(self.helix)
        if self.friction is None or not self.friction.coefficient(force):
            return press(given, normal)
        lines = with_friction(given.lines, self.pair, self.line, self.friction, force, self.helix)
        if known not in self.slips:
            self.slips[known] = slips(lines, self.bodies)
        return pressed_with_friction(replace(given, lines=lines), self.slips[known], press, normal)

    def _require_in_range(self, found: LineSolution, torque: float) -> None:
        """Raise SolverError where the contact is wider than a tooth is deep, or than its flanks are curved."""
        worst = int(np.argmax(np.where(found.forces > 0, found.half_widths, 0.0)))
        half, radius = float(found.half_widths[worst]), float(found.gaps.radii[worst])
        depth = min((gear.tip_diameter - gear.root_diameter) / 2 for gear in self.pair.gears)
        for words, bound in (("the depth of the teeth", depth), ("the reduced radius there", radius)):
            if half > bound:
                raise SolverError(
                    f"the contact is outside the range of its model: its half width, {half:.3g} mm at {abs(torque):.4g} N·m, "
                    f"is more than {words}, {bound:.3g} mm; reduce load.torque or mounting.misalignment, or raise "
                    "check.refinement, as coarse elements put too much on an edge"
                )

    def farthest(self, torque: float) -> float:
        """Return the gap of the exact flanks (mm) beyond which nothing is taken to touch at a torque (N·m) but for very soft
        bodies.
        """
        return math.ceil((self.force(torque) / _SOFT + self._deviation) / _STEP) * _STEP

    def single_stiffness(self, torque: float, count: int = _SINGLE) -> float:
        """Return the greatest stiffness (N/(mm·µm)) of one pair of teeth alone, at `count` places while its line crosses the
        flanks; that without friction.
        """
        if self.friction is not None:
            return self.rubbing(None).single_stiffness(torque, count)
        (first, last), reach = self.pair.usable_path, self.width * abs(math.tan(self.helix)) / 2
        lengths = np.linspace(first - reach, last + reach, count + 2)[1:-1]
        solved = (self.solve(angle, torque, single=True) for angle in self.roll_angle(lengths).tolist())
        # Transverse: F cos(beta_b) over the approach delta/cos(beta_b), per mm of width.
        factor = math.cos(self.helix) / 1000
        return max(self.force(torque) * factor / each.elastic for each in solved)


def solid_pair(
    pair: GearPair,
    material: Materials,
    *,
    body: BodyModel | None = None,
    sizes: SolidSizes | None = None,
    mounting: Mounting | None = None,
    cells: int = 60,
    fields: bool = False,
    friction: MeshFriction | None = None,
    tell: Share = unheard,
) -> SolidPair:
    """Mesh, condense and solve both gears, each on all cores; a line of contact has `cells` over the common face width.

    With `fields` the bodies keep their factors for the fields of teeth, else they are condensed again where one is asked for.
    `tell` hears how much is done, from the thread that called. Raises SolverError, ParameterError and GeometryError.
    """
    body, sizes, mounting = (body or BodyModel()).for_solids(), sizes or SolidSizes(), mounting or Mounting()
    neighbours = teeth_moved(pair)
    starts = PerGear(pair.path_of_contact.A, line_of_action(pair).whole - pair.path_of_contact.E)
    jobs = []
    gears, meshes, supports = gears_loaded_left(pair), _meshes(pair, body, sizes), body.supports(pair)
    for gear, of, mesh, support, start in zip(gears, of_both(material), meshes, supports, starts, strict=True):
        held = body.teeth_held(gear)
        heard = _BodyProgress(body_cost(mesh, held or gear.tooth_count, neighbours))
        solid = assemble_body(
            mesh,
            gear.tooth_count,
            neighbours,
            of,
            held,
            body.cuts,
            free=support.bends,
            condensed=heard.condensation,
            solved=heard.solution,
        )
        kept = {"fields": fields, "along": friction is not None and friction.reference > 0}
        jobs.append((heard, partial(solid_compliance, gear, solid, of, start, heard.fields, **kept)))
    bodies, mounted = PerGear(*_one_by_one(jobs, tell)), mounting.mounted(pair)
    return SolidPair(mounted, line_of_action(mounted), bodies, mounting, cells, bodies.map(solid_fillets), friction=friction)


def expected_bodies(pair: GearPair, body: BodyModel, sizes: SolidSizes, *, fields: bool = False) -> Expected:
    """Return the seconds and the memory that `solid_pair` is expected to take. Raises what it does for bodies that cannot be
    meshed.
    """
    body = body.for_solids()
    meshes = zip(pair.gears, _meshes(pair, body, sizes), strict=True)
    costs = [body_cost(mesh, body.teeth_held(gear) or gear.tooth_count, teeth_moved(pair)) for gear, mesh in meshes]
    first, second = (cost.memory for cost in costs)
    memory = max(first, (KEPT if fields else LEFT) * first + second)
    return Expected(_ON_ALL_CORES * sum(cost.seconds for cost in costs), memory)


def teeth_moved(pair: GearPair) -> int:
    """Return the teeth on each side of the loaded one that others' loads can move."""
    moved = max(1, math.floor(pair.total_contact_ratio + 0.2))
    if not pair.internal:
        return moved
    # Flanks stay close to each other beyond the path of contact: more pairs touch as teeth bend.
    line = line_of_action(pair)
    near = near_path(line, _BENT * line.module)
    return max(moved, math.floor(near / line.pitch + pair.overlap_ratio))


def _meshes(pair: GearPair, body: BodyModel, sizes: SolidSizes) -> list[SweptMesh]:
    refuse_halves(pair.pinion, "contact")
    gears = zip(gears_loaded_left(pair), body.inner_radii(pair), strict=True)
    return [sweep(gear, mesh_quads(gear, radius, sizes.section_of(gear)), sizes.layers(gear)) for gear, radius in gears]


class _BodyProgress:
    """Progress of a body: the expected seconds that have passed, reported by the thread that solves it."""

    def __init__(self, cost: BodyCost) -> None:
        self.cost, self.seconds = cost, 0.0

    def fields(self, share: float) -> None:
        self.seconds = share * self.cost.fields

    def condensation(self, share: float) -> None:
        self.seconds = self.cost.fields + share * self.cost.condensation

    def solution(self, share: float) -> None:
        self.seconds = self.cost.fields + self.cost.condensation + share * self.cost.solution


def _one_by_one(jobs: Sequence[tuple[_BodyProgress, Callable[[], SolidCompliance]]], tell: Share) -> list[SolidCompliance]:
    """Solve both gears one after the other in a thread, while this thread reports progress. Each needs the memory that the
    other has left.
    """
    whole = sum(heard.cost.seconds for heard, _ in jobs)
    tell(0.0)
    with ThreadPoolExecutor(1) as thread:
        try:
            running = [thread.submit(job) for _, job in jobs]
            while wait(running, _TICK).not_done:
                done = (
                    heard.cost.seconds if job.done() else heard.seconds for (heard, _), job in zip(jobs, running, strict=True)
                )
                tell(sum(done) / whole)
        except BaseException:
            thread.shutdown(cancel_futures=True)
            raise
        return [job.result() for job in running]
