"""Simulate: the dynamics of a pair of gears, or of a train."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Unpack

from gearcad import __version__
from gearcad.check.options import CheckOptions
from gearcad.designs import Design, Inputs, PairDesign, TrainDesign, as_design
from gearcad.designs.design import not_accepted
from gearcad.dynamics.options import DynamicsOptions, PairModel
from gearcad.dynamics.pair_study import ContactStudy, PairStudy, study_contact, study_pair
from gearcad.dynamics.study import ModalStudy, TrainStudy, study_modes, study_train
from gearcad.errors import GeometryError, ParameterError
from gearcad.geometry import GearPair
from gearcad.load import Load
from gearcad.material import Material
from gearcad.mounting import Mounting
from gearcad.per_gear import PerGear, Role
from gearcad.progress import Progress
from gearcad.stiffness.methods import METHODS

__all__ = ["Study", "dynamics_document", "simulate"]

Study = TrainStudy | ModalStudy | PairStudy | ContactStudy

_STEPS = {
    "train": ("modes", "chart", "course"),
    "mesh": ("inertias", "mesh stiffness", "modes", "chart", "course"),
    "contact": ("inertias", "mesh stiffness", "campbell", "history"),
}


def simulate(
    subject: Design | GearPair,
    load: Load | None = None,
    *,
    progress: Progress | None = None,
    **inputs: Unpack[Inputs],
) -> Study:
    """The study of a train, or of a pair as mounted, under a load, with the options of `dynamics`.

    `material`, `mounting`, `check` and `dynamics`, as the load, stand in place of those of a design; a pair has the defaults,
    and a train holds its own.

    Raises ParameterError for a design without pair or load, and what the studies raise.
    """
    from threadpoolctl import threadpool_limits

    with threadpool_limits(1):  # the dense systems are small
        design = as_design(subject, load, **inputs)
        if isinstance(design, TrainDesign):
            return _of_train(design, progress)
        if isinstance(design, PairDesign):
            return _of_pair(design, progress)
        raise not_accepted(type(design), (PairDesign, TrainDesign), "a single gear has no mesh")


def _of_train(design: TrainDesign, progress: Progress | None) -> TrainStudy | ModalStudy:
    if not design.train.meshes:
        return study_modes(design.train, design.dynamics)
    return study_train(design.train, design.dynamics, tell=_teller(progress, "train"))


def _of_pair(design: PairDesign, progress: Progress | None) -> PairStudy | ContactStudy:
    if design.load is None or not design.load.torque:
        given = None if design.load is None else design.load.torque
        raise ParameterError("load.torque", given, "must be given, in N·m on the pinion: flanks without load rattle")
    options = design.dynamics or DynamicsOptions()
    tell = _teller(progress, options.model)
    mounting, material = design.mounting or Mounting(), design.material or Material()
    pair = mounting.mounted(design.pair)
    if options.pair_model is PairModel.CONTACT and pair.pinion.helix_angle:
        permitted = 'must be 0 for model "contact": its pairs of teeth touch over their whole width at once'
        raise GeometryError("pair.helix_angle", pair.pinion.helix_angle, permitted, "deg")
    tell("inertias")
    inertias = _inertias(pair, material, options)
    tell("mesh stiffness")
    cycle = None
    if options.pair_model is PairModel.MESH or options.tooth_stiffness is None:
        body = (design.check or CheckOptions()).body
        method = METHODS[options.method_for(pair)](pair=design.pair, material=material, body=body, mounting=mounting)
        cycle = method(design.load)
    if options.pair_model is PairModel.CONTACT:
        return study_contact(pair, design.load, cycle, inertias, options, tell=tell)
    assert cycle is not None  # made above
    masses = _masses(pair, material) if options.pinion_bearing_stiffness is not None else None
    return study_pair(pair, material, design.load, cycle, inertias, options, rating=design.rating, masses=masses, tell=tell)


def _inertias(pair: GearPair, material: Material, options: DynamicsOptions) -> PerGear[float]:
    """Of pinion and wheel (kg·m²): as given, or those of their own solids."""

    def inertia(role: Role) -> float:
        if (given := options.inertias.pick(role)) is not None:
            return given
        from gearcad.solids.exact.inertia import mass_properties

        return mass_properties(pair.gears.pick(role), material.density).inertia

    return PerGear.each(inertia)


def _masses(pair: GearPair, material: Material) -> PerGear[float]:
    """Of pinion and wheel (kg), as solids."""
    from gearcad.solids.exact.inertia import mass_properties

    return pair.gears.map(lambda gear: mass_properties(gear, material.density).mass)


def _teller(progress: Progress | None, kind: str) -> Callable[[str], None]:
    steps = _STEPS[kind]
    return lambda step: progress(step, steps.index(step), len(steps)) if progress is not None else None


def dynamics_document(study: Study, name: str) -> dict[str, Any]:
    """Everything but the long arrays under the names of dynamics.json."""
    return {"kind": "dynamics", "name": name, "gearcad": __version__, **study.to_dict()}
