"""Frictionless contact along the lines across solid flanks: gaps, the load of every cell, and the approach of the gears.

In the plane of action a line of contact is straight and lies at the base helix angle. Where it leaves the flanks, the tip
edge of one gear faces the other's flank instead.

Across the line the pressure is Hertz's, an ellipse as wide as the load of its place makes it; along the line loads act on each
other as on a half-space. c = 0.3033 a is the distance at which a point load moves the middle of the ellipse as the ellipse does
(the mean of ln|x| over a semi-ellipse is ln(a/2) - 1/2).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from gearcad.contact.shared.line_of_action import LEAST_LENGTH, LineOfAction, gears_loaded_left
from gearcad.contact.shared.loaded import TOOTH_ORDER
from gearcad.contact.shared.local_contact import onsets, start_distance
from gearcad.contact.shared.tip_edge import TipEdges, tip_edges
from gearcad.core.complementarity import complementary
from gearcad.core.errors import SolverError
from gearcad.core.records import Bools, Floats, PerGear, Role, Wholes
from gearcad.geometry import Gear, GearPair
from gearcad.mounting import Mounting, SupportCompliance, SupportedCells
from gearcad.rating.contact_stress import half_width, peak_pressure

if TYPE_CHECKING:
    from gearcad.contact.solid.flank import Places, SolidCompliance, SolidFlank

BEND = 0.05
"""Distance (mm per mm of normal module) over which slope and curvature of a modification are taken."""

_PLACES = 2001
"""Number of places on the line of action at which flanks are evaluated."""

_LEAST_BEND = 0.05
"""Share of the exact flanks' curvature that a hollow modification leaves at the least."""


_NO_LEVERS: PerGear[Floats | float] = PerGear(0.0, 0.0)


@dataclass(frozen=True)
class ContactLine:
    """One pair of flanks: tooth `tooth` of the pinion (0 is the middle one), cell by cell along the face width.

    `across` (n,) in mm from the middle of the common face width, `nominal` (n,) where the line of contact crosses the line
    of action (mm from T1), `places` on both flanks, `lengths` (n,) of the cells in mm, `aside` (n,) in mm how far beside the
    line of action the flanks are nearest (0 on the line of contact, else an edge touches), `gap` (n,) the transverse gap of the
    exact involutes in mm, `points` (n, 3) on the pinion's flank, `slope` (mm per mm) that of `nominal` over `across`. `edges`
    are the forces of the cells (n,), as they lie in the transverse section. `supported` (n,) is the gap along the normal that
    the supports of the gears leave without load, in mm. `friction` (n,) is the force along the flanks towards their tips over
    the normal force, `friction_levers` its lever arms over those of normal forces.
    """

    tooth: int
    across: Floats
    nominal: Floats
    places: PerGear[Places]
    lengths: Floats
    aside: Floats
    gap: Floats
    points: Floats
    edge_distance: Floats
    slope: float
    edges: TipEdges
    supported: Floats | float = 0.0
    friction: Floats | float = 0.0
    friction_levers: PerGear[Floats | float] = _NO_LEVERS

    @property
    def middle(self) -> float:
        """Place (mm from T1) where the line crosses the middle of the common face width."""
        return float(self.nominal[0] - self.across[0] * self.slope)

    @property
    def on_edge(self) -> Bools:
        """Whether the edge of a tip touches instead of the flank."""
        result: Bools = self.aside != 0
        return result

    @property
    def curvature(self) -> Floats:
        """Curvature (n,) of the gap between the exact flanks in the transverse section (1/mm)."""
        (pinion, _), (wheel, _) = self.places
        return 1 / pinion + 1 / wheel


def contact_lines(
    pair: GearPair, line: LineOfAction, flank: SolidFlank, pinion_length: float, cells: int, farthest_gap: float
) -> tuple[ContactLine, ...]:
    """Return the lines when the middle pair of teeth touches at `pinion_length` (mm from T1) in the middle of the common face
    width.

    Cells count where the exact flanks are nearer than `farthest_gap` (mm).
    """
    common, width = pair.common_width, pair.common_width.width
    edges = np.linspace(-width / 2, width / 2, cells + 1)
    slope = math.tan(flank.helix)
    reach = math.ceil((sum(abs(each.last) for each in line.flanks) + width * abs(slope)) / line.pitch)
    pinion_start = pair.pinion.face_width / 2 + common.offset
    wheel_start = pair.wheel.face_width / 2 + common.offset - pair.axial_offset
    middle = (edges[1:] + edges[:-1]) / 2
    found = []
    for tooth in range(-reach, reach + 1):
        start = pinion_length + tooth * line.pitch
        nominal = start + middle * slope
        if not overlap_of(line, nominal).usable.any():
            continue
        usable, (one, other, aside, gap, distance) = _facing(line, nominal)
        here = usable & (gap < farthest_gap)
        if not here.any():
            continue
        _, (at_ends, *_) = _facing(line, start + edges * slope)
        ends = flank.points((at_ends, edges + pinion_start))
        places = PerGear((one[here], middle[here] + pinion_start), (other[here], middle[here] + wheel_start))
        lengths = np.linalg.norm(np.diff(ends, axis=0), axis=1)[here]
        found.append(
            ContactLine(
                tooth,
                middle[here],
                nominal[here],
                places,
                lengths,
                aside[here],
                gap[here],
                flank.points(places.pinion),
                distance[here],
                slope,
                _edges(line, nominal[here], aside[here]),
            )
        )
    return tuple(found)


def _edges(line: LineOfAction, nominal: Floats, aside: Floats) -> TipEdges:
    """Return the forces of cells (n,), of which an edge touches those that are not 0 `aside` (mm)."""
    if not aside.any():
        return TipEdges.none(len(nominal))
    return tip_edges(line, overlap_of(line, nominal).touching)


class _Overlap(NamedTuple):
    """Roll lengths (n,) of both flanks that touch (mm); they face each other from `low` to `high` (n,) along the tangent (mm)
    if `usable`.
    """

    touching: PerGear[Floats]
    low: Floats
    high: Floats
    usable: Bools


def overlap_of(line: LineOfAction, nominal: Floats) -> _Overlap:
    """Return the overlap of flanks that touch at places (n,) of the line of action (mm from T1)."""
    one, other = line.flanks
    bent, touching = _bent(line), PerGear(nominal, line.whole - nominal)
    usable = (nominal > bent.pinion[0]) & (touching.wheel > bent.wheel[0])
    first, second = (np.clip(lengths, *within) for lengths, within in zip(touching, bent, strict=True))
    high = np.minimum(one.along_tangent(first, one.last), -other.along_tangent(second, other.first))
    low = np.maximum(one.along_tangent(first, one.first), -other.along_tangent(second, other.last))
    return _Overlap(PerGear(first, second), low, high, usable & (low < high))


def _facing(line: LineOfAction, nominal: Floats) -> tuple[Bools, tuple[Floats, Floats, Floats, Floats, Floats]]:
    """Return where flanks are usable, and five values (n,) in mm for the place where they are nearest.

    These are both roll lengths, how far aside that place is, the gap, and how far inside the ends of both flanks it is.
    """
    one, other = line.flanks
    (first, second), low, high, usable = overlap_of(line, nominal)
    aside = np.clip(0.0, low, high)
    lengths, behind = one.facing(first, aside)
    wheel_lengths, wheel_behind = other.facing(second, -aside)
    return usable, (lengths, wheel_lengths, aside, behind + wheel_behind, np.minimum(high, -low))


def _bent(line: LineOfAction) -> PerGear[tuple[float, float]]:
    """Return the range of roll lengths (mm) in which flanks in contact have a usable curvature.

    Between T1 and T2 where these lie apart; beyond T1 where that of a ring lies behind it.
    """
    least = LEAST_LENGTH * line.module
    if line.whole > 0:
        return PerGear((least, line.whole - least), (least, line.whole - least))
    return PerGear((least, math.inf), (-math.inf, line.whole - least))


def near_path(line: LineOfAction, farthest_gap: float) -> float:
    """Return the length (mm) of the line of action over which exact flanks, or edges of their tips, come nearer than a gap
    (mm).
    """
    nominal = np.linspace(0.0, sum(max(abs(each.first), abs(each.last)) for each in line.flanks), _PLACES)
    usable, (*_, gap, _) = _facing(line, nominal)
    return float(np.ptp(nominal[usable & (gap < farthest_gap)]))


def start_distances(line: ContactLine, action: LineOfAction) -> PerGear[Floats]:
    """Return distances (n,) in mm along the tangent from the cells to the transitions of each flank, as `start_distance`.

    Infinite without a linear relief.
    """
    found = []
    for flank, (lengths, _) in zip(action.flanks, line.places, strict=True):
        nearest = np.full(line.across.shape, math.inf)
        for onset in onsets(flank):
            nearest = np.minimum(nearest, start_distance(flank.base_radius, onset, lengths, 1 / line.curvature))
        found.append(nearest)
    return PerGear(*found)


class Gaps(NamedTuple):
    """Gaps of all cells: the gap (n,) along the normal in mm, and the reduced radius (n,) in the normal section in mm."""

    normal: Floats
    radii: Floats


def gaps(lines: tuple[ContactLine, ...], pair: GearPair, mounting: Mounting, helix: float) -> Gaps:
    """Return the gaps and curvatures of all cells: of the exact flanks, their modifications, and the mounting.

    A misaligned axis of the wheel is turned, as a rigid body, about its middle in the common face width. Turned in the plane
    of action it recedes along the line of action and moves along the axis; turned across it, flanks face each other nearer to
    tip or root, which only modified flanks feel. A pitch error belongs to the tooth in the middle.
    """
    found = [
        line_gap(line, pair, mounting, helix, [_taken_back(pair, places) for places in places_beside(line, pair, mounting)])
        for line in lines
    ]
    return Gaps(*(np.concatenate(parts) for parts in zip(*found, strict=True)))


def line_gap(
    line: ContactLine, pair: GearPair, mounting: Mounting, helix: float, depths: Sequence[Floats] | Floats
) -> tuple[Floats, Floats]:
    """Return the gaps along the normal and reduced radii (..., n) in mm of a line, flanks taken back by `depths` (..., n) in mm
    at the `places_beside` it.
    """
    here, before, middle, after = depths
    step = BEND * pair.pinion.normal_module
    bend = (after - 2 * middle + before) / step**2
    curvature = np.maximum(line.curvature + bend, _LEAST_BEND * line.curvature)
    # Where the depth slopes, the flanks are nearest a little aside: the gap is a parabola there.
    slope = np.where(line.on_edge, 0.0, (after - before) / (2 * step) - bend * _tangent_step(line, pair, mounting))
    transverse = line.gap + here - slope**2 / (2 * curvature)
    if line.tooth == 0:
        transverse = transverse - mounting.pitch_error / 1000
    return transverse * math.cos(helix) + turned_back(line, pair, mounting, helix), 1 / (curvature * math.cos(helix))


def turned_back(line: ContactLine, pair: GearPair, mounting: Mounting, helix: float) -> Floats:
    """Return the gap (n,) of the cells along the normal by a misalignment in the plane of action and by supports, in mm."""
    turn = mounting.misalignment / 1000 / pair.common_width.width
    result: Floats = turn * (line.across * math.cos(helix) - line.places.wheel[0] * math.sin(helix)) + line.supported
    return result


def places_beside(line: ContactLine, pair: GearPair, mounting: Mounting) -> list[PerGear[Places]]:
    """Return the places on the pinion's and the wheel's flank on the line, and three along the tangent, towards the pinion's
    tip, which are what it takes to tell slope and curvature: a little before the line, on it and after it, or at the ends of
    the flanks as near to it as they all lie on them.

    The wheel has slid along the tangent where its axis is turned across, so that the pinion meets it nearer to its tip.
    """
    step, aside = BEND * pair.pinion.normal_module, _tangent_step(line, pair, mounting)
    found = []
    for place in (np.zeros_like(aside), aside - step, aside, aside + step):
        pinion, wheel = (
            (_along_tangent(gear, lengths, sense * place + moved), heights)
            for gear, (lengths, heights), sense, moved in _sides(line, pair, mounting)
        )
        found.append(PerGear(pinion, wheel))
    return found


def _along_tangent(gear: Gear, lengths: Floats, towards_tip: Floats) -> Floats:
    """Return roll lengths (n,) at distances (n,) in mm along the tangent from other roll lengths."""
    square = np.maximum(lengths**2 + gear.base_diameter * towards_tip, 0.0)
    return np.copysign(np.sqrt(square), gear.base_diameter)


def _sides(line: ContactLine, pair: GearPair, mounting: Mounting) -> PerGear[tuple[Gear, Places, int, Floats]]:
    """Return both gears with their places, the sense of the tangent towards their tips, and their displacement (n,) in mm along
    it.
    """
    slid = mounting.misalignment_across / 1000 / pair.common_width.width * line.across
    pinion, wheel = line.places
    return PerGear((pair.pinion, pinion, 1, np.zeros_like(slid)), (pair.wheel, wheel, -1, slid))


def _tangent_step(line: ContactLine, pair: GearPair, mounting: Mounting) -> Floats:
    """Return the distance (n,) in mm along the tangent from the line at which slope and curvature are taken.

    No end of a flank is passed: beyond it a modification goes on no more.
    """
    step, low, high = (
        BEND * pair.pinion.normal_module,
        np.full_like(line.across, -math.inf),
        np.full_like(line.across, math.inf),
    )
    for gear, (lengths, _), sense, moved in _sides(line, pair, mounting):
        form = gear.flank_form
        first, last = ((end**2 - lengths**2) / gear.base_diameter - moved for end in (form.first, form.last))
        low, high = (
            (np.maximum(low, first), np.minimum(high, last))
            if sense > 0
            else (
                np.maximum(low, -last),
                np.minimum(high, -first),
            )
        )
    result: Floats = np.clip(0.0, low + step, high - step)
    return result


def _taken_back(pair: GearPair, places: PerGear[Places]) -> Floats:
    """Return the depth (n,) in mm by which both flanks together are taken back at places on them."""
    depths = []
    for gear, (lengths, heights) in zip(gears_loaded_left(pair), places, strict=True):
        form = gear.flank_form
        if not form.modification.present:
            depths.append(np.zeros_like(lengths))
            continue
        # The point that stands there now comes from further down the flank, by what it was taken back.
        depths.append(form.depth(lengths - form.depth(lengths, heights), heights))
    result: Floats = depths[0] + depths[1]
    return result


OWN_DISTANCE = math.exp(-0.5) / 2
"""Ratio c/a = 0.30327."""

_LEAST = 1e-3
"""Share of the mean load per length for which the ellipse of a cell is wide enough, however little it carries."""

_ROUNDS = 60
_SETTLED = 1e-9
"""Rounds of fitting the ellipses to the loads, and the relative error of half widths at which they have settled."""

_EVENED = (1, 2, 4, 8)
"""Half widths of an even load over which loads are evened out, in turn until the contact settles: where a few cells carry all,
their own half widths are as many times greater.
"""

_SHARES, _DECREASE = (1.0, 0.5, 0.25), 0.1
"""Shares of Newton's step that are tried, and the share of the decrease it promises that one must reach: with shorter ones it
creeps along a kink."""

_PARTS = (0.5, 0.3, 0.8)
"""Shares of the fixed point's step, in turn, that are taken where Newton's does not help: one alone could repeat a cycle."""

_LONGEST = 1.5
"""Largest change of the logarithm of a half width in one step."""


@dataclass(frozen=True)
class Responses:
    """Responses of both bodies at one position: `smooth` (n, n) normal displacements (mm/N) without the half-space's part.

    `apart` (n, n) are the distances (mm) of cells on the same flank, infinite on different ones; `lengths` (n,) of the cells
    (mm); `modulus` E_r (MPa), 1/E_r = sum (1 - nu^2)/E. `supports` are those of the gears, None for rigid ones.
    """

    lines: tuple[ContactLine, ...]
    smooth: PerGear[Floats]
    apart: Floats
    lengths: Floats
    modulus: float
    supports: SupportedCells | None = None

    @property
    def both(self) -> Floats:
        """`smooth` of both bodies together (n, n), and what their supports give way."""
        bodies = self.smooth.pinion + self.smooth.wheel
        return bodies if self.supports is None else bodies + self.supports.matrix

    def on(self, supports: SupportCompliance) -> Responses:
        """Return the same responses of gears whose supports give way."""
        across = np.concatenate([line.across for line in self.lines])
        lengths = PerGear.each(lambda role: np.concatenate([line.places.pick(role)[0] for line in self.lines]))
        cells = supports.cells(across, lengths)
        lines = tuple(replace(line, supported=gap) for line, gap in zip(self.lines, self.split(cells.gap), strict=True))
        return replace(self, lines=lines, supports=cells)

    @cached_property
    def arms(self) -> Floats:
        """Lever arms (n,) of the forces on the pinion over its base radius: what cells take part in its torque and its turn."""
        return np.concatenate([line.edges.arms.pinion for line in self.lines])

    @property
    def cells(self) -> int:
        """Cells of all lines."""
        return len(self.lengths)

    def split(self, values: Floats) -> list[Floats]:
        """Return the values of all cells (..., n) by line."""
        return np.split(values, np.cumsum([len(line.across) for line in self.lines])[:-1], axis=-1)

    def half_space(self, half_widths: Floats) -> Floats:
        """Return the displacements (n, n) in mm/N of both half-spaces, for ellipses as wide as that (mm) on each side."""
        result = np.zeros_like(self.apart)
        for here in self._own_cells:
            apart, own, half = self.apart[here, here], OWN_DISTANCE * half_widths[here], self.lengths[here] / 2
            kernel = (np.arcsinh((apart + half) / own) - np.arcsinh((apart - half) / own)) / self.lengths[here]
            result[here, here] = kernel / (math.pi * self.modulus)
        return result

    def half_space_slopes(self, half_widths: Floats) -> Floats:
        """Return the derivatives (n, n) in mm/N of `half_space` by the logarithm of the half width of the loaded cell."""
        result = np.zeros_like(self.apart)
        for here in self._own_cells:
            apart, own, half = self.apart[here, here], OWN_DISTANCE * half_widths[here], self.lengths[here] / 2
            far, near = apart + half, apart - half
            kernel = (near / np.hypot(near, own) - far / np.hypot(far, own)) / self.lengths[here]
            result[here, here] = kernel / (math.pi * self.modulus)
        return result

    @property
    def _own_cells(self) -> list[slice]:
        """The cells of each line."""
        ends = np.cumsum([0, *(len(line.across) for line in self.lines)]).tolist()
        return [slice(first, last) for first, last in pairwise(ends)]


def responses(lines: tuple[ContactLine, ...], bodies: PerGear[SolidCompliance], modulus: float) -> Responses:
    """Return the responses of both bodies to loads on all cells of a position."""
    smooth = PerGear.each(lambda role: _smooth(lines, bodies.pick(role), role))
    sizes = [len(line.across) for line in lines]
    apart = np.full((sum(sizes), sum(sizes)), np.inf)
    start = 0
    for line, size in zip(lines, sizes, strict=True):
        here = slice(start, start + size)
        apart[here, here] = np.linalg.norm(line.points[:, None] - line.points, axis=-1)
        start += size
    return Responses(lines, smooth, apart, np.concatenate([line.lengths for line in lines]), modulus)


def _smooth(lines: tuple[ContactLine, ...], body: SolidCompliance, role: Role) -> Floats:
    places = [line.places.pick(role) for line in lines]
    rows, columns = [body.moved_weights(each) for each in places], [body.load_weights(each) for each in places]
    blocks: list[list[Floats]] = []
    for moved, place, row in zip(lines, places, rows, strict=True):
        blocks.append([])
        for loaded, column in zip(lines, columns, strict=True):
            response = body.moved.get((moved.tooth - loaded.tooth) * TOOTH_ORDER.pick(role))
            block = np.zeros((len(row), len(column))) if response is None else row @ response @ column.T
            if moved is loaded:
                block += body.images.normal(place, place)
            blocks[-1].append(block)
    matrix = np.block(blocks)
    result: Floats = (matrix + matrix.T) / 2
    if any(line.edges.tilts.pick(role).any() for line in lines):
        result += _tilted(lines, body, role, rows, columns)
    return result


def _tilted(
    lines: tuple[ContactLine, ...], body: SolidCompliance, role: Role, rows: list[Floats], columns: list[Floats]
) -> Floats:
    """Return what is added to the responses (n, n) in mm/N where forces on tip edges are not normal to the flank.

    They are tilted in the transverse section: a cell then moves in the direction of its force by u_n - t cos(beta_b) u_s, with
    u_s towards the tip; so does a normal force that which moves there, by reciprocity.
    """
    blocks: list[list[Floats]] = []
    for moved, row in zip(lines, rows, strict=True):
        blocks.append([])
        tilts = -math.cos(body.flank.helix) * moved.edges.tilts.pick(role)[:, None]
        for loaded, column in zip(lines, columns, strict=True):
            response = body.along.get((moved.tooth - loaded.tooth) * TOOTH_ORDER.pick(role)) if tilts.any() else None
            block = np.zeros((len(row), len(column))) if response is None else row @ response @ column.T
            if moved is loaded and tilts.any():
                block += body.taken_off_along(moved.places.pick(role))
            blocks[-1].append(tilts * block)
    matrix = np.block(blocks)
    result: Floats = matrix + matrix.T
    return result


@dataclass(frozen=True)
class LineSolution:
    """Forces (n,) in N of the cells, the approach along the normal (mm), and the pinion's and the wheel's parts of it.

    `rigid` (mm) is what of the approach needs no load, `starts` are the cells beside the start of a linear relief. Of the
    approach under load `by_supports` (mm) is the supports' part: the work of the forces on them, over their sum.
    """

    given: Responses
    gaps: Gaps
    forces: Floats
    approach: float
    rigid: float
    parts: PerGear[float]
    by_supports: float = 0.0
    starts: StartCells | None = None

    @property
    def elastic(self) -> float:
        """Approach by what teeth and bodies give way under load (mm)."""
        return self.approach - self.rigid - self.by_supports

    @property
    def gap_of_supports(self) -> Floats:
        """Gap (n,) along the normal that supports leave under load (mm)."""
        if self.given.supports is None:
            return np.zeros_like(self.forces)
        return self.given.supports.gap + self.given.supports.matrix @ self.forces

    @property
    def turn_of_supports(self) -> float:
        """Lag of the wheel along the normal by the twist of supports, up to the middles of the faces (mm)."""
        supports = self.given.supports
        return 0.0 if supports is None else float(supports.turns @ self.forces) + supports.turned

    @property
    def half_widths(self) -> Floats:
        """Half width (n,) in mm of each cell, Hertz's but for those beside the start of a linear relief."""
        result = half_widths(self.given, self.gaps.radii, self.forces)
        if self.starts is not None:
            result[self.starts.cells] = self.starts.half_widths
        return result

    @property
    def pressures(self) -> Floats:
        """Greatest pressure (n,) in MPa across each cell, Hertz's but for those beside the start of a linear relief."""
        result = peak_pressure(self.forces / self.given.lengths, self.gaps.radii, self.given.modulus)
        if self.starts is not None:
            result[self.starts.cells] = np.where(self.forces[self.starts.cells] > 0, self.starts.peaks, 0.0)
        return result


@dataclass(frozen=True)
class StartCells:
    """Cells (k,) beside the start of a linear relief: half widths in mm, greatest pressures in MPa.

    `sound` is False where these are not to be told: the transition is too short for the places of a contact, or the end of a
    flank lies in it.
    """

    cells: Wholes
    half_widths: Floats
    peaks: Floats
    sound: Bools


def half_widths(given: Responses, radii: Floats, forces: Floats) -> Floats:
    """Hertz half widths (n,) in mm of cells that carry `forces` (n,) in N."""
    return half_width(forces / given.lengths, radii, given.modulus)


def plain_widths(given: Responses, curvature: Floats, helix: float, forces: Floats) -> Floats:
    """Return Hertz's half widths in mm of cells on exact flanks, whose `curvature` (1/mm) is that in the transverse section.

    `helix` (rad) is on the base cylinder, `forces` in N.
    """
    return half_widths(given, 1 / (curvature * math.cos(helix)), forces)


def evened_loads(given: Responses, gap: Gaps, forces: Floats) -> Floats:
    """Return the loads per length (n,) in N/mm that decide how wide cells are: forces (n,) in N, evened out along the lines."""
    even = forces.sum() * given.lengths / given.lengths.sum()
    spread = _spread(given, half_widths(given, gap.radii, even))
    result: Floats = spread @ np.maximum(forces, _LEAST * even) / given.lengths
    return result


def solve_lines(given: Responses, gap: Gaps, force: float, like: Floats | None = None) -> LineSolution:
    """Press the gears together with the normal force `force` (N), from forces (n,) `like` those sought. Raises SolverError.

    The force is that of the torque on the pinion at its base radius; cells on tip edges have other arms.

    Newton's rule on the logarithms of the half widths: each cell's width must be that of Hertz for the load that it then
    carries. Steps are shortened until the residual falls; the cells that carry change with the widths.
    """
    for times in _EVENED:
        problem = _Widths(given, gap, force, given.both, force * given.lengths / given.lengths.sum(), times)
        state = problem.settled(problem.even if like is None else like)
        if state.error < _SETTLED:
            break
    else:
        raise SolverError(
            f"the widths of the contact did not settle (half width {state.widths.max():.3g} mm, "
            f"off by {100 * state.error:.2g} %): reduce load.torque or mounting.misalignment, or raise check.refinement"
        )
    forces = state.forces
    contact = float(forces @ state.kernel @ forces)
    parts = given.smooth.map(lambda matrix: float(forces @ matrix @ forces + contact / 2) / force)
    supports = 0.0 if given.supports is None else float(forces @ given.supports.matrix @ forces) / force
    return LineSolution(given, gap, forces, state.approach, float(gap.normal.min()), parts, supports)


@dataclass(frozen=True)
class _State:
    """Contact with ellipses of half `widths` (n,) in mm: `forces` (n,) in N, and the half widths `wanted` (n,) by these."""

    widths: Floats
    kernel: Floats
    forces: Floats
    approach: float
    wanted: Floats

    @property
    def residual(self) -> Floats:
        """Logarithm (n,) of the wanted half widths over those that were taken."""
        result: Floats = np.log(self.wanted / self.widths)
        return result

    @property
    def error(self) -> float:
        """Greatest size of the residual."""
        return float(np.abs(self.residual).max())


@dataclass(frozen=True)
class _Widths:
    """The equation for the half widths of all cells; `smooth` (n, n) in mm/N, `even` (n,) the even load in N, loads evened out
    over so many `times` its half widths.
    """

    given: Responses
    gap: Gaps
    force: float
    smooth: Floats
    even: Floats
    times: int = 1

    @cached_property
    def spread(self) -> Floats:
        """Weights (n, n) that even out forces along the lines."""
        return _spread(self.given, self.times * half_widths(self.given, self.gap.radii, self.even))

    def settled(self, like: Floats) -> _State:
        """Return the state after the last round, from the widths of forces (n,) in N on."""
        evened = self.spread @ np.maximum(like, _LEAST * self.even)
        state = self.at(half_widths(self.given, self.gap.radii, evened), like > 0)
        for count in range(_ROUNDS):
            if state.error < _SETTLED:
                break
            state = self.better(state, _PARTS[count % len(_PARTS)])
        return state

    def at(self, widths: Floats, start: Bools) -> _State:
        """Solve the contact for given half widths (n,) in mm, from the cells that carry at the `start` (n,)."""
        kernel = self.given.half_space(widths)
        forces, approach = complementary(self.smooth + kernel, self.gap.normal, self.given.arms, self.force, start)
        evened = self.spread @ np.maximum(forces, _LEAST * self.even)
        return _State(widths, kernel, forces, approach, half_widths(self.given, self.gap.radii, evened))

    def better(self, state: _State, part: float) -> _State:
        """Return a state of less residual by Newton's step or, where a kink stops it, after a `part` of the fixed point's."""
        carries = state.forces > 0
        step = self._newton_step(state)
        longest = min(1.0, _LONGEST / max(float(np.abs(step).max()), _SETTLED))
        for share in (longest * each for each in _SHARES):
            tried = self.at(state.widths * np.exp(share * step), carries)
            if np.linalg.norm(tried.residual) < (1 - _DECREASE * share) * np.linalg.norm(state.residual):
                return tried
        # The fixed point's own step may raise the residual: it leaves the kink at which Newton's ends.
        return self.at(state.widths * np.exp(part * state.residual), carries)

    def _newton_step(self, state: _State) -> Floats:
        """Return the change (n,) of the logarithms of the half widths by the exact derivative, while the same cells carry."""
        carry = np.flatnonzero(state.forces > 0)
        count, cells = len(carry), len(state.widths)
        system = np.zeros((count + 1, count + 1))
        system[:count, :count] = (self.smooth + state.kernel)[carry[:, None], carry]
        system[:count, count] = system[count, :count] = -self.given.arms[carry]
        moved = np.zeros((count + 1, cells))
        moved[:count] = -(self.given.half_space_slopes(state.widths) * state.forces)[carry]
        changed = np.zeros((cells, cells))
        evened = self.spread @ np.maximum(state.forces, _LEAST * self.even)
        try:
            changed[carry] = np.linalg.solve(system, moved)[:count]
            changed[state.forces <= _LEAST * self.even] = 0.0
            slopes = (self.spread @ changed) / (2 * evened[:, None])
            return np.asarray(np.linalg.solve(np.eye(cells) - slopes, state.residual), float)
        except np.linalg.LinAlgError:
            return state.residual


def _spread(given: Responses, widths: Floats) -> Floats:
    """Return the weights (n, n) that even out forces over about a half width along the line.

    An ellipse cannot change its width faster than that; cells that are shorter would each go their own way.
    """
    near = np.exp(-((given.apart / widths[:, None]) ** 2)) * given.lengths
    result: Floats = near / near.sum(axis=1, keepdims=True) * (given.lengths[:, None] / given.lengths)
    return result
