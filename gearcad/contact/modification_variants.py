"""Contact of many modifications of the same flanks: transmission error and pressure of each, on bodies already solved.

The ellipse of a cell follows its load by the diagonal alone: other cells hardly see how wide it is.

The bodies answer as in `line_contact`; only gaps differ between variants, and contacts are solved by `side_by_side`.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from gearcad.contact.load_range import LoadRange
from gearcad.contact.shared.line_of_action import TransverseFlank, gears_loaded_left
from gearcad.contact.shared.loaded import INTERIOR
from gearcad.contact.shared.local_contact import Onset, onsets, start_distance
from gearcad.contact.solid.line_contact import OWN_DISTANCE, Responses, half_widths, line_gap, places_beside, plain_widths
from gearcad.contact.solid.pair import SolidPair
from gearcad.core.records import Bools, Floats, PerGear, Role
from gearcad.geometry import FlankForm, GearPair, ReliefShape
from gearcad.geometry.modification import ASSUMED_TRANSITION, LEAST_TRANSITION, longest_transition
from gearcad.mounting import Mounting
from gearcad.rating.contact_stress import peak_pressure

_BED = 0.15
"""Stiffness of a bed of springs, per length, that deflects about as teeth do: a share of the reduced modulus."""

_LEAST = 1e-3
"""Share of the mean load per length for which the ellipse of a cell is wide enough, however little it carries."""

_OPEN = 1e-9
"""Overlap (mm) below which it is rounding."""

_ROUNDS = 25
_SETTLED = 1e-4
"""Largest number of searches for the cells that carry, and the relative change of the approach at which their widths have
settled.
"""


def press(given: Responses, matrix: Floats, gap: Floats, radii: Floats, force: float) -> tuple[Floats, Floats]:
    """Return the forces (v, n) in N of all cells, and approaches (v,) in mm, infinite where no set of cells settles.

    `matrix` (n, n) in mm/N is the compliance but for what a cell's own ellipse adds to the diagonal; `gap` and `radii` (v, n)
    are in mm, `force` in N.
    """
    least = _LEAST * force * given.lengths / given.lengths.sum()
    forces, approach = _on_springs(gap, given.lengths, force, _BED * given.modulus)
    active = forces > 0
    found, approaches = np.zeros_like(gap), np.full(len(gap), np.inf)
    todo = np.arange(len(gap))
    for _ in range(_ROUNDS):
        own = _own(given, half_widths(given, radii[todo], np.maximum(forces, least)))
        forces, changed = _equations(matrix, own, gap[todo], force, given.arms, active)
        opening = forces @ matrix.T + own * forces + gap[todo] - changed[:, None] * given.arms
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
    """Return the forces (v, n) and approach (v,) of cells that do not feel each other: a start, closed by sorting the gaps."""
    order = np.argsort(gap, axis=1)
    ordered, along = np.take_along_axis(gap, order, 1), lengths[order]
    levels = (force / stiffness + np.cumsum(along * ordered, axis=1)) / np.cumsum(along, axis=1)
    last = (ordered < levels).sum(axis=1) - 1
    approach = levels[np.arange(len(gap)), last]
    return stiffness * lengths * np.maximum(approach[:, None] - gap, 0.0), approach


def _own(given: Responses, widths: Floats) -> Floats:
    """Return the compliance (v, n) in mm/N that the ellipse of each cell adds to its own: the diagonal of
    `Responses.half_space`.
    """
    result: Floats = 2 * np.arcsinh(given.lengths / 2 / (OWN_DISTANCE * widths)) / given.lengths / (math.pi * given.modulus)
    return result


def _equations(matrix: Floats, own: Floats, gap: Floats, force: float, arms: Floats, active: Bools) -> tuple[Floats, Floats]:
    """Return the forces and approach where exactly the `active` cells touch: systems of equal size, filled up by rows of
    identity. `arms` (n,) are those of `Responses`.
    """
    most = int(active.sum(axis=1).max())
    cells = np.argsort(~active, axis=1, kind="stable")[:, :most]
    real = np.take_along_axis(active, cells, 1)
    system = matrix[cells[:, :, None], cells[:, None, :]] * (real[:, :, None] & real[:, None, :])
    steps = np.arange(most)
    system[:, steps, steps] += np.where(real, np.take_along_axis(own, cells, 1), 1.0)
    lever = np.where(real, arms[cells], 0.0)
    right = np.stack([np.where(real, np.take_along_axis(gap, cells, 1), 0.0), lever], -1)
    by_gap, by_approach = np.moveaxis(np.linalg.solve(system, right), -1, 0)
    approach = (force + (lever * by_gap).sum(axis=1)) / (lever * by_approach).sum(axis=1)
    forces = np.zeros_like(gap)
    np.put_along_axis(forces, cells, approach[:, None] * by_approach - by_gap, 1)
    return forces, approach


AMOUNTS = (
    "pinion.tip_relief",
    "pinion.tip_relief_length",
    "wheel.tip_relief",
    "wheel.tip_relief_length",
    "pinion.lead_crowning",
    "pinion.helix_angle_modification",
)
"""Quantities that vary, in the order of the columns of a table of variants; amounts in µm, lengths in mm."""

_ENDS = (-0.02, 0.06)
"""Where, from the ends of the path of contact outwards and as shares of the base pitch, edges of tips carry loads that rise and
fall within a hundredth of it."""

_SHORT = 1e-6
"""Length (mm) of a relief that is not there."""


@dataclass(frozen=True)
class Condition:
    """Load of a variant: torque (N·m on the pinion), and deviations (µm) added to those of the mounting."""

    torque: float
    misalignment: float = 0.0
    pitch_error: float = 0.0

    def mounted(self, mounting: Mounting) -> Mounting:
        """Return the mounting with the deviations on top of its own."""
        if not self.misalignment and not self.pitch_error:
            return mounting
        return replace(
            mounting,
            misalignment=mounting.misalignment + self.misalignment,
            pinion_pitch_error=mounting.pinion_pitch_error + self.pitch_error,
        )


@dataclass(frozen=True)
class Outcomes:
    """Outcomes of variants at each position (v, positions).

    These are transmission errors in µm, the greatest interior pressures in MPa, and the shares of the load that the edges of
    tips carry. Of several `loads` the positions under each come one after another.
    """

    transmission_errors: Floats
    position_pressures: Floats
    position_edge_shares: Floats
    loads: LoadRange | None = None

    @classmethod
    def from_figures(cls, figures: Floats, loads: LoadRange | None = None) -> Outcomes:
        """Return the outcomes that `figures` (v, 3 positions) holds side by side, under several `loads` if given."""
        errors, pressures, edges = np.split(figures, 3, axis=-1)
        return cls(errors, pressures, edges, loads)

    @classmethod
    def joined(cls, parts: Sequence[Outcomes], loads: LoadRange) -> Outcomes:
        """Return the outcomes under several loads as one, from those under each."""
        errors = np.concatenate([each.transmission_errors for each in parts], axis=-1)
        pressures = np.concatenate([each.position_pressures for each in parts], axis=-1)
        edges = np.concatenate([each.position_edge_shares for each in parts], axis=-1)
        return cls(errors, pressures, edges, loads)

    @property
    def figures(self) -> Floats:
        """All quantities side by side (v, 3 positions)."""
        return np.concatenate([self.transmission_errors, self.position_pressures, self.position_edge_shares], axis=-1)

    @property
    def peak_to_peak(self) -> Floats:
        """Peak to peak (v,) of the transmission error in µm; of several loads their statistic."""
        if self.loads is not None:
            return self.loads.of(self.of_each_load)
        result: Floats = np.ptp(self.transmission_errors, axis=-1)
        return result

    @property
    def of_each_load(self) -> Floats:
        """Peak to peak (v, k) of the transmission error in µm under each load."""
        count = 1 if self.loads is None else len(self.loads.torques)
        errors = self.transmission_errors
        result: Floats = np.ptp(errors.reshape(*errors.shape[:-1], count, -1), axis=-1)
        return result

    @property
    def pressures(self) -> Floats:
        """Greatest interior pressure of all positions (v,) in MPa; infinite where no position has one.

        Where all contact is beside edges and kinks no pressure is known: such a variant keeps to no bound.
        """
        greatest = self.position_pressures.max(axis=-1)
        return np.where(greatest > 0, greatest, math.inf)

    @property
    def edge_shares(self) -> Floats:
        """The greatest share of the load that the edges of tips carry at any position (v,)."""
        result: Floats = self.position_edge_shares.max(axis=-1)
        return result


def with_amounts(pair: GearPair, amounts: Floats, shape: ReliefShape) -> GearPair:
    """Return the pair with the amounts (6,) of a variant. Raises GeometryError where they do not fit the gears."""
    gears = []
    for role, gear in pair.gears.items():
        given = _named_amounts(amounts, role)
        form, length = gear.flank_form, given.get("tip_relief_length", 0.0)
        transition = fitting_transition(form, shape, length)
        changed = replace(gear.modification, **given, tip_relief_shape=shape, tip_relief_transition=transition)
        gears.append(replace(gear, modification=changed))
    return replace(pair, pinion=gears[0], wheel=gears[1])


def fitting_transition(form: FlankForm, shape: ReliefShape, length: float) -> float | None:
    """Return the transition (mm of roll) that was given for a tip relief, or as much of it as fits one of that length."""
    given = form.modification.tip_relief_transition
    if given is None or shape is ReliefShape.PARABOLIC:
        return None
    if not length:
        return given
    longest = float(longest_transition(length, form.last - form.first))
    return min(given, longest) if given and longest > LEAST_TRANSITION else 0.0


def _named_amounts(amounts: Floats, role: Role) -> dict[str, Any]:
    """Return the amounts (6,) of a gear's modification by name, without the length of a relief that is absent."""
    named = (name.split(".") for name in AMOUNTS)
    own = {name: value for (owner, name), value in zip(named, amounts.tolist(), strict=True) if owner == role.value}
    return {name: value for name, value in own.items() if value or not name.endswith("_length")}


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
        """Return the depth (v, n) in mm of the relief of the loaded, left flank, as `FlankForm.depth`."""
        form = self.form
        along = np.clip(heights, 0.0, form.width) / form.width
        left = form.last - np.clip(lengths, form.first, form.last)
        amount = self.relief * self.shape.grown(1 - left / self.length, self.transition / self.length)
        amount = amount + (self.crowning * (2 * along - 1) ** 2 - self.helix * (along - 0.5) * form.hand)
        result: Floats = amount / 1000
        return result + form.depth(lengths, heights) if form.modification.present else result

    def taken_back(self, lengths: Floats, heights: Floats) -> Floats:
        """Return the depth (v, n) in mm of the modifications at these places of the modified flank.

        The point that stands there comes from further down the flank.
        """
        return self.depth(lengths - self.depth(lengths, heights), heights)

    @property
    def transition(self) -> Floats:
        """Transitions (v, 1) in mm of roll of the linear reliefs, as `FlankForm.transitions`; 0 of others."""
        form = self.form
        wanted = form.modification.tip_relief_transition
        longest = longest_transition(self.length, form.last - form.first)
        fitting = np.minimum(ASSUMED_TRANSITION * form.module if wanted is None else wanted, longest)
        return np.where((self.relief > 0) & (longest > 0), fitting, 0.0) * (self.shape is ReliefShape.LINEAR)

    def start_distance(self, lengths: Floats, curvature: Floats) -> Floats:
        """Return distances (v, n) in mm from contacts at roll lengths (n,) to the nearest transition, as `start_distance`.

        `curvature` (n,) in 1/mm is that of the exact flanks.
        """
        base, starts = self.form.base_radius, self.form.last - self.length
        nearest = np.full((len(self.relief), len(lengths)), math.inf)
        if self.shape is ReliefShape.LINEAR:
            stretch = base / np.maximum(starts, _SHORT)
            own: Onset[Floats] = Onset(starts, self.transition / stretch, self.relief / 1000 / self.length * stretch, 1)
            varied = (self.relief > 0) & (starts > self.form.first)
            nearest = np.where(varied, start_distance(base, own, lengths, 1 / curvature), math.inf)
        for onset in onsets(TransverseFlank(self.form, 0.0)):
            nearest = np.minimum(nearest, start_distance(base, onset, lengths, 1 / curvature))
        return nearest


@dataclass(frozen=True)
class FlankVariants:
    """Variants of the flanks of a solid pair, at `count` positions over a base pitch, and as many as `at_ends` more where a tip
    comes into contact, and where one leaves it, and at `more` roll angles (deg); what varies replaces the pair's own.

    `roomy` is a model of the same bodies with modifications as large as any variant's, so that its cells suffice for all.
    """

    roomy: SolidPair
    shape: ReliefShape
    count: int
    torque: float
    at_ends: int = 0
    more: tuple[float, ...] = ()

    @cached_property
    def plain(self) -> GearPair:
        """The pair without what varies."""
        return with_amounts(self.roomy.pair, np.zeros(len(AMOUNTS)), self.shape)

    @cached_property
    def positions(self) -> tuple[Responses, ...]:
        """The responses of both bodies at each position."""
        force = self.roomy.force(self.torque)
        return tuple(self.roomy.responses(angle, force) for angle in self._roll_angles.tolist())

    @cached_property
    def _roll_angles(self) -> Floats:
        """Roll angles (n,) of the positions in deg."""
        pair, pitch = self.roomy.pair, self.roomy.line.pitch
        outside = np.linspace(*_ENDS, self.at_ends) * pitch
        ends = np.concatenate([pair.path_of_contact.A - outside, pair.path_of_contact.E + outside])
        along = (ends - pair.path_of_contact.C + pitch / 2) % pitch - pitch / 2
        angles = (self.roomy.roll_angles(self.count), np.degrees(along / self.roomy.base_radius), self.more)
        return np.unique(np.concatenate(angles))

    @cached_property
    def _matrices(self) -> tuple[Floats, ...]:
        """Compliances (n, n) in mm/N of each position but for what a cell's own ellipse adds to the diagonal."""
        force, found = self.force(self.torque), []
        for given in self.positions:
            even = force * given.lengths / given.lengths.sum()
            radii = np.concatenate([1 / line.curvature for line in given.lines]) / math.cos(self.roomy.helix)
            kernel = given.half_space(half_widths(given, radii, even))
            found.append(given.both + kernel - np.diag(np.diag(kernel)))
        return tuple(found)

    def force(self, torque: float) -> float:
        """Return the normal force (N) at a torque (N·m)."""
        return self.roomy.force(torque) * self.roomy.width / math.cos(self.roomy.helix)

    def outcomes(self, amounts: Floats, condition: Condition) -> Outcomes:
        """Return the outcomes of variants (v, 6) under a condition; all are infinite for a variant whose contact does not
        settle.
        """
        force, errors, pressures, edges = self.force(condition.torque), [], [], []
        for given, matrix in zip(self.positions, self._matrices, strict=True):
            gap, radii = self.gaps(given, amounts, condition)
            forces, approach = press(given, matrix, gap, radii, force)
            errors.append(approach / math.cos(self.roomy.helix) * 1000)
            pressure, edge = self._judged(given, amounts, radii, forces, force)
            pressures.append(pressure)
            edges.append(edge)
        return Outcomes(np.stack(errors, -1), np.stack(pressures, -1), np.stack(edges, -1))

    def _flanks(self, amounts: Floats) -> PerGear[_Flanks]:
        """Return the flanks of both gears in all variants (v, 6)."""
        columns = amounts.T[..., None]
        length = np.maximum(columns[[1, 3]], _SHORT)
        nothing = np.zeros_like(columns[0])
        forms = gears_loaded_left(self.plain).map(lambda gear: gear.flank_form)
        return PerGear(
            _Flanks(forms.pinion, self.shape, columns[0], length[0], columns[4], columns[5]),
            _Flanks(forms.wheel, self.shape, columns[2], length[1], nothing, nothing),
        )

    def gaps(self, given: Responses, amounts: Floats, condition: Condition) -> tuple[Floats, Floats]:
        """Return the gaps along the normal and reduced radii (v, n) in mm of all cells of a position."""
        pinion, wheel = self._flanks(amounts)
        mounting = condition.mounted(self.roomy.mounting)
        # All lines, and all places beside them, at once: what costs is how often numpy is called.
        places = np.concatenate([np.array(places_beside(line, self.plain, mounting)) for line in given.lines], axis=-1)
        one, other = (each.swapaxes(0, 1).reshape(2, -1) for each in np.moveaxis(places, 1, 0))
        depths = (pinion.taken_back(*one) + wheel.taken_back(*other)).reshape(len(amounts), len(places), -1)
        found = [
            line_gap(line, self.plain, mounting, self.roomy.helix, each.swapaxes(0, 1))
            for line, each in zip(given.lines, given.split(depths), strict=True)
        ]
        normal, radii = zip(*found, strict=True)
        return np.concatenate(normal, axis=1), np.concatenate(radii, axis=1)

    def _judged(self, given: Responses, amounts: Floats, radii: Floats, forces: Floats, force: float) -> tuple[Floats, Floats]:
        """Return the greatest interior pressure (v,) in MPa of a position, or 0, and the share (v,) of the load on tip edges.

        Interior is what is more than INTERIOR half widths from edges and, of plain flanks, from the starts of linear reliefs.
        """
        widths = half_widths(given, radii, forces)
        pressures = peak_pressure(forces / given.lengths, radii, given.modulus)
        to_edge, across, on_edge, curvature = (
            np.concatenate(parts)
            for parts in zip(
                *((line.edge_distance, line.across, line.on_edge, line.curvature) for line in given.lines), strict=True
            )
        )
        # Beside edges the cells' own half widths decide, the lesser ones: between few positions it counts rather too much.
        margin = np.minimum(to_edge, self.roomy.width / 2 - np.abs(across)) - INTERIOR * widths
        reach = INTERIOR * plain_widths(given, curvature, self.roomy.helix, forces)
        for role, flanks in self._flanks(amounts).items():
            lengths = np.concatenate([line.places.pick(role)[0] for line in given.lines])
            margin = np.minimum(margin, flanks.start_distance(lengths, curvature) - reach)
        greatest = np.where(margin > 0, pressures, 0.0).max(axis=1)
        # Where the margin ends between two cells of a line, as `SolidPairContact.inside` has it.
        ends = (margin[:, 1:] > 0) != (margin[:, :-1] > 0)
        ends &= (forces[:, 1:] > 0) & (forces[:, :-1] > 0) & (np.diff(across) > 0)
        part = margin[:, :-1] / np.where(ends, margin[:, :-1] - margin[:, 1:], 1.0)
        between = pressures[:, :-1] + part * np.diff(pressures, axis=1)
        greatest = np.maximum(greatest, np.where(ends, between, 0.0).max(axis=1, initial=0.0))
        return greatest, np.where(on_edge, forces, 0.0).sum(axis=1) / force
