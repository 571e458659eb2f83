"""The rating of many variants at once: safeties, masses and temperatures, where the scalar rating would have them."""

from __future__ import annotations

from typing import Any

import numpy as np

from gearcad.arrays import Bools, Floats, Indices, Wholes
from gearcad.per_gear import PerGear
from gearcad.rating.both import both
from gearcad.rating.iso6336_1 import material_factor, pair_modulus
from gearcad.rating.iso6336_2 import elasticity_of
from gearcad.rating.scuffing.heat import mating_factor, thermo_elastic_factor
from gearcad.rating.scuffing.integral import IntegralTemperature
from gearcad.rating.scuffing.oil import LUBRICATION, Oil
from gearcad.rating.scuffing.scuffing import RZ_OVER_RA, USUAL_ROUGHNESS
from gearcad.rating.scuffing.sliding import SlidingMesh
from gearcad.sizing.geometry import ManyPairs
from gearcad.sizing.loads import ManyLoadFactors
from gearcad.sizing.rated import Rated, disc_mass
from gearcad.sizing.resistance import Strengths
from gearcad.sizing.stresses import NominalStresses
from gearcad.sizing.task import SizeTask

__all__ = ["RATED", "nominal_of", "rate_many"]

RATED = "range of the rating"
"""Words of what a variant is removed by that has no rating: deviations, root section or single contact out of all range."""


def nominal_of(task: SizeTask, pairs: ManyPairs, width: Floats) -> NominalStresses:
    """Stresses without load factors, of pairs whose shape is that of the widths or goes with it."""
    return NominalStresses(
        pairs=pairs,
        width=width,
        torque=task.load.torque,
        outer_factor=task.load.application_factor * task.rating.mesh_load_factor,
        elasticity_factor=elasticity_of(task.materials),
        material_factor=material_factor(pair_modulus(task.materials)),
        edition=task.rating.standard,
        accuracy_grade=task.rating.accuracy_grade,
    )


def rate_many(task: SizeTask, pairs: ManyPairs, width: Floats, wanted: Bools, order: Wholes) -> Rated:
    """Rate n pairs with w face widths (mm) each, (n, w), where they are `wanted`; those that have a rating, in one row.

    What does not depend on the width is worked out once for each pair.
    """
    with np.errstate(invalid="ignore", divide="ignore"):  # what has no rating is nan, and left out
        return _rated(task, pairs, width, wanted, order)


def _rated(task: SizeTask, pairs: ManyPairs, width: Floats, wanted: Bools, order: Wholes) -> Rated:
    column = pairs.picked((slice(None), None))
    nominal = nominal_of(task, column, width)
    loads = ManyLoadFactors(task, nominal)
    strengths = Strengths(task, column, nominal.roots)
    common = nominal.nominal_contact_stress * np.sqrt(loads.flank)
    parts = zip(strengths.flanks, nominal.contact_factors, strict=True)
    flanks = PerGear(*(strength / (factor * common) for strength, factor in parts))
    parts = zip(strengths.roots, nominal.nominal_root_stresses, strict=True)
    roots = PerGear(*(strength / (stress * loads.root) for strength, stress in parts))
    least = task.rating
    margin = np.minimum(np.minimum(*flanks) / least.required_safety_flank, np.minimum(*roots) / least.required_safety_root)
    rows, columns = np.nonzero(wanted & loads.known & np.isfinite(margin))
    return Rated(
        order=order[rows, columns],
        pairs=pairs.picked(rows),
        **{
            name: _flat(values, width.shape, rows, columns)
            for name, values in {
                "width": width,
                "mass": disc_mass(column, width, PerGear(*(each.density for each in task.materials))),
                "overlap_ratio": nominal.overlap_ratio,
                "flank_safeties": flanks,
                "root_safeties": roots,
                "margin": margin,
                "temperature": _temperature(task, nominal, loads),
                "load_factors": loads.flank,
            }.items()
        },
    )


def _flat(values: Floats | PerGear[Floats], shape: tuple[int, ...], rows: Indices, columns: Indices) -> Any:
    """Those of the wanted variants, one after another."""
    if isinstance(values, PerGear):
        return PerGear(*(_flat(each, shape, rows, columns) for each in values))
    return np.broadcast_to(values, shape)[rows, columns]


def _temperature(task: SizeTask, nominal: NominalStresses, loads: ManyLoadFactors) -> Floats:
    """Integral temperature (°C) without tip relief; nan without a speed."""
    pairs, options = nominal.pairs, task.rating
    if task.load.speed == 0:
        return np.full(nominal.width.shape, np.nan)
    middle = pairs.base_diameters.pinion / 2 * np.tan(pairs.working_angle)
    oil, degrees = Oil.of(options), np.degrees
    temperature = IntegralTemperature(
        mesh=SlidingMesh(
            gear_ratio=pairs.ratio,
            centre_distance=pairs.centre_distance,
            normal_pressure_angle=pairs.rack.pressure_angle,
            helix_angle=np.abs(pairs.helix_angle),
            transverse_pressure_angle=degrees(pairs.transverse_angle),
            working_pressure_angle=degrees(pairs.working_angle),
            base_helix_angle=degrees(pairs.base_helix),
            wheel_part=(middle - pairs.lowest_contact.pinion) / pairs.base_pitch,
            pinion_part=(pairs.tip_reach.pinion - middle) / pairs.base_pitch,
            tip_curvature=pairs.tip_reach.pinion,
            total_contact_ratio=loads.total_contact_ratio,
        ),
        specific_load=nominal.tangential_force * loads.flank / nominal.width,
        speed=loads.speed,
        roughness=USUAL_ROUGHNESS / RZ_OVER_RA,
        viscosity=oil.dynamic_viscosity,
        lubricant=oil.lubricant_factor,
        thermo_elastic=thermo_elastic_factor(task.materials),
        lubrication=LUBRICATION[options.oil_supply],
        mating=mating_factor(max(both(options.contacts_per_turn))),
        oil_temperature=oil.temperature,
    )
    return np.asarray(temperature.value)
