"""Many modifications of the same flanks at once: transmission error and pressure of each, on bodies already solved.

The bodies answer as in `line_contact`; only gaps differ between variants. The systems of all variants at a position are solved
together, and the ellipse of a cell follows its load by the diagonal alone: other cells hardly see how wide it is.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from gearcad.geometry import FlankForm, GearPair, ReliefShape
from gearcad.ltca.contact_lines import BEND, line_gap, places_beside
from gearcad.ltca.line_contact import OWN_DISTANCE, Responses, half_widths
from gearcad.ltca.solid_cycle import INTERIOR
from gearcad.ltca.solid_pair import SolidPair
from gearcad.mounting import Mounting

__all__ = ["AMOUNTS", "Condition", "Outcomes", "Variants", "with_amounts"]

Floats = NDArray[np.float64]
Bools = NDArray[np.bool_]

AMOUNTS = (
    "pinion.tip_relief",
    "pinion.tip_relief_length",
    "wheel.tip_relief",
    "wheel.tip_relief_length",
    "pinion.lead_crowning",
    "pinion.helix_angle_modification",
)
"""What varies, in the order of the columns of a table of variants; amounts in µm, lengths in mm."""

_BED = 0.15
"""Stiffness of a bed of springs, per length, that deflects about as teeth do: a share of the reduced modulus."""

_LEAST = 1e-3
"""Share of the mean load per length for which the ellipse of a cell is wide enough, however little it carries."""

_OPEN = 1e-9
"""Overlap (mm) that is rounding."""

_SHORT = 1e-6
"""Length (mm) of a relief that is not there."""

_ROUNDS = 25
_SETTLED = 1e-4
"""Most rounds of finding the cells that carry, and the relative change of the approach at which their widths have settled."""


@dataclass(frozen=True)
class Condition:
    """What a variant is loaded with: torque (N m on the pinion), and deviations (µm) added to those of the mounting."""

    torque: float
    misalignment: float = 0.0
    pitch_error: float = 0.0

    def mounted(self, mounting: Mounting) -> Mounting:
        """The mounting with the deviations on top of its own."""
        return replace(
            mounting,
            misalignment=mounting.misalignment + self.misalignment,
            pinion_pitch_error=mounting.pinion_pitch_error + self.pitch_error,
        )


@dataclass(frozen=True)
class Outcomes:
    """What became of each variant (v,): transmission errors (v, positions) in µm, the greatest interior pressure of all
    positions (v,) in MPa, and the greatest share of the load that the edges of tips carry at any position (v,).
    """

    transmission_errors: Floats
    pressures: Floats
    edge_shares: Floats

    @property
    def peak_to_peak(self) -> Floats:
        """Of the transmission error (v,) in µm."""
        result: Floats = np.ptp(self.transmission_errors, axis=1)
        return result


def with_amounts(pair: GearPair, amounts: Floats, shape: ReliefShape) -> GearPair:
    """The pair with the amounts (6,) of a variant. Raises GeometryError where they do not fit the gears."""
    changed = {}
    for owner in ("pinion", "wheel"):
        gear = getattr(pair, owner)
        given = {
            name.partition(".")[2]: float(value)
            for name, value in zip(AMOUNTS, amounts, strict=True)
            if name.startswith(owner) and not (name.endswith("_length") and value == 0)
        }
        changed[owner] = replace(gear, modification=replace(gear.modification, **given, tip_relief_shape=shape))
    return replace(pair, **changed)


@dataclass(frozen=True)
class _Flanks:
    """The flanks of one gear in all variants: `form` without what varies, and columns (v, 1) of that in µm and mm."""

    form: FlankForm
    shape: ReliefShape
    relief: Floats
    length: Floats
    crowning: Floats
    helix: Floats

    def depth(self, lengths: Floats, heights: Floats) -> Floats:
        """How far (v, n) the loaded, left flank is taken back (mm), as `FlankForm.depth`."""
        form = self.form
        along = np.clip(heights, 0.0, form.width) / form.width
        left = form.last - np.clip(lengths, form.first, form.last)
        amount = self.relief * self.shape.grown(1 - left / self.length)
        amount = amount + (self.crowning * (2 * along - 1) ** 2 - self.helix * (along - 0.5) * form.hand)
        result: Floats = amount / 1000
        return result + form.depth(lengths, heights) if form.modification.present else result

    def taken_back(self, lengths: Floats, heights: Floats) -> Floats:
        """How far (v, n) the flank lies behind these places (mm): what stands there comes from further down."""
        return self.depth(lengths - self.depth(lengths, heights), heights)


@dataclass(frozen=True)
class Variants:
    """Variants of the flanks of a solid pair, at `count` positions over a base pitch; what varies replaces the pair's own.

    `roomy` is a model of the same bodies with modifications as large as any variant's, so that its cells suffice for all.
    """

    roomy: SolidPair
    shape: ReliefShape
    count: int
    torque: float

    @cached_property
    def plain(self) -> GearPair:
        """The pair without what varies."""
        return with_amounts(self.roomy.pair, np.zeros(len(AMOUNTS)), self.shape)

    @cached_property
    def positions(self) -> tuple[Responses, ...]:
        """The responses of both bodies at each position."""
        force = self.roomy.force(self.torque)
        return tuple(self.roomy.responses(angle, force) for angle in self.roomy.roll_angles(self.count).tolist())

    @cached_property
    def _matrices(self) -> tuple[Floats, ...]:
        """Compliances (n, n) in mm/N of each position but for what a cell's own ellipse adds to the diagonal."""
        force, found = self.force(self.torque), []
        for given in self.positions:
            even = force * given.lengths / given.lengths.sum()
            radii = np.concatenate([1 / line.curvature for line in given.lines]) / math.cos(self.roomy.helix)
            kernel = given.half_space(half_widths(given, radii, even))
            found.append(given.smooth.sum(axis=0) + kernel - np.diag(np.diag(kernel)))
        return tuple(found)

    def force(self, torque: float) -> float:
        """Normal force (N) at a torque (N m)."""
        return self.roomy.force(torque) * self.roomy.width / math.cos(self.roomy.helix)

    def outcomes(self, amounts: Floats, condition: Condition) -> Outcomes:
        """What becomes of variants (v, 6) under a condition; all infinite for one whose contact does not settle."""
        force, errors, pressures, edges = self.force(condition.torque), [], [], []
        for given, matrix in zip(self.positions, self._matrices, strict=True):
            gap, radii = self.gaps(given, amounts, condition)
            forces, approach = _pressed(given, matrix, gap, radii, force)
            errors.append(approach / math.cos(self.roomy.helix) * 1000)
            pressure, edge = self._judged(given, forces, self._sharpest(given, amounts, radii), force)
            pressures.append(pressure)
            edges.append(edge)
        return Outcomes(np.stack(errors, -1), np.max(pressures, axis=0), np.max(edges, axis=0))

    def gaps(self, given: Responses, amounts: Floats, condition: Condition) -> tuple[Floats, Floats]:
        """Gaps along the normal and reduced radii (v, n) in mm of all cells of a position."""
        columns = amounts.T[..., None]
        length = np.maximum(columns[[1, 3]], _SHORT)
        nothing = np.zeros_like(columns[0])
        pinion = _Flanks(self.plain.pinion.flank_form, self.shape, columns[0], length[0], columns[4], columns[5])
        wheel = _Flanks(self.plain.wheel.flank_form, self.shape, columns[2], length[1], nothing, nothing)
        mounting = condition.mounted(self.roomy.mounting)
        found = []
        for line in given.lines:
            places = places_beside(line, self.plain, mounting)
            depths = [pinion.taken_back(*one) + wheel.taken_back(*other) for one, other in places]
            found.append(line_gap(line, self.plain, mounting, self.roomy.helix, depths))
        normal, radii = zip(*found, strict=True)
        return np.concatenate(normal, axis=1), np.concatenate(radii, axis=1)

    def _sharpest(self, given: Responses, amounts: Floats, radii: Floats) -> Floats:
        """Least radii (v, n) in mm that cells see until the next position: where a linear relief starts, flanks have a bend."""
        if self.shape is not ReliefShape.LINEAR:
            return radii
        near = self.roomy.line.pitch / self.count / 2
        columns = amounts.T[..., None]
        bend = np.zeros_like(radii)
        for gear, form in enumerate((self.plain.pinion.flank_form, self.plain.wheel.flank_form)):
            lengths = np.concatenate([(each.pinion, each.wheel)[gear][0] for each in given.lines])
            relief, length = columns[2 * gear], np.maximum(columns[2 * gear + 1], _SHORT)
            inside = np.abs(form.last - length - lengths) < near
            bend = np.maximum(bend, np.where(inside, relief / 1000 / length * form.base_radius / lengths, 0.0))
        exact = np.concatenate([each.curvature for each in given.lines])
        sharp = exact + bend / (BEND * self.plain.pinion.normal_module)
        return np.minimum(radii, 1 / (sharp * math.cos(self.roomy.helix)))

    def _judged(self, given: Responses, forces: Floats, radii: Floats, force: float) -> tuple[Floats, Floats]:
        """The greatest interior pressure (v,) in MPa of a position, and the share (v,) of the load on the edges of tips."""
        widths = half_widths(given, radii, forces)
        pressures = np.sqrt(forces / given.lengths * given.modulus / (math.pi * radii))
        to_edge, across, on_edge = (
            np.concatenate(parts)
            for parts in zip(*((line.edge_distance, line.across, line.on_edge) for line in given.lines), strict=True)
        )
        inside = np.minimum(to_edge, self.roomy.width / 2 - np.abs(across)) > INTERIOR * widths
        return np.where(inside, pressures, 0.0).max(axis=1), np.where(on_edge, forces, 0.0).sum(axis=1) / force


def _pressed(given: Responses, matrix: Floats, gap: Floats, radii: Floats, force: float) -> tuple[Floats, Floats]:
    """Forces (v, n) in N of all cells, and approaches (v,) in mm, infinite where no set of cells settles."""
    least = _LEAST * force * given.lengths / given.lengths.sum()
    forces, approach = _on_springs(gap, given.lengths, force, _BED * given.modulus)
    active = forces > 0
    found, approaches = np.zeros_like(gap), np.full(len(gap), np.inf)
    todo = np.arange(len(gap))
    for _ in range(_ROUNDS):
        own = _own(given, half_widths(given, radii[todo], np.maximum(forces, least)))
        forces, changed = _equations(matrix, own, gap[todo], force, active)
        opening = forces @ matrix.T + own * forces + gap[todo] - changed[:, None]
        wrong = np.where(active, forces <= 0, opening < -_OPEN)
        settled = ~wrong.any(axis=1) & (np.abs(changed - approach) < _SETTLED * np.abs(changed))
        found[todo[settled]], approaches[todo[settled]] = forces[settled], changed[settled]
        left = ~settled
        todo, forces, approach, active = todo[left], forces[left], changed[left], (active ^ wrong)[left]
        if not len(todo):
            break
        empty = ~active.any(axis=1)
        active[empty, gap[todo[empty]].argmin(axis=1)] = True
    return found, approaches


def _on_springs(gap: Floats, lengths: Floats, force: float, stiffness: float) -> tuple[Floats, Floats]:
    """Forces (v, n) and approach (v,) of cells that do not feel each other: a start, closed by sorting the gaps."""
    order = np.argsort(gap, axis=1)
    ordered, along = np.take_along_axis(gap, order, 1), lengths[order]
    levels = (force / stiffness + np.cumsum(along * ordered, axis=1)) / np.cumsum(along, axis=1)
    last = (ordered < levels).sum(axis=1) - 1
    approach = levels[np.arange(len(gap)), last]
    return stiffness * lengths * np.maximum(approach[:, None] - gap, 0.0), approach


def _own(given: Responses, widths: Floats) -> Floats:
    """What the ellipse of each cell adds to its own compliance (v, n) in mm/N: the diagonal of `Responses.half_space`."""
    result: Floats = 2 * np.arcsinh(given.lengths / 2 / (OWN_DISTANCE * widths)) / given.lengths / (math.pi * given.modulus)
    return result


def _equations(matrix: Floats, own: Floats, gap: Floats, force: float, active: Bools) -> tuple[Floats, Floats]:
    """Forces and approach where exactly the `active` cells touch: systems of equal size, filled up by rows of identity."""
    most = int(active.sum(axis=1).max())
    cells = np.argsort(~active, axis=1, kind="stable")[:, :most]
    real = np.take_along_axis(active, cells, 1)
    system = matrix[cells[:, :, None], cells[:, None, :]] * (real[:, :, None] & real[:, None, :])
    steps = np.arange(most)
    system[:, steps, steps] += np.where(real, np.take_along_axis(own, cells, 1), 1.0)
    right = np.stack([np.where(real, np.take_along_axis(gap, cells, 1), 0.0), real.astype(float)], -1)
    by_gap, by_approach = np.moveaxis(np.linalg.solve(system, right), -1, 0)
    approach = (force + by_gap.sum(axis=1)) / by_approach.sum(axis=1)
    forces = np.zeros_like(gap)
    np.put_along_axis(forces, cells, approach[:, None] * by_approach - by_gap, 1)
    return forces, approach
