"""What a train or a pair of gears brings to its dynamics: the excitation of its meshes, and a pair as a train."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction

import numpy as np

from gearcad.dynamics.excitation.deviations import (
    ErrorDistribution,
    ToothDeviations,
    TransmissionError,
    random_deviations,
    tooth_errors,
)
from gearcad.dynamics.excitation.mesh_curves import CosineStiffness, StiffnessShape, square_stiffness
from gearcad.dynamics.excitation.meshes import Excitation, MeshExcitation, cycle_excitation
from gearcad.dynamics.trains.engaged_mesh import EngagedMesh, require_known
from gearcad.dynamics.trains.graph import turning_pieces
from gearcad.dynamics.trains.members import Inertia, Mesh, StiffnessWave
from gearcad.dynamics.trains.mesh_pair import line_backlash
from gearcad.dynamics.trains.train import Train, TrainModel
from gearcad.errors import GeometryError
from gearcad.geometry import GearPair
from gearcad.mesh_cycle import MeshCycle
from gearcad.per_gear import PerGear
from gearcad.rating.options import RatingOptions
from gearcad.rating.tolerances.iso1328 import flank_tolerances

__all__ = [
    "CONTACT_RATIO",
    "given_deviations",
    "pair_errors",
    "pair_excitation",
    "pair_train",
    "train_excitation",
    "wheel_teeth",
]

_PRESSURE_ANGLE = 20.0
"""Of gears of which a train tells only base radii and teeth (deg)."""

CONTACT_RATIO = 1.6
"""Of such gears, where no square wave tells it."""

_HARMONICS = 12
"""Of the tooth frequency, in the errors of teeth: they fall with the square, to thousandths of a step of one tooth."""


def train_excitation(
    train: Train,
    *,
    grade: int | None = None,
    seed: int = 0,
    distribution: ErrorDistribution = ErrorDistribution.UNIFORM,
) -> Excitation:
    """Stiffness waves, backlashes and pitch deviations of a train's meshes; random ones of an ISO 1328 `grade`, if given.

    A mesh of a pair has the course of its teeth, and their rating's grade in place of `grade`. The deviations are those of the
    pinions' teeth, drawn with `seed` where a mesh has none given: with the wheels' the period would be that of both.
    """
    ratios = _tooth_ratios(train)
    meshes = []
    for number, (mesh, ratio) in enumerate(zip(train.meshes, ratios, strict=True)):
        require_known(mesh)
        if isinstance(mesh, EngagedMesh):
            errors = _errors_of_pair(mesh, seed + number, distribution) if mesh.pitch_deviations or grade is not None else None
            meshes.append(replace(_course_of_pair(mesh, errors), frequency_ratio=ratio))
            continue
        error = _mesh_errors(mesh, grade, seed + number, distribution) if mesh.pitch_deviations or grade is not None else None
        meshes.append(
            MeshExcitation(
                stiffness=_wave(mesh), phase=-360 * mesh.phase, frequency_ratio=ratio, error=error, backlash=mesh.backlash
            )
        )
    return Excitation(meshes=tuple(meshes))


def _course_of_pair(mesh: EngagedMesh, errors: TransmissionError | None) -> MeshExcitation:
    """Stiffness and transmission error of the pair's cycle, in the order of time, with the errors of its teeth."""
    found = cycle_excitation(mesh.course.in_time, phase=-360 * mesh.phase, backlash=mesh.backlash)
    assert found.error is not None and found.error.line is not None  # a cycle has one
    line = replace(found.error.line, height=found.error.line.height - mesh.course.offset)
    return replace(found, error=replace(errors or TransmissionError(), line=line))


def _errors_of_pair(mesh: EngagedMesh, seed: int, distribution: ErrorDistribution) -> TransmissionError:
    """Of the pinion's teeth: as given, or random ones of the pair's accuracy grade."""
    pair = mesh.teeth_of.mounted
    if mesh.pitch_deviations:
        return _given_errors(mesh.pitch_deviations, max(pair.transverse_contact_ratio, 1.001))
    return pair_errors(pair, mesh.teeth_of.rating, seed, distribution)


def _given_errors(deviations: tuple[float, ...], contact_ratio: float) -> TransmissionError:
    """Of pitch deviations (µm)."""
    return tooth_errors(given_deviations(deviations), contact_ratio=contact_ratio, harmonics=_HARMONICS)


def _wave(mesh: Mesh) -> StiffnessShape:
    if mesh.shape is StiffnessWave.COSINE:
        return CosineStiffness(variation=mesh.variation)
    assert mesh.contact_ratio is not None  # a square wave has one
    return square_stiffness(mesh.contact_ratio)


def _mesh_errors(mesh: Mesh, grade: int | None, seed: int, distribution: ErrorDistribution) -> TransmissionError:
    """Of the pinion's teeth: as given, or random ones of a gear taken to have a pressure angle of 20 degrees."""
    if mesh.pitch_deviations:
        return _given_errors(mesh.pitch_deviations, mesh.contact_ratio or CONTACT_RATIO)
    assert grade is not None  # one of the two is there
    diameter = 2 * mesh.base_radii.pinion / math.cos(math.radians(_PRESSURE_ANGLE))
    tolerances = flank_tolerances(grade, diameter, diameter / mesh.teeth)
    ratio = mesh.contact_ratio or CONTACT_RATIO
    drawn = random_deviations(mesh.teeth, tolerances, seed, distribution=distribution)
    return tooth_errors(drawn, contact_ratio=ratio, harmonics=_HARMONICS)


def given_deviations(pitch_deviations: Sequence[float]) -> ToothDeviations:
    """Of pitch deviations f_pt (µm); what would be left after a turn would be none of them."""
    pitches = np.array(pitch_deviations)
    return ToothDeviations(position=-np.cumsum(pitches - pitches.mean()))


def _tooth_ratios(train: Train) -> list[Fraction]:
    """Tooth frequency of every mesh over that of the first, by whole numbers of teeth: z3/z2 for a second stage."""
    whole = [wheel_teeth(mesh) for mesh in train.meshes]
    exact = [
        Mesh(
            name=mesh.name,
            pinion=mesh.pinion,
            wheel=mesh.wheel,
            base_radii=PerGear(float(mesh.teeth), float(wheel)),
            stiffness=float(mesh.stiffness),
            teeth=int(mesh.teeth),
            internal=mesh.internal,
        )
        for mesh, wheel in zip(train.meshes, whole, strict=True)
    ]
    (speeds,) = turning_pieces([inertia.name for inertia in train.inertias], train.shafts, exact)
    most = math.prod(mesh.teeth * wheel for mesh, wheel in zip(train.meshes, whole, strict=True))
    first = speeds[train.meshes[0].pinion]
    return [
        Fraction(abs(speeds[mesh.pinion] / first)).limit_denominator(most) * Fraction(mesh.teeth, train.meshes[0].teeth)
        for mesh in train.meshes
    ]


def wheel_teeth(mesh: Mesh) -> int:
    """z_2 = z_1 r_b2/r_b1. Raises GeometryError where that is far from a whole number."""
    teeth = mesh.teeth * mesh.base_radii.wheel / mesh.base_radii.pinion
    if abs(teeth - round(teeth)) > 0.2 or round(teeth) < 1:
        permitted = f"must be in the ratio of whole numbers of teeth: with {mesh.teeth} of the pinion the wheel has {teeth:.3f}"
        raise GeometryError(f"{mesh.name}.base_radii", mesh.base_radii.wheel, permitted, "mm")
    return round(teeth)


def pair_train(
    pair: GearPair, cycle: MeshCycle, inertias: PerGear[float], *, torque: float, speed: float, damping_ratio: float
) -> Train:
    """A pair by itself: its inertias (kg·m²), the mean tangent stiffness of its cycle, its backlash, a torque (N·m) on it.

    A ring turns with its pinion, so the torque on it is negative.
    """
    radii = pair.gears.map(lambda gear: gear.base_diameter / 2)
    return Train(
        name=pair.name,
        model=TrainModel.ISOLATED,
        inertias=tuple(Inertia(name=role.value, inertia=each) for role, each in inertias.items()),
        meshes=(
            Mesh(
                name="mesh",
                pinion="pinion",
                wheel="wheel",
                base_radii=radii.map(abs),
                stiffness=cycle.tangent_mean,
                teeth=pair.pinion.teeth,
                damping_ratio=damping_ratio,
                backlash=line_backlash(pair),
                internal=pair.internal,
            ),
        ),
        torques={"pinion": abs(torque), "wheel": abs(torque) * radii.wheel / radii.pinion},
        speed=abs(speed),
    )


def pair_excitation(train: Train, cycle: MeshCycle, errors: TransmissionError | None = None) -> Excitation:
    """The course of a pair's stiffness and transmission error, with the errors of its teeth."""
    mesh = cycle_excitation(cycle, backlash=train.meshes[0].backlash)
    if errors is not None:
        assert mesh.error is not None  # a cycle has one
        mesh = replace(mesh, error=replace(errors, line=mesh.error.line))
    return Excitation(meshes=(mesh,))


def pair_errors(
    pair: GearPair, rating: RatingOptions, seed: int, distribution: ErrorDistribution = ErrorDistribution.UNIFORM
) -> TransmissionError:
    """Random pitch deviations of the rating's accuracy grade on the pinion's teeth, drawn with `seed`."""
    gear = pair.pinion
    tolerances = flank_tolerances(rating.grade_of(gear), gear.reference_diameter, gear.normal_module, rating.accuracy)
    deviations = random_deviations(gear.teeth, tolerances, seed, distribution=distribution)
    return tooth_errors(deviations, contact_ratio=max(pair.transverse_contact_ratio, 1.001), harmonics=_HARMONICS)
