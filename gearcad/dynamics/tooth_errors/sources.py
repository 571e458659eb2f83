"""What a train or a pair of gears brings to errors of its teeth: springs of single pairs, tolerances, and what is assumed."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from fractions import Fraction

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.excitation.sources import CONTACT_RATIO, given_deviations, wheel_teeth
from gearcad.dynamics.tooth_errors.paths import (
    PRESSURE_ANGLE,
    cycle_spring,
    even_spring,
    pair_path,
    standard_path,
)
from gearcad.dynamics.tooth_errors.patterns import repeated_teeth
from gearcad.dynamics.tooth_errors.springs import ToothSpring, at_rest
from gearcad.dynamics.tooth_errors.teeth import MeshTeeth
from gearcad.dynamics.trains.engaged_mesh import EngagedMesh
from gearcad.dynamics.trains.members import Mesh, StiffnessWave
from gearcad.geometry import GearPair
from gearcad.mesh_cycle import MeshCycle
from gearcad.notice import Notice
from gearcad.per_gear import PerGear, Role
from gearcad.rating.options import RatingOptions
from gearcad.rating.tolerances.iso1328 import FlankTolerances, flank_tolerances

__all__ = ["assumptions", "engaged_teeth", "mesh_teeth", "pair_teeth", "with_short_period"]

_DEPTH = 12.0
"""Deflections of a pair of teeth that carries all of the static load, up to which gaps matter."""

_BY_ERRORS = 4.0
"""Cumulative pitch tolerances more."""

_TURNS = 512
"""Places over a tooth, for means at rest."""

_ROUNDS = 40
"""Of the stiffness of a pair and how many of them carry, each of which makes the other."""

_LONGEST = 10
"""Turns of the pinion after which the same teeth must meet again for the wheel's errors to be drawn as well."""

_LONGEST_TRAIN = 1500
"""Teeth of the first mesh after which all errors of a train must come again, for the same."""


def mesh_teeth(mesh: Mesh, number: int, force: float, grade: int | None, *, single: bool) -> MeshTeeth:
    """Of a mesh of which a train tells base radii, numbers of teeth and a mean stiffness, under a static force (N).

    With errors of an accuracy `grade` if one is given, of gears that run at their reference circles with a pressure angle of
    20 degrees. `single` pairs of teeth are springs, equally stiff all along their way, so that under the force the mean
    stiffness is that of the mesh.
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


def _standard_tolerances(mesh: Mesh, teeth: PerGear[int], grade: int) -> PerGear[FlankTolerances]:
    diameters = mesh.base_radii.map(lambda radius: 2 * radius / math.cos(math.radians(PRESSURE_ANGLE)))
    module = diameters.pinion / teeth.pinion
    return diameters.map(lambda diameter: flank_tolerances(grade, diameter, module))


def _standard_spring(mesh: Mesh, ratio: float, force: float, tolerances: PerGear[FlankTolerances] | None) -> ToothSpring:
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
    """Gap (µm) beyond which teeth never meet, with a pair stiffness in N/µm."""
    errors = 0.0 if tolerances is None else sum(each.cumulative_pitch + each.profile_slope for each in tolerances)
    return _DEPTH * force / stiffness + _BY_ERRORS * errors


def _lead(mesh: Mesh, ratio: float) -> float:
    """Place of pair 0 at phase 0: where the wave of the mesh has its least, or begins with one pair more."""
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
    """Of a pair as mounted, under the load of its mesh cycle; with errors by a rating's grade if one is given.

    `phase` delays the teeth, in tooth periods; `backwards`: the wheel drives, and teeth go their way from its root to its tip.
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
    """Of a mesh of a pair under what the train gives it; with errors by the grade of the pair's rating, if they are wanted."""
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
    """The same, without the errors of wheels whose teeth meet the same teeth again only after a long time."""
    kept = tuple(replace(each, wheel_drawn=math.lcm(*each.teeth) <= _LONGEST * each.teeth.pinion) for each in teeth)
    if repeated_teeth(ratios, [each.period for each in kept]) <= _LONGEST_TRAIN:
        return kept
    return tuple(replace(each, wheel_drawn=False) for each in kept)


# ---------------------------------------------------------------------- what is assumed


def assumptions(teeth: Sequence[MeshTeeth], forces: Floats, backlashes: Floats) -> Iterator[Notice]:
    """What is taken for granted, mesh by mesh, with forces (m,) at rest and backlashes (m,), nan where flanks never part."""
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
