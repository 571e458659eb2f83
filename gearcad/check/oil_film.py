"""Oil film and temperature along the path of contact, from the pressures that a check has found there.

Flash temperature by ISO/TR 13989-1, film thickness by D. Dowson and G. R. Higginson and by ISO/TS 6336-22, Method A, as
remembered. Places are in mm from T1 on the line of action, speeds in m/s, film thickness in µm.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from gearcad.check.task import CheckTask
from gearcad.contact.plane.cycle import PlaneCycle
from gearcad.contact.shared.loaded import Cycle
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.core.records import Floats, JsonObject, Notice, PerGear, Wholes, freeze
from gearcad.geometry import GearPair
from gearcad.material import Material, elastic_constants
from gearcad.rating.contact_stress import reduced_modulus
from gearcad.rating.scuffing import Scuffing
from gearcad.rating.scuffing_temperatures import (
    CONDUCTIVITY,
    HEAT_CAPACITY,
    Oil,
    SlidingMesh,
    kinematic_viscosity,
)

_STRETCHES = 60
"""Stretches of the path of solid gears, of each of which the most pressed cell is told."""


def flank_speeds(pair: GearPair, places: Floats, speed: float) -> PerGear[Floats]:
    """Return the speeds v_r1 and v_r2 (n,) in m/s at which the flanks move across their line of contact.

    They are omega rho in the transverse section, at places (n,) in mm from T1, under the speed of the pinion in rpm.
    """
    turning = abs(speed) * math.pi / 30_000
    return PerGear(turning * places, turning / pair.gear_ratio * (pair.base_tangent.length - places))


def normal_radius(pair: GearPair, places: Floats) -> Floats:
    """Return the radius of relative curvature rho_n (n,) in mm in the normal section, at places (n,) in mm from T1."""
    rest = pair.base_tangent.length - places
    result: Floats = places * rest / (places + rest) / math.cos(math.radians(pair.pinion.base_helix_angle))
    return result


def flash_constant(mesh: SlidingMesh) -> float:
    """Return the constant of the flash temperature, printed as 1.11, that X_alpha_beta and X_G of ISO/TR 13989-1 (A.5 to A.7)
    lead to.

    0.51 X_alpha_beta cos^0.75 alpha_t/(sin alpha_wt cos beta_b)^0.25 sqrt(2) (8/pi)^0.25: it grows with the working pressure
    angle, as X_alpha_beta has the speed of the reference circle, and the flash temperature that of the pitch circle.
    """
    a_t, a_wt = math.radians(mesh.transverse_pressure_angle), math.radians(mesh.working_pressure_angle)
    lean = math.cos(math.radians(mesh.base_helix_angle))
    shape = math.cos(a_t) ** 0.75 / (abs(math.sin(a_wt)) * lean) ** 0.25
    return float(0.51 * mesh.angle_factor * shape * math.sqrt(2) * (8 / math.pi) ** 0.25)


def flash_temperature(
    pressures: Floats, half_widths: Floats, speeds: PerGear[Floats], friction: float, constant: float
) -> Floats:
    """Return Theta_fl (n,) in K: K mu w/(B_M sqrt(2 b)) |v_r1 - v_r2|/(sqrt(v_r1) + sqrt(v_r2)), w = pi/2 p b (ISO/TR 13989-1).

    `pressures` p (n,) in MPa and `half_widths` b (n,) in mm are those of the contact; B_M is that of steel.
    """
    load = math.pi / 2 * pressures * half_widths
    slid = np.abs(np.sqrt(1000 * speeds.pinion) - np.sqrt(1000 * speeds.wheel))
    heat = math.sqrt(CONDUCTIVITY * HEAT_CAPACITY)
    result: Floats = constant * friction * load * slid / (heat * np.sqrt(2 * half_widths))
    return result


def viscosity(oil: Oil, temperatures: Floats) -> Floats:
    """Return the dynamic viscosity eta (n,) in Pa s at temperatures (n,) in °C, as `Oil.dynamic_viscosity`."""
    nu = np.array([kinematic_viscosity(oil.viscosity_40, oil.viscosity_100, each) for each in temperatures.tolist()])
    result: Floats = nu * np.maximum(oil.density - 0.7 * (temperatures - 15), 0.0) / 1e6
    return result


def warmed(alpha: float, temperatures: Floats) -> Floats:
    """Return alpha (n,) in 1/GPa at temperatures (n,) in °C: alpha_38 (1 + 516 (1/T - 1/311)); 0 from 510 °C on.

    By ISO/TR 15144-1 as remembered: unconfirmed.
    """
    result: Floats = alpha * np.maximum(1 + 516 * (1 / (temperatures + 273) - 1 / 311), 0.0)
    return result


@dataclass(frozen=True, kw_only=True)
class LineFilm:
    """Oil film of line contacts (n,): dimensionless parameters of its thickness.

    `radius` rho_n (mm), `rolling` v_r1 + v_r2 (m/s), `viscosity` eta (Pa s) and `pressure_viscosity` alpha (1/GPa) at the bulk
    temperature, `pressures` p (MPa); `modulus` E_r (MPa) is 2/((1 - nu_1^2)/E_1 + (1 - nu_2^2)/E_2).
    """

    radius: Floats
    rolling: Floats
    viscosity: float
    pressure_viscosity: float
    pressures: Floats
    modulus: float

    def __post_init__(self) -> None:
        freeze(self)

    @property
    def material(self) -> float:
        """Material parameter G = alpha E_r."""
        return self.pressure_viscosity * self.modulus / 1000

    @property
    def speed(self) -> Floats:
        """Speed parameter U = eta (v_r1 + v_r2)/(2 E_r rho_n), n of them."""
        return self.viscosity * self.rolling / (2000 * self.modulus * self.radius)

    @property
    def load(self) -> Floats:
        """Load parameter W = 2 pi p^2/E_r^2 = w/(E_r rho_n), n of them."""
        return 2 * math.pi * self.pressures**2 / self.modulus**2

    @property
    def least(self) -> Floats:
        """Least film thickness (n,) in µm: 2.65 rho_n G^0.54 U^0.7 W^-0.13 (D. Dowson, Proc. IMechE 182 (1968))."""
        result: Floats = 2650 * self.radius * self.material**0.54 * self.speed**0.7 * self.load**-0.13
        return result

    def by_sliding(self, sliding: Floats) -> Floats:
        """Return h_Y (n,) in µm of ISO/TS 6336-22, Method A: 1600 rho_n G^0.6 U^0.7 W^-0.13 S_GF^0.22, as remembered.

        `sliding` (n,) is the sliding parameter S_GF: alpha eta at the contact temperature over that at the bulk temperature.
        """
        result: Floats = 1600 * self.radius * self.material**0.6 * self.speed**0.7 * self.load**-0.13 * sliding**0.22
        return result


@dataclass(frozen=True, kw_only=True)
class OilFilm:
    """Temperature and oil film at contacts (n,) away from edges, `places` in mm from T1 in rising order.

    `pressures` p (MPa), `half_widths` b (mm), `speeds` of both flanks (m/s), `flash` temperature (K), `film` and its sliding
    parameter. `shown` (m,) are the contacts of which courses are told. `scuffing` has the temperatures of the standard under
    the same load, `friction` is the coefficient, `bulk` Theta_M (°C) of the standard, `roughness` the mean Ra (µm) of both
    flanks, `alpha` alpha_38 (1/GPa).
    """

    pair: GearPair
    scuffing: Scuffing
    friction: float
    bulk: float
    roughness: float
    alpha: float
    alpha_given: bool
    permissible: float | None
    places: Floats
    pressures: Floats
    half_widths: Floats
    speeds: PerGear[Floats]
    flash: Floats
    film: LineFilm
    sliding: Floats
    shown: Wholes

    def __post_init__(self) -> None:
        freeze(self)

    @property
    def contact(self) -> Floats:
        """Contact temperatures (n,) in °C."""
        return self.bulk + self.flash

    @cached_property
    def thickness(self) -> Floats:
        """h_Y (n,) in µm of ISO/TS 6336-22."""
        return self.film.by_sliding(self.sliding)

    @property
    def specific(self) -> Floats:
        """Specific film thickness lambda_GF (n,): h_Y/Ra."""
        return self.thickness / self.roughness

    @property
    def thinnest(self) -> int:
        """Index of the contact with the least specific film thickness."""
        return int(np.argmin(self.thickness))

    @property
    def hottest(self) -> int:
        """Index of the contact with the highest temperature."""
        return int(np.argmax(self.flash))

    @property
    def safety(self) -> float | None:
        """S_lambda = lambda_GF,min/lambda_GFP; None where no permissible one is given."""
        return None if self.permissible is None else float(self.specific[self.thinnest]) / self.permissible

    @property
    def standard_course(self) -> tuple[Floats, Floats] | None:
        """Places (mm from T1) and contact temperatures (°C) of the standard; None where it has none."""
        flash = self.scuffing.flash
        return None if flash is None else (self.pair.path_of_contact.C * (1 + flash.path.places), flash.contact)

    def _diameters(self, at: int) -> JsonObject:
        """Return the diameters d_Y (mm) of both gears at a contact."""
        place = float(self.places[at])
        rolls = PerGear(place, self.pair.base_tangent.length - place)
        gears = zip(self.pair.gears.items(), rolls, strict=True)
        return {role.value: 2 * math.hypot(gear.base_diameter / 2, roll) for (role, gear), roll in gears}

    def temperature_document(self) -> JsonObject:
        """Return the content of "temperature" in check.json."""
        hottest, flash = self.hottest, self.scuffing.flash
        courses = {
            "place": self.places,
            "pressure": self.pressures,
            "half_width": self.half_widths,
            "v_g": np.abs(self.speeds.pinion - self.speeds.wheel),
            "v_sum": self.film.rolling,
            "theta_fl": self.flash,
            "theta_B": self.contact,
        }
        return {
            "theta_oil": self.scuffing.oil.temperature,
            "theta_M": self.bulk,
            "theta_flmax": float(self.flash[hottest]),
            "theta_B": float(self.contact[hottest]),
            "place": float(self.places[hottest]),
            "diameter": self._diameters(hottest),
            "coefficient": self.friction,
            "standard": None if flash is None else {"theta_flmax": float(flash.flash.max()), "theta_B": flash.value},
            "path": {name: values[self.shown].tolist() for name, values in courses.items()},
            "assumed": list(self.scuffing.assumed),
            "unconfirmed": list(self.scuffing.verify),
        }

    def film_document(self) -> JsonObject:
        """Return the content of "micropitting" in check.json."""
        thinnest, least = self.thinnest, self.film.least
        courses = {"place": self.places, "h": self.thickness, "h_line_contact": least, "lambda_GF": self.specific}
        judged = {} if self.safety is None else {"lambda_GFP": self.permissible, "S_lambda": self.safety}
        return {
            "lambda_GF": float(self.specific[thinnest]),
            "h": float(self.thickness[thinnest]),
            "h_line_contact": float(least[thinnest]),
            "place": float(self.places[thinnest]),
            "diameter": self._diameters(thinnest),
            "Ra": self.roughness,
            "eta_M": 1000 * self.film.viscosity,
            "alpha_38": self.alpha,
            **judged,
            "path": {name: values[self.shown].tolist() for name, values in courses.items()},
            "unconfirmed": list(self.unconfirmed),
        }

    def to_dict(self) -> JsonObject:
        """Return what check.json has of temperature and film."""
        return {"temperature": self.temperature_document(), "micropitting": self.film_document()}

    @property
    def unconfirmed(self) -> tuple[str, ...]:
        """Symbols of what rests on memory."""
        judged = () if self.safety is None else ("S_lambda",)
        return ("h", "lambda_GF", *judged, "alpha_M", *(() if self.alpha_given else ("alpha_38",)))


def oil_film(task: CheckTask, cycle: Cycle) -> OilFilm | None:
    """Return temperature and oil film of a cycle; None where none is asked for, or no contact is away from edges.

    Raises ParameterError where the task has no temperatures.
    """
    scuffing = task.scuffing
    if scuffing is None or scuffing.integral is None:
        return None
    pair = task.gear_pair
    given, permissible = task.options.pressure_viscosity, task.options.permissible_film
    alpha = scuffing.oil.pressure_viscosity if given is None else given
    if alpha is None:
        return None
    places, pressures, half_widths = _local_contacts(cycle)
    if not len(places):
        return None
    standard = scuffing.flash or scuffing.integral
    friction, bulk = float(standard.friction), float(standard.bulk)
    if task.friction is not None:
        friction = task.friction.coefficient(cycle.model.force(task.torque))
    speeds = flank_speeds(pair, places, task.load.speed)
    flash = flash_temperature(pressures, half_widths, speeds, friction, flash_constant(scuffing.integral.mesh))
    at_bulk = np.array([bulk])
    film = LineFilm(
        radius=normal_radius(pair, places),
        rolling=speeds.pinion + speeds.wheel,
        viscosity=float(viscosity(scuffing.oil, at_bulk)[0]),
        pressure_viscosity=float(warmed(alpha, at_bulk)[0]),
        pressures=pressures,
        modulus=_relative_modulus(task.materials),
    )
    carried = film.viscosity * film.pressure_viscosity
    hot = viscosity(scuffing.oil, bulk + flash) * warmed(alpha, bulk + flash)
    return OilFilm(
        pair=pair,
        scuffing=scuffing,
        friction=friction,
        bulk=bulk,
        roughness=float(scuffing.integral.roughness),
        alpha=alpha,
        alpha_given=given is not None,
        permissible=permissible,
        places=places,
        pressures=pressures,
        half_widths=half_widths,
        speeds=speeds,
        flash=flash,
        film=film,
        sliding=hot / carried if carried else np.zeros_like(hot),
        shown=_most_pressed(places, pressures) if isinstance(cycle, SolidCycle) else np.arange(len(places)),
    )


def _relative_modulus(materials: PerGear[Material]) -> float:
    """Return E_r (MPa), twice E* of the contact."""
    moduli, ratios = elastic_constants(materials)
    return 2 * reduced_modulus((moduli.pinion, moduli.wheel), (ratios.pinion, ratios.wheel))


def _local_contacts(cycle: Cycle) -> tuple[Floats, Floats, Floats]:
    """Return places (mm from T1), pressures (MPa) and half widths (mm) of contacts away from edges, of solid gears of cells."""
    found: list[tuple[Floats, Floats, Floats]] = [(np.zeros(0), np.zeros(0), np.zeros(0))]
    if isinstance(cycle, PlaneCycle):
        for _, plane in cycle.interior_contacts:
            found.append((np.array([plane.place]), np.array([plane.peak_pressure]), np.array([plane.hertz_half_width])))
    elif isinstance(cycle, SolidCycle):
        for _, solid in cycle.interior_contacts:
            inside = solid.interior
            found.append((solid.line.nominal[inside], solid.pressures[inside], solid.half_widths[inside]))
    places, pressures, half_widths = (np.concatenate(each) for each in zip(*found, strict=True))
    order = np.argsort(places)
    return places[order], pressures[order], half_widths[order]


def _most_pressed(places: Floats, pressures: Floats) -> Wholes:
    """Return the indices of the contact with the greatest pressure in each stretch of the path."""
    ends = np.linspace(places[0], places[-1], _STRETCHES + 1)
    stretches = np.clip(np.searchsorted(ends, places, side="right") - 1, 0, _STRETCHES - 1)
    order = np.lexsort((pressures, stretches))
    last = np.flatnonzero(np.diff(stretches[order], append=_STRETCHES))
    result: Wholes = order[last]
    return result


def film_notices(task: CheckTask, found: OilFilm | None) -> Iterator[Notice]:
    """Yield what of the oil film is unconfirmed, or why there is none."""
    if found is None and task.options.asks_film:
        yield Notice("no-film", "no temperatures and no oil film along the path: no contact is away from edges")
    elif found is not None:
        names = ", ".join(found.unconfirmed)
        text = f"the specific film thickness is that of ISO/TS 6336-22 as remembered: {names} are unconfirmed"
        yield Notice("film-unconfirmed", text)
