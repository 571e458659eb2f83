"""K_v of a pair: by Method B or C of ISO 6336-1, or as given."""

from __future__ import annotations

from collections.abc import Iterator

from gearcad.notice import Notice
from gearcad.rating.dynamic_factor import DynamicFactor
from gearcad.rating.load_factors.below_resonance import STATED, dynamic_factor_c, speed_measure, speed_measure_limit
from gearcad.rating.load_factors.finding import GIVEN, Finding
from gearcad.rating.load_factors.loaded_mesh import LoadedMesh
from gearcad.rating.load_factors.masses import inner_diameter, mass_of, pair_mass
from gearcad.rating.resonance import lower_limit
from gearcad.rating.tolerances import Accuracy

__all__ = ["dynamic_factor"]

_MAIN_END = 1.15

_NO_SPEED = Notice("no-speed", "K_v: the speed is 0 rpm, so K_v is not known; 1 stands in its place in all factors after it")
_MEMORY_GRADE = 12
"""The grade whose K_1 is from memory."""


def dynamic_factor(mesh: LoadedMesh) -> Finding:
    """K_v by the method of the options. Raises ParameterError for a grade that Method C or the tolerances do not cover."""
    method = mesh.options.dynamic_factor
    if not isinstance(method, str):
        return Finding(factors={"K_v": method}, sources={"K_v": GIVEN})
    if not mesh.speed:
        return Finding(factors={"K_v": 1.0}, sources={}, unknown=("K_v",), notices=(_NO_SPEED,))
    return _method_b(mesh) if method == "B" else _method_c(mesh)


def _method_b(mesh: LoadedMesh) -> Finding:
    """By the resonance ratio, with the masses of both bodies."""
    masses = [mass_of(gear, material.density) for gear, material in zip(mesh.pair.gears, mesh.materials, strict=True)]
    mass = pair_mass(*masses)
    found = DynamicFactor.at(mesh.pair, mesh.materials, mesh.specific_load, mesh.stiffness, mass, mesh.options)
    speed = abs(mesh.load.speed)
    ratio, (b_p, b_f, b_k), (y_p, y_f) = speed / found.resonance_speed, found.effects(speed), found.allowances(speed)
    details = {
        "m_red": mass,
        "n_E1": found.resonance_speed,
        "N": ratio,
        "N_S": lower_limit(mesh.specific_load),
        "f_pb": found.pitch_deviation,
        "f_falpha": found.profile_deviation,
        "y_p": float(y_p),
        "y_f": float(y_f),
        "C_a": found.tip_relief,
        "B_p": float(b_p),
        "B_f": float(b_f),
        "B_k": b_k,
    }
    return Finding(
        factors={"K_v": float(found.values(speed))},
        sources={"K_v": mesh.cited("6.5", "Method B")},
        details=details,
        notices=(*found.notices, *_resonance_notices(details["N_S"], ratio)),
        assumed=tuple(_assumed_masses(mesh)),
    )


def _resonance_notices(lower: float, ratio: float) -> Iterator[Notice]:
    if lower < ratio <= _MAIN_END:
        text = f"the pair runs in its main resonance, N = {ratio:.3g}: K_v is uncertain there, and such speeds are best avoided"
        yield Notice("main-resonance", f"K_v: {text}")


def _assumed_masses(mesh: LoadedMesh) -> Iterator[str]:
    """Of which bodies m_red is."""
    yield "K_v: m_red of plain discs or rims of the gears' own material, without hubs, shafts and what else turns with them"
    if mesh.pair.internal and inner_diameter(mesh.pair.wheel) is None:
        yield "K_v: the ring is held, as its rim is not given: m_red is that of the pinion"


def _method_c(mesh: LoadedMesh) -> Finding:
    """By speed and grade alone."""
    pair, edition = mesh.pair, mesh.options.standard
    measure = speed_measure(mesh.speed, float(pair.pinion.teeth), pair.gear_ratio)
    factor = dynamic_factor_c(mesh.specific_load, measure, pair.overlap_ratio, mesh.grade, edition)
    return Finding(
        factors={"K_v": factor},
        sources={"K_v": mesh.cited("6.6", "Method C")},
        details={"v_z1_100": measure},
        notices=tuple(_notices_of_c(mesh, measure)),
        verify=("K_v",) if mesh.grade == _MEMORY_GRADE or measure > STATED else (),
    )


def _notices_of_c(mesh: LoadedMesh, measure: float) -> Iterator[Notice]:
    """Where the pair leaves what Method C is stated for."""
    limit = speed_measure_limit(mesh.pair.overlap_ratio)
    if measure >= limit:
        text = (
            f"stated below v z_1/100 sqrt(u²/(1 + u²)) = {limit:g} m/s, here {measure:.3g} m/s: well below the main resonance"
        )
        yield Notice("dynamic-factor-c-speed", f"K_v of Method C: {text}")
    if mesh.options.accuracy is not Accuracy.ISO_1995:
        text = f"its grades are those of {Accuracy.ISO_1995.value}, not the classes of {mesh.options.accuracy.value}"
        yield Notice("dynamic-factor-c-grade", f"K_v of Method C: {text}")
