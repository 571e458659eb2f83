"""rate_strength: the full rating of a pair by ISO 6336 or DIN 3990."""

from __future__ import annotations

from dataclasses import replace

from gearcad.errors import InputError, ParameterError
from gearcad.geometry import GearPair, RackPair
from gearcad.load import Load
from gearcad.material import Material, of_both
from gearcad.per_gear import PerGear, Role
from gearcad.rating.load_factors import BodyLoad
from gearcad.rating.options import RatingOptions
from gearcad.rating.strength.part import Part
from gearcad.rating.strength.rating import StrengthRating
from gearcad.rating.strength.task import StrengthTask
from gearcad.rating.strength.told import assumed_of, notices_of, verify_of

__all__ = ["rate_strength"]


def rate_strength(
    pair: GearPair | RackPair,
    materials: Material | PerGear[Material],
    load: Load,
    options: RatingOptions | None = None,
    *,
    body_load: BodyLoad | None = None,
    driver: Role = Role.PINION,
) -> StrengthRating:
    """Rate a pair, of one material or each gear of its own: safeties of flanks and roots, life, permissible torque, scuffing.

    `body_load` stands in place of the options' face_load_factor "fe": K_Hbeta of a load distribution. `driver` is the gear
    that drives, for scuffing. What the standard does not cover, or what is not known, is not judged, each for its reason.
    Raises ParameterError without a torque, for a spectrum beside an application factor, and for a hardness that its material
    has no limit of; GeometryError for a pair whose contact the standard does not describe.
    """
    options = options or RatingOptions()
    if options.bins and load.application_factor != 1:
        permitted = "must be 1 with a load spectrum, which has all loads in it (ISO 6336-6)"
        raise ParameterError("load.application_factor", load.application_factor, permitted)
    if body_load is not None:
        options = replace(options, face_load_factor=body_load.factor)
    both = of_both(materials)
    return _rating(StrengthTask(pair=pair, materials=both, load=load, options=options, driver=driver, body_load=body_load))


def _rating(task: StrengthTask) -> StrengthRating:
    """All of it."""
    parts = {part: PerGear(*(task.part(part, role) for role in Role)) for part in Part}
    factors = None if isinstance(task.load_factors, InputError) else task.load_factors
    return StrengthRating(
        pair=task.pair,
        materials=task.materials,
        load=task.load,
        options=task.options,
        nominal=task.nominal,
        limits=task.limits,
        load_factors=factors,
        cases=() if factors is None else task.duty.cases(),
        governing=None if factors is None else task.duty.governing,
        flank=parts[Part.FLANK],
        root=parts[Part.ROOT],
        scuffing=task.scuffing,
        tolerances=task.tolerances,
        assumed=tuple(dict.fromkeys(assumed_of(task))),
        verify=tuple(dict.fromkeys(verify_of(task))),
        notices=tuple(dict.fromkeys(notices_of(task, parts))),
    )
