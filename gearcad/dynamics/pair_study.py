"""Study of a pair of gears: as a mesh of varying stiffness, or as springs between single teeth."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from gearcad.core.errors import InputError, ParameterError
from gearcad.core.records import PerGear, Role
from gearcad.core.runtime import Share, Tell, unheard, untold
from gearcad.dynamics.options import DynamicsOptions, idle_in_contact
from gearcad.dynamics.pair_result import ContactStudy, PairStudy
from gearcad.dynamics.time_domain.campbell import campbell
from gearcad.dynamics.time_domain.contact_model import ContactModel, EngagedPairs
from gearcad.dynamics.time_domain.time_history import time_history
from gearcad.dynamics.tooth_errors.error_sources import MeshTeeth, pair_teeth
from gearcad.dynamics.train_study import study_train
from gearcad.dynamics.trains.mesh_excitation import pair_errors, pair_excitation, pair_train
from gearcad.dynamics.trains.pair_on_bearings import PairOnBearings
from gearcad.dynamics.trains.shaft_lines import system
from gearcad.dynamics.trains.tooth_deviations import TransmissionError
from gearcad.dynamics.trains.train import Train
from gearcad.geometry import Gear, GearPair, RackPair
from gearcad.load import Load
from gearcad.material import Materials
from gearcad.mesh_cycle import MeshCycle
from gearcad.rating.dynamic_factor import DynamicFactor
from gearcad.rating.options import RatingOptions

_HIGHEST = 2.2
"""Highest frequency of the spectra over the highest tooth frequency or natural frequency."""

_SPAN = 3.0
"""Highest speed of a Campbell study over the speed of the main resonance, by default."""


def study_pair(
    pair: GearPair | RackPair,
    material: Materials,
    load: Load,
    cycle: MeshCycle,
    inertias: PerGear[float],
    options: DynamicsOptions | None = None,
    *,
    rating: RatingOptions | None = None,
    masses: PerGear[float] | None = None,
    tell: Tell = untold,
    share: Share = unheard,
    drawn: Share = unheard,
) -> PairStudy:
    """Return the study of a pair by itself: K_v over speed, beside ISO 6336-1 Method B, and the course at the load's speed.

    `cycle` is the pair's mesh cycle under the load, `inertias` (kg·m²) those of pinion and wheel; their `masses` (kg) are
    needed where the options give bearings. The accuracy grade of the options wins over that of the `rating`. If the torque of
    the load is against its speed, the wheel drives: contact then moves from tip to root of the pinion, as in a train. The
    inertia of a rack is its mass times the square of the pinion's reference radius; springs between single teeth, and
    bearings, are of gears only.
    """
    require_rack_options(pair, options or DynamicsOptions())
    inertias = PerGear(*inertias)
    options = (options or DynamicsOptions()).graded(rating := rating or RatingOptions())
    assert options.accuracy_grade is not None  # it has one now
    rating = replace(rating, accuracy_grade=options.accuracy_grade)
    options = replace(options, accuracy_grade=max(map(rating.grade_of, _gears(pair))))  # a gear's own counts before it
    train = pair_train(pair, cycle, inertias, torque=cycle.torque, speed=load.speed, damping_ratio=options.damping_ratio)
    driver = Role.WHEEL if load.torque * load.speed < 0 else Role.PINION
    in_time = cycle if driver is Role.PINION else cycle.backwards
    excitation = pair_excitation(train, in_time, _smooth_errors(pair, rating, options))
    if isinstance(pair, RackPair):
        teeth, bearings = None, None
        factor, unrated = None, "the standard has no method for a rack"
    else:
        teeth = _single_teeth(pair, cycle, rating, options, driver) if options.drawn else None
        factor, unrated = _method_b(pair, material, load, inertias, rating)
        bearings = _on_bearings(train, pair, options, masses)
    study = study_train(
        train,
        options,
        excitation=excitation,
        method_b=factor,
        bearings=bearings,
        teeth=teeth,
        tell=tell,
        share=share,
        drawn=drawn,
    )
    return PairStudy(
        pair=pair,
        cycle=cycle,
        inertias=inertias,
        method=_title(cycle),
        study=study,
        bearings=bearings,
        unrated=unrated,
        driver=driver,
    )


def _gears(pair: GearPair | RackPair) -> tuple[Gear, ...]:
    """Return both gears, or the pinion of a rack."""
    return (pair.pinion,) if isinstance(pair, RackPair) else tuple(pair.gears)


def require_rack_options(pair: GearPair | RackPair, options: DynamicsOptions) -> None:
    """Raise ParameterError for a rack where the options ask for what only gears have."""
    if not isinstance(pair, RackPair):
        return
    if options.drawn:
        permitted = "must be 1 for a rack, and premature_engagement off: springs between single teeth are of gears only"
        raise ParameterError("dynamics.error_samples", options.error_samples, permitted)
    if (stiffness := options.bearing_stiffness.pinion) is not None:
        permitted = "must be left out for a rack: gears that travel on bearings are pairs of gears"
        raise ParameterError("dynamics.pinion_bearing_stiffness", stiffness, permitted, "N/µm")


def _smooth_errors(pair: GearPair | RackPair, rating: RatingOptions, options: DynamicsOptions) -> TransmissionError | None:
    """Return the tooth errors of one chart; None if there are none or they are drawn in a study of their own."""
    if not options.errors or options.drawn:
        return None
    return pair_errors(pair, rating, options.seed, options.distribution)


def _single_teeth(
    pair: GearPair, cycle: MeshCycle, rating: RatingOptions, options: DynamicsOptions, driver: Role
) -> tuple[MeshTeeth, ...]:
    """Return the teeth of the only mesh, for errors that are drawn."""
    errors, backwards = rating if options.errors else None, driver is Role.WHEEL
    return (pair_teeth(pair, cycle, errors, single=options.premature, source=_title(cycle), backwards=backwards),)


def _title(cycle: MeshCycle) -> str:
    """Return the title of the stiffness method that found the mesh cycle."""
    from gearcad.stiffness.methods import METHODS  # only here: trains without pairs do not need them

    return METHODS[cycle.method].title


def _method_b(
    pair: GearPair, material: Materials, load: Load, inertias: PerGear[float], rating: RatingOptions
) -> tuple[DynamicFactor | None, str]:
    """Return K_v of ISO 6336-1, or None and why the standard has none for this pair."""
    try:
        return DynamicFactor.of(pair, material, load, inertias, rating), ""
    except InputError as error:
        return None, str(error)


def _on_bearings(
    train: Train, pair: GearPair, options: DynamicsOptions, masses: PerGear[float] | None
) -> PairOnBearings | None:
    """Return the pair's turning gears on the bearings of the options; None if the options have no bearings."""
    first, second = options.bearing_stiffness
    if first is None or second is None:
        return None
    if masses is None:
        raise ParameterError("masses", None, "must be given for gears on bearings, in kg", "kg")
    mesh = train.meshes[0]
    return PairOnBearings(
        masses=masses,
        inertias=PerGear(*(each.inertia for each in train.inertias)),
        base_radii=pair.gears.map(lambda gear: gear.base_diameter / 2),
        working_transverse_pressure_angle=pair.working_transverse_pressure_angle,
        mesh_stiffness=mesh.stiffness,
        bearing_stiffness=PerGear((first, first), (second, second)),
        mesh_damping=float(system(train).mesh_damping[0]),
        bearing_damping=options.bearing_damping,
        torque=train.torques["pinion"],
    )


def study_contact(
    pair: GearPair,
    load: Load,
    cycle: MeshCycle | None,
    inertias: PerGear[float],
    options: DynamicsOptions,
    *,
    tell: Callable[[str], None] = lambda _step: None,
    counted: Callable[[int, int], None] = lambda _done, _count: None,
) -> ContactStudy:
    """Return the Campbell study of a spur pair's contact model, and the time history at the load's speed, or at a middle speed.

    `cycle` gives the stiffness of a pair of teeth where the options do not.
    """
    inertias = PerGear(*inertias)
    one_pair, torque = options.engaged_pairs is EngagedPairs.ONE_PAIR, abs(load.torque) * load.application_factor
    ratio = 1.0 if one_pair else pair.usable_contact_ratio
    stiffness = options.tooth_stiffness
    if stiffness is None:
        assert cycle is not None  # whoever calls has one then
        stiffness = cycle.tangent_mean / ratio
    radii = pair.gears.map(lambda gear: gear.base_diameter / 2)
    mass = 1 / sum((radius / 1000) ** 2 / inertia for radius, inertia in zip(radii, inertias, strict=True))
    damping = options.tooth_damping
    if damping is None:
        damping = 2 * options.damping_ratio * math.sqrt(1e6 * stiffness * ratio * mass)
    model = ContactModel.from_pair(
        pair,
        inertias=inertias,
        pair_stiffness=stiffness,
        damping=damping,
        torque=torque,
        zone=options.engaged_pairs,
    )
    resonance = 60 * model.natural_frequency(ratio) / pair.pinion.teeth
    last = options.speed_to or _SPAN * resonance
    speeds = np.linspace(options.speed_from or 0.0, last, options.campbell_speeds)
    tell("campbell")
    top = max(_HIGHEST * resonance * pair.pinion.teeth / 60, _HIGHEST * last * pair.pinion.teeth / 60)
    study = campbell(
        model, speeds, duration=options.duration, sampling=options.sampling, highest_frequency=top, counted=counted
    )
    tell("history")
    speed = abs(load.speed) or float(speeds[len(speeds) // 2])
    history = time_history(model, speed, duration=options.duration, sampling=options.sampling)
    return ContactStudy(pair=pair, model=model, study=study, history=history, idle=idle_in_contact(options))
