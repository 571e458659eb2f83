"""The dynamics of a pair of gears by itself: as a mesh of varying stiffness, or as springs between its teeth."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from gearcad.arrays import Floats
from gearcad.dynamics.excitation.sources import pair_errors, pair_excitation, pair_train
from gearcad.dynamics.options import DynamicsOptions
from gearcad.dynamics.study import TrainStudy, study_train
from gearcad.dynamics.tooth_springs.campbell import CampbellStudy, campbell
from gearcad.dynamics.tooth_springs.contact_model import ContactModel
from gearcad.dynamics.tooth_springs.pair_history import TimeHistory, time_history
from gearcad.dynamics.trains.lines import system
from gearcad.dynamics.trains.six_dof import PairOnBearings
from gearcad.dynamics.trains.train import Train
from gearcad.errors import InputError, ParameterError
from gearcad.geometry import GearPair
from gearcad.load import Load
from gearcad.material import Material
from gearcad.mesh_cycle import MeshCycle
from gearcad.notice import Notice, texts
from gearcad.per_gear import PerGear
from gearcad.rating.dynamic_factor import DynamicFactor
from gearcad.rating.options import RatingOptions

__all__ = ["ContactStudy", "PairStudy", "study_contact", "study_pair"]


_HIGHEST = 2.2
"""Spectra go up to so many times the highest tooth frequency, or natural frequency."""

_SPAN = 3.0
"""By default a Campbell study goes up to so many times the speed of the main resonance."""


@dataclass(frozen=True, kw_only=True, eq=False)
class PairStudy:
    """A pair as mounted, its mesh cycle and inertias (kg·m²), and the study of both as a train of one mesh.

    With `bearings` the charts are those of six degrees of freedom; the natural modes are still those of the turning alone.
    `unrated` says why K_v of ISO 6336-1 is missing, "" if it is not.
    """

    pair: GearPair
    cycle: MeshCycle
    inertias: PerGear[float]
    study: TrainStudy
    bearings: PairOnBearings | None
    unrated: str = ""

    def __repr__(self) -> str:
        return f"<PairStudy of {self.pair.name!r}: {self.study!r}>"

    @property
    def name(self) -> str:
        """Of the pair."""
        return self.pair.name

    @property
    def notices(self) -> tuple[Notice, ...]:
        """What to know before trusting it."""
        factor = self.study.method_b
        unrated = Notice("no-standard-factor", f"no K_v of ISO 6336-1: {self.unrated}")
        standard = factor.notices if factor is not None else (unrated,)
        return (*self.study.notices, *self.cycle.notices, *self._full_discs(), *standard)

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    def _full_discs(self) -> Iterator[Notice]:
        """Of gears with a web whose inertia nobody gave."""
        for role, gear in self.pair.gears.items():
            if gear.body.web_thickness and self.study.options.inertias.pick(role) is None:
                own = role.value
                text = f"the {own}'s moment of inertia is that of a full disc, without its web; {own}_inertia gives another"
                yield Notice("full-disc", text)

    def to_dict(self) -> dict[str, Any]:
        """As `dynamics.json` has it."""
        return {
            "model": "mesh",
            "stiffness_method": self.cycle.method,
            "mesh_stiffness_mean": self.cycle.mean,
            "mesh_stiffness_tangent_mean": self.cycle.tangent_mean,
            "pinion_inertia": self.inertias.pinion,
            "wheel_inertia": self.inertias.wheel,
            "frequencies_on_bearings": None if self.bearings is None else list(self.bearings.frequencies()),
            **{key: value for key, value in self.study.to_dict().items() if key != "model"},
            "warnings": list(self.warnings),
            "notices": [notice.to_dict() for notice in self.notices],
        }

    def arrays(self) -> dict[str, Floats]:
        """As the .npz file has them."""
        return self.study.arrays()


@dataclass(frozen=True, kw_only=True, eq=False)
class ContactStudy:
    """A pair as mounted, its contact model, the Campbell study of it and the time history at one speed."""

    pair: GearPair
    model: ContactModel
    study: CampbellStudy
    history: TimeHistory

    def __repr__(self) -> str:
        return f"<ContactStudy of {self.pair.name!r}: {len(self.study.speeds)} speeds up to {self.study.speeds.max():.6g} rpm>"

    @property
    def name(self) -> str:
        """Of the pair."""
        return self.pair.name

    @property
    def notices(self) -> tuple[Notice, ...]:
        """What to know before trusting it."""
        return self.study.notices

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words."""
        return texts(self.notices)

    def to_dict(self) -> dict[str, Any]:
        """As `dynamics.json` has it."""
        model = self.model
        return {
            "model": "contact",
            "tooth_stiffness": model.pair_stiffness,
            "tooth_damping": model.damping,
            "pinion_inertia": model.inertias.pinion,
            "wheel_inertia": model.inertias.wheel,
            "natural_frequency": model.natural_frequency(),
            "damping_ratio": model.damping_ratio,
            "static_approach": model.static_approach,
            "contact_ratio": model.contact_ratio,
            "campbell": self.study.to_dict(),
            "history_speed": self.history.speed,
        }

    def arrays(self) -> dict[str, Floats]:
        """As the .npz file has them."""
        return {
            "speed": self.study.speeds,
            "frequency": self.study.frequency,
            "pinion_speed_amplitude": self.study.pinion_speed,
            "approach_amplitude": self.study.approach,
            "history_time": self.history.time,
            "history_approach": self.history.approach,
            "history_pinion_speed": self.history.pinion_speed,
            "history_wheel_speed": self.history.wheel_speed,
        }


def study_pair(
    pair: GearPair,
    material: Material,
    load: Load,
    cycle: MeshCycle,
    inertias: PerGear[float],
    options: DynamicsOptions | None = None,
    *,
    rating: RatingOptions | None = None,
    masses: PerGear[float] | None = None,
    tell: Callable[[str], None] = lambda _step: None,
) -> PairStudy:
    """K_v over speed of a pair by itself, beside ISO 6336-1 Method B, and the course at the load's speed.

    `cycle` is the pair's mesh cycle under the load, `inertias` (kg·m²) those of pinion and wheel; their `masses` (kg) are
    needed where the options give bearings. The accuracy grade of the options wins over that of the `rating`.
    """
    inertias = PerGear(*inertias)
    options = (options or DynamicsOptions()).graded(rating := rating or RatingOptions())
    assert options.accuracy_grade is not None  # it has one now
    rating = replace(rating, accuracy_grade=options.accuracy_grade)
    train = pair_train(pair, cycle, inertias, torque=cycle.torque, speed=load.speed, damping_ratio=options.damping_ratio)
    errors = pair_errors(pair, rating, options.seed) if options.errors else None
    excitation = pair_excitation(train, cycle, errors)
    factor, unrated = _method_b(pair, material, load, inertias, rating)
    bearings = _on_bearings(train, pair, options, masses)
    of = None if bearings is None else bearings.system()
    study = study_train(train, options, excitation=excitation, method_b=factor, of=of, tell=tell)
    return PairStudy(pair=pair, cycle=cycle, inertias=inertias, study=study, bearings=bearings, unrated=unrated)


def _method_b(
    pair: GearPair, material: Material, load: Load, inertias: PerGear[float], rating: RatingOptions
) -> tuple[DynamicFactor | None, str]:
    """K_v of ISO 6336-1, or None and why the standard has none for this pair."""
    try:
        return DynamicFactor.of(pair, material, load, inertias, rating), ""
    except InputError as error:
        return None, str(error)


def _on_bearings(
    train: Train, pair: GearPair, options: DynamicsOptions, masses: PerGear[float] | None
) -> PairOnBearings | None:
    """The pair's turning gears on the bearings of the options, if these have any."""
    first, second = options.bearing_stiffness
    if first is None or second is None:
        return None
    if masses is None:
        raise ParameterError("masses", None, "must be given for gears on bearings, in kg", "kg")
    of, mesh = system(train), train.meshes[0]
    return PairOnBearings(
        masses=masses,
        inertias=PerGear(*(each.inertia for each in train.inertias)),
        base_radii=mesh.base_radii,
        working_transverse_pressure_angle=pair.working_transverse_pressure_angle,
        mesh_stiffness=mesh.stiffness,
        bearing_stiffness=PerGear((first, first), (second, second)),
        mesh_damping=float(of.mesh_damping[0]),
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
) -> ContactStudy:
    """The Campbell study of a spur pair's contact model, and the time history at the load's speed (or at a middle one).

    `cycle` gives the stiffness of a pair of teeth where the options do not.
    """
    inertias = PerGear(*inertias)
    ratio, torque = pair.usable_contact_ratio, abs(load.torque) * load.application_factor
    stiffness = options.tooth_stiffness
    if stiffness is None:
        assert cycle is not None  # whoever calls has one then
        stiffness = cycle.tangent_mean / ratio
    radii = pair.gears.map(lambda gear: gear.base_diameter / 2)
    mass = 1 / sum((radius / 1000) ** 2 / inertia for radius, inertia in zip(radii, inertias, strict=True))
    damping = options.tooth_damping
    if damping is None:
        damping = 2 * options.damping_ratio * math.sqrt(1e6 * stiffness * ratio * mass)
    model = ContactModel.from_pair(pair, inertias=inertias, pair_stiffness=stiffness, damping=damping, torque=torque)
    resonance = 60 * model.natural_frequency(ratio) / pair.pinion.teeth
    last = options.speed_to or _SPAN * resonance
    speeds = np.linspace(options.speed_from or 0.0, last, options.campbell_speeds)
    tell("campbell")
    top = max(_HIGHEST * resonance * pair.pinion.teeth / 60, _HIGHEST * last * pair.pinion.teeth / 60)
    study = campbell(model, speeds, duration=options.duration, sampling=options.sampling, highest_frequency=top)
    tell("history")
    speed = abs(load.speed) or float(speeds[len(speeds) // 2])
    history = time_history(model, speed, duration=options.duration, sampling=options.sampling)
    return ContactStudy(pair=pair, model=model, study=study, history=history)
