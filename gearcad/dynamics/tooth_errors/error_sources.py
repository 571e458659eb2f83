"""Sources of tooth errors: the teeth of each mesh, their tolerances, their springs, and their pattern at one speed."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from gearcad.core.records import Floats, Notice, PerGear, Role
from gearcad.dynamics.tooth_errors.tooth_springs import (
    PRESSURE_ANGLE,
    PairErrors,
    ToothSpring,
    at_rest,
    cycle_spring,
    even_spring,
    pair_path,
    standard_path,
)
from gearcad.dynamics.trains.members import StiffnessWave, ToothMesh
from gearcad.dynamics.trains.mesh_excitation import CONTACT_RATIO, MeshExcitation, given_deviations, wheel_teeth
from gearcad.dynamics.trains.tooth_deviations import (
    ErrorDistribution,
    ToothDeviations,
    TransmissionError,
    random_deviations,
    tooth_errors,
)
from gearcad.dynamics.trains.train import EngagedMesh
from gearcad.geometry import GearPair
from gearcad.mesh_cycle import MeshCycle
from gearcad.rating.options import RatingOptions
from gearcad.rating.tolerances import FlankTolerances, flank_tolerances

if TYPE_CHECKING:
    from gearcad.dynamics.tooth_errors.error_kernel import Pattern


_MICRO = 1e-6

_HARMONICS = 12
"""Harmonics of the tooth frequency in smooth errors, as in the errors of a chart."""


class ErrorDraw(NamedTuple):
    """A draw of errors: gear number `sample` of a distribution, by a seed. Gear 0 is the one of a single chart."""

    distribution: ErrorDistribution
    seed: int
    sample: int


@dataclass(frozen=True, kw_only=True, eq=False)
class MeshTeeth:
    """The teeth of mesh `number` of a train: of pinion and wheel (a ring's above 0 as well), and the tolerances (µm) of both.

    Without tolerances teeth have no errors, except those `given` for the pinion. `spring` is that of a pair of teeth, where
    pairs are known one by one. The wheel's errors are drawn if `wheel_drawn`: the errors then repeat only when the same teeth
    meet. `source` names the method that gave the stiffness of the pair, if there was one.
    """

    name: str
    number: int
    teeth: PerGear[int]
    contact_ratio: float
    spring: ToothSpring | None = None
    tolerances: PerGear[FlankTolerances] | None = None
    given: ToothDeviations | None = None
    source: str = ""
    helical: bool = False
    wheel_drawn: bool = True

    @property
    def exact(self) -> bool:
        """Whether no tooth has an error."""
        return self.tolerances is None and self.given is None

    @property
    def period(self) -> int:
        """Number of teeth after which the errors repeat."""
        if self.tolerances is not None and self.wheel_drawn:
            return math.lcm(*self.teeth)
        return 1 if self.exact else self.teeth.pinion

    def _drawn(self, draw: ErrorDraw, role: Role) -> ToothDeviations | None:
        """Return the deviations (µm) of a gear, None where it has none."""
        if role is Role.PINION and self.given is not None:
            return self.given
        if self.tolerances is None or (role is Role.WHEEL and not self.wheel_drawn) or self.teeth.pick(role) < 2:
            return None
        # The pinion of sample 0 is that of a chart by itself.
        gear = () if draw.sample == 0 and role is Role.PINION else (draw.sample, 0 if role is Role.PINION else 1)
        tolerances = self.tolerances.pick(role)
        seed = draw.seed + self.number
        return random_deviations(self.teeth.pick(role), tolerances, seed, distribution=draw.distribution, gear=gear)

    def pair_errors(self, draw: ErrorDraw) -> PairErrors:
        """Return the errors (m) of every pair of teeth over one period, until the errors repeat."""
        position, slope = np.zeros(self.period), np.zeros(self.period)
        for role in Role:
            if (found := self._drawn(draw, role)) is not None:
                which = np.arange(self.period) % self.teeth.pick(role)
                position += found.position[which]
                slope += found.slope[which]
        return PairErrors(_MICRO * position, _MICRO / self.contact_ratio * slope)

    def smooth_errors(self, draw: ErrorDraw) -> TransmissionError:
        """Return the transmission error (µm) that the tooth errors cause where pairs take over the load gradually."""
        pinion, wheel = (self._drawn(draw, role) for role in Role)
        if pinion is None:
            return TransmissionError()
        return tooth_errors(pinion, wheel, contact_ratio=self.contact_ratio, harmonics=_HARMONICS)


_WITHIN = 16
"""Places within a step, over which a mean is taken where curves jump."""


def repeated_teeth(ratios: Sequence[Fraction], periods: Sequence[int] | None = None) -> int:
    """Return the number of teeth of the first mesh that pass until all meshes repeat.

    `ratios` are the tooth frequencies over that of the first mesh. `periods` are the periods of the meshes in teeth of their
    own, 1 each if not given.
    """
    own = [Fraction(period) / ratio for period, ratio in zip(periods or [1] * len(ratios), ratios, strict=True)]
    common = Fraction(math.lcm(*(each.numerator for each in own)), math.gcd(*(each.denominator for each in own)))
    return int(common)


def single_pattern(springs: Sequence[ToothSpring], ratios: Sequence[Fraction], per_tooth: int) -> Pattern:
    """Return the pattern of single pairs of teeth, in `per_tooth` steps to a tooth of the first mesh."""
    from gearcad.dynamics.tooth_errors.error_kernel import Pattern

    again = repeated_teeth(ratios)
    # One more than there can be at once: a step may hold the end of one and the beginning of the next.
    count, pairs = again * per_tooth, 1 + max(spring.pairs for spring in springs)
    stiffness, gap, place = (np.zeros((count, len(springs), pairs)) for _ in range(3))
    tooth = np.zeros((count, len(springs)), np.int64)
    for j, (spring, ratio) in enumerate(zip(springs, ratios, strict=True)):
        step = float(ratio) / per_tooth
        along = step * np.arange(count) + spring.lead
        first = np.ceil(along - spring.last - step / 2)
        at = (along - first)[:, None] - np.arange(pairs)
        # What of a step lies between the ends of a pair's way, where its spring begins and ends.
        inside = np.minimum(at + step / 2, spring.last) - np.maximum(at - step / 2, spring.first)
        stiffness[:, j] = np.clip(inside / step, 0.0, 1.0) * np.interp(at, spring.places, spring.stiffness)
        gap[:, j], place[:, j], tooth[:, j] = np.interp(at, spring.places, spring.gap), at, first
    teeth = np.array([int(again * ratio) for ratio in ratios])
    return Pattern(stiffness, gap, place, tooth, teeth, np.zeros((count, len(springs))), np.zeros((count, len(springs))))


def smooth_pattern(
    meshes: Sequence[MeshExcitation], stiffness: Floats, senses: Floats, per_tooth: int, frequency: float
) -> Pattern:
    """Return the pattern of meshes as one spring each, of mean `stiffness` (m,) in N/m.

    `senses` (m,) say which flanks the load presses; `per_tooth` is the number of steps to a tooth of the first mesh.
    `frequency` is the tooth frequency of the first mesh (Hz).
    """
    from gearcad.dynamics.tooth_errors.error_kernel import Pattern

    ratios = [mesh.frequency_ratio for mesh in meshes]
    again = repeated_teeth(ratios)
    count = again * per_tooth
    springs, error, rate = np.zeros((count, len(meshes), 1)), np.zeros((count, len(meshes))), np.zeros((count, len(meshes)))
    for j, (mesh, ratio) in enumerate(zip(meshes, ratios, strict=True)):
        step = 2 * math.pi * float(ratio) / per_tooth
        phase = step * np.arange(count) + mesh.lead
        within = phase[:, None] + step * ((np.arange(_WITHIN) + 0.5) / _WITHIN - 0.5)
        springs[:, j, 0] = stiffness[j] * mesh.stiffness.values(within).mean(axis=1)
        if mesh.error is not None and mesh.error.line is not None:
            scale = _MICRO * float(senses[j])
            error[:, j] = scale * mesh.error.line.values(within).mean(axis=1)
            before, behind = (mesh.error.line.values(phase + side * step / 2) for side in (-1, 1))
            rate[:, j] = scale * (behind - before) * frequency * per_tooth
    zeros, teeth = np.zeros_like(springs), np.array([int(again * ratio) for ratio in ratios])
    return Pattern(springs, zeros, zeros, np.zeros((count, len(meshes)), np.int64), teeth, error, rate)


_DEPTH = 12.0
"""Greatest gap that matters, in deflections of a pair of teeth that carries all of the static load."""

_BY_ERRORS = 4.0
"""Part of that gap for errors, in sums of both gears' cumulative pitch and profile slope tolerances."""

_TURNS = 512
"""Number of places over a tooth for means at rest."""

_ROUNDS = 40
"""Rounds of the iteration between the stiffness of a pair and the number of pairs that carry."""

_LONGEST = 10
"""Turns of the pinion after which the same teeth must meet again for the wheel's errors to be drawn as well."""

_LONGEST_TRAIN = 1500
"""Teeth of the first mesh after which all errors of a train must repeat for the wheels' errors to be drawn as well."""


def mesh_teeth(mesh: ToothMesh, number: int, force: float, grade: int | None, *, single: bool) -> MeshTeeth:
    """Return the teeth of a mesh that has only base radii, numbers of teeth and a mean stiffness, under a static force (N).

    They have errors of an accuracy `grade` if one is given; the gears then run at their reference circles with a pressure angle
    of 20 degrees. With `single`, pairs of teeth are springs, equally stiff all along their path. Under the force their mean
    stiffness is then that of the mesh.
    """
    ratio = max(mesh.contact_ratio or CONTACT_RATIO, 1.001)
    teeth = PerGear(mesh.teeth, wheel_teeth(mesh))
    tolerances = None if grade is None else _standard_tolerances(mesh, teeth, grade)
    return MeshTeeth(
        name=mesh.name,
        number=number,
        teeth=teeth,
        contact_ratio=ratio,
        spring=_standard_spring(mesh, ratio, force, tolerances) if single else None,
        tolerances=tolerances,
        given=given_deviations(mesh.pitch_deviations) if mesh.pitch_deviations else None,
    )


def _standard_tolerances(mesh: ToothMesh, teeth: PerGear[int], grade: int) -> PerGear[FlankTolerances]:
    diameters = mesh.base_radii.map(lambda radius: 2 * radius / math.cos(math.radians(PRESSURE_ANGLE)))
    module = diameters.pinion / teeth.pinion
    return diameters.map(lambda diameter: flank_tolerances(grade, diameter, module))


def _standard_spring(mesh: ToothMesh, ratio: float, force: float, tolerances: PerGear[FlankTolerances] | None) -> ToothSpring:
    radii = PerGear(mesh.base_radii.pinion, -mesh.base_radii.wheel if mesh.internal else mesh.base_radii.wheel)
    path = standard_path(radii, mesh.teeth, ratio)
    depth = _depth(force, mesh.stiffness / ratio, tolerances)
    spring = even_spring(path, ratio, mesh.stiffness, depth, _lead(mesh, ratio))
    mean = 1e6 * mesh.stiffness
    for _ in range(_ROUNDS):
        found = at_rest(spring, force, np.arange(_TURNS) / _TURNS).contact_ratio
        spring = replace(spring, stiffness=np.full(len(spring.gap), mean / found))
    return spring


def _depth(force: float, stiffness: float, tolerances: PerGear[FlankTolerances] | None) -> float:
    """Return the gap (µm) beyond which teeth never meet, with a pair stiffness in N/µm and a force in N."""
    errors = 0.0 if tolerances is None else sum(each.cumulative_pitch + each.profile_slope for each in tolerances)
    return _DEPTH * force / stiffness + _BY_ERRORS * errors


def _lead(mesh: ToothMesh, ratio: float) -> float:
    """Return the place of pair 0 at phase 0: where the wave of the mesh has its least value, or begins with one pair more."""
    if mesh.shape is StiffnessWave.SQUARE:
        start = -ratio / 2
    else:
        start = 0.0 if int(ratio) % 2 else 0.5
    return start - mesh.phase


def pair_teeth(
    pair: GearPair,
    cycle: MeshCycle,
    rating: RatingOptions | None,
    *,
    single: bool,
    source: str,
    name: str = "mesh",
    number: int = 0,
    phase: float = 0.0,
    backwards: bool = False,
    pitch_deviations: tuple[float, ...] = (),
) -> MeshTeeth:
    """Return the teeth of a pair as mounted, under the load of its mesh cycle.

    They have errors by the grade of `rating`, if one is given. `phase` delays the teeth, in tooth periods. `backwards`: the
    wheel drives, and teeth go through the mesh from its root to its tip.
    """
    tolerances = (
        None
        if rating is None
        else pair.gears.map(
            lambda gear: flank_tolerances(
                rating.grade_of(gear), abs(gear.reference_diameter), gear.normal_module, rating.accuracy
            )
        )
    )
    spring = None
    path = pair_path(pair)
    if single:
        depth = _depth(cycle.force, cycle.tangent_mean / path.contact_ratio, tolerances)
        spring = cycle_spring(path, cycle, depth, helical=bool(pair.pinion.helix_angle))
        spring = spring.backwards if backwards else spring
        spring = replace(spring, lead=spring.lead - phase)
    return MeshTeeth(
        name=name,
        number=number,
        teeth=pair.gears.map(lambda gear: abs(gear.teeth)),
        contact_ratio=path.contact_ratio if single else max(pair.transverse_contact_ratio, 1.001),
        spring=spring,
        tolerances=tolerances,
        given=given_deviations(pitch_deviations) if pitch_deviations else None,
        source=source,
        helical=bool(pair.pinion.helix_angle),
    )


def engaged_teeth(mesh: EngagedMesh, number: int, *, errors: bool, single: bool) -> MeshTeeth:
    """Return the teeth of a mesh that has a pair, under the load that the train gives it.

    With `errors` they have errors by the grade of the pair's rating.
    """
    of = mesh.teeth_of
    return pair_teeth(
        of.mounted,
        mesh.course.cycle,
        of.rating if errors else None,
        single=single,
        source=mesh.course.title,
        name=mesh.name,
        number=number,
        phase=mesh.phase,
        backwards=mesh.course.driver is Role.WHEEL,
        pitch_deviations=mesh.pitch_deviations,
    )


def with_short_period(teeth: Sequence[MeshTeeth], ratios: Sequence[Fraction]) -> tuple[MeshTeeth, ...]:
    """Return the same teeth without the errors of wheels whose teeth meet the same teeth again only after a long time.

    No wheel has errors where those of the train would still repeat too late.
    """
    kept = tuple(replace(each, wheel_drawn=math.lcm(*each.teeth) <= _LONGEST * each.teeth.pinion) for each in teeth)
    if repeated_teeth(ratios, [each.period for each in kept]) <= _LONGEST_TRAIN:
        return kept
    return tuple(replace(each, wheel_drawn=False) for each in kept)


# ---------------------------------------------------------------------- what is assumed


def assumptions(teeth: Sequence[MeshTeeth], forces: Floats, backlashes: Floats) -> Iterator[Notice]:
    """Yield a notice for each assumption, mesh by mesh.

    `forces` (m,) in N are those at rest; `backlashes` (m,) are nan where flanks never part.
    """
    for each, force, backlash in zip(teeth, forces.tolist(), backlashes.tolist(), strict=True):
        if each.tolerances is not None and not each.wheel_drawn:
            turns = math.lcm(*each.teeth) // each.teeth.pinion
            text = (
                f"errors are those of the pinion's teeth: those of the wheel would come again after {turns} of its turns only"
            )
            yield Notice("wheel-errors-left-out", text, each.name)
        if each.spring is None:
            continue
        yield Notice("single-teeth", _spring_text(each, each.spring, force), each.name)
        if each.helical:
            text = (
                "helical teeth come into mesh by and by: what bent ones touch before their line of contact begins is left out"
            )
            yield Notice("helical-entry", text, each.name)
        if math.isnan(backlash):
            text = "has no backlash: single teeth part all the same, and never meet at the back"
            yield Notice("teeth-part", text, each.name)


def _spring_text(teeth: MeshTeeth, spring: ToothSpring, force: float) -> str:
    rest = at_rest(spring, force, np.arange(_TURNS) / _TURNS)
    stiffness = float(spring.stiffness[np.abs(spring.places) <= spring.contact_ratio / 2].mean()) / 1e6
    under = f"at rest they carry over {rest.contact_ratio:.3g} base pitches, with a mean of {rest.stiffness / 1e6:.4g} N/µm"
    if teeth.source:
        return f"pairs of teeth have the stiffness of {teeth.source}, {stiffness:.4g} N/µm on the mean of their path; {under}"
    entry = (
        f"and carry only there: teeth of {PRESSURE_ANGLE:g}° have no path so long, and what is before it is not known"
        if not spring.gap.any()
        else f"that of teeth of {PRESSURE_ANGLE:g}° that run at their reference circles with equal addenda"
    )
    return (
        f"pairs of teeth are taken to be equally stiff, {stiffness:.4g} N/µm, along a path of {spring.contact_ratio:.4g} base"
        f" pitches, {entry}; {under}"
    )
