"""Oil film and temperature along the path of contact: the standard's flash temperature, exponents, hand calculations."""

import math
from dataclasses import replace

import numpy as np
import pytest

from gearcad import Gear, GearPair, Load
from gearcad.check.oil_film import LineFilm, flank_speeds, flash_constant, flash_temperature, normal_radius, oil_film, warmed
from gearcad.check.options import CheckOptions
from gearcad.check.task import check_task
from gearcad.contact.plane.cycle import PlaneCycle
from gearcad.contact.plane.pair import plane_pair
from gearcad.contact.solid.cycle import SolidCycle
from gearcad.contact.solid.pair import SolidSizes, solid_pair
from gearcad.core.errors import ParameterError
from gearcad.core.records import PerGear
from gearcad.material import Material, MaterialGroup
from gearcad.rating.contact_stress import half_width, peak_pressure
from gearcad.rating.friction import scuffing_of_check
from gearcad.rating.options import OilType, RatingOptions
from gearcad.rating.scuffing_temperatures import Oil

STEEL = Material()
LOAD = Load(torque=150.0, speed=1450.0)
OIL = RatingOptions(oil_viscosity_40=100.0, oil_viscosity_100=11.0, oil_temperature=60.0, oil_density=885.0)
MODULUS = 206000 / (1 - 0.09)
"""E_r (MPa) of steel on steel, twice E*."""


def fzg(helix: float = 0.0, shifts: tuple[float, float] = (0.1817, 0.1715)) -> GearPair:
    """Gears as the FZG type C, helical too."""
    pinion, wheel = (
        Gear(teeth=teeth, profile_shift=shift, helix_angle=sign * helix, normal_module=4.5, face_width=14.0)
        for teeth, shift, sign in zip((16, 24), shifts, (1, -1), strict=True)
    )
    return GearPair(pinion=pinion, wheel=wheel)


def ring() -> GearPair:
    return GearPair(
        pinion=Gear(teeth=22, normal_module=2.0, face_width=14.0), wheel=Gear(teeth=-67, normal_module=2.0, face_width=14.0)
    )


@pytest.mark.parametrize(
    "pair", [fzg(), fzg(15.0), fzg(shifts=(0.2, -0.2)), ring()], ids=["spur", "helical", "no-shift", "ring"]
)
def test_hertz_and_shares_of_the_standard_give_its_flash_temperature(pair: GearPair) -> None:
    """The standard goes by the load, the place Gamma and its own constants; here pressures, speeds and half widths do."""
    scuffing = scuffing_of_check(pair, PerGear(STEEL, STEEL), LOAD, OIL)
    standard = scuffing.flash
    assert standard is not None
    path = standard.path
    places = pair.path_of_contact.C * (1 + path.places)
    # Normal load per length of the line: F_t/(b cos alpha_t).
    load = path.shares * standard.specific_load / math.cos(math.radians(pair.pinion.transverse_pressure_angle))
    lean = math.cos(math.radians(pair.pinion.base_helix_angle))
    radius = 1 / (1 / places + 1 / (pair.base_tangent.length - places)) / lean
    assert normal_radius(pair, places) == pytest.approx(radius, rel=1e-12)
    found = flash_temperature(
        peak_pressure(load, radius, MODULUS / 2),
        half_width(load, radius, MODULUS / 2),
        flank_speeds(pair, places, LOAD.speed),
        standard.friction,
        flash_constant(standard.mesh),
    )
    assert found == pytest.approx(standard.flash / standard.approach_factor, rel=1e-6, abs=1e-9)
    assert found.max() > 10


def test_constant_of_flash_is_the_printed_one_at_the_reference_circle() -> None:
    """ISO/TR 13989-1 prints 1.11; where both circles are one, its table has 0.14 % more."""
    scuffing = scuffing_of_check(fzg(shifts=(0.2, -0.2)), PerGear(STEEL, STEEL), LOAD, OIL)
    assert scuffing.integral is not None
    assert flash_constant(scuffing.integral.mesh) == pytest.approx(1.11, rel=2e-3)


def test_flanks_roll_at_the_pitch_point_and_slide_at_the_tips() -> None:
    pair = fzg()
    path = pair.path_of_contact
    speeds = flank_speeds(pair, np.array([path.C, path.E]), 1000.0)
    assert speeds.pinion[0] == pytest.approx(speeds.wheel[0], rel=1e-12)
    # v_g = omega_1 (1 + 1/u) g
    sliding = 1000 * math.pi / 30_000 * (1 + 16 / 24) * (path.E - path.C)
    assert speeds.pinion[1] - speeds.wheel[1] == pytest.approx(sliding, rel=1e-12)


def film(**changes: float) -> LineFilm:
    values = {
        "radius": 8.0,
        "rolling": 5.0,
        "viscosity": 0.03,
        "pressure_viscosity": 20.0,
        "pressures": 1000.0,
        "modulus": 226000.0,
    }
    values |= changes
    arrays = {name: np.array([values[name]]) for name in ("radius", "rolling", "pressures")}
    return LineFilm(**(values | arrays))


def test_line_film_by_hand() -> None:
    """rho 8 mm, 5 m/s, 0.03 Pa s, 20/GPa, 1000 MPa, E_r 226 GPa, in SI units.

    G = 20e-9 * 226e9 = 4520; U = 0.03 * 2.5/(226e9 * 0.008) = 4.148e-11; the load per width is pi/2 p b, b = 4 p rho/E_r.
    """
    half = 4 * 1e9 * 0.008 / 226e9
    width_load = math.pi / 2 * 1e9 * half
    load = width_load / (226e9 * 0.008)
    assert film().load[0] == pytest.approx(load, rel=1e-12)
    assert film().speed[0] == pytest.approx(4.148e-11, rel=1e-3)
    assert film().material == pytest.approx(4520, rel=1e-12)
    # 4520^0.54 = 94.14, (4.148e-11)^0.7 = 5.401e-8, (1.230e-4)^-0.13 = 3.223, by natural logarithms
    assert film().least[0] == pytest.approx(8000 * 2.65 * 94.14 * 5.401e-8 * 3.223, rel=5e-4)


@pytest.mark.parametrize(
    ("name", "line", "by_sliding"),
    [
        ("rolling", 0.7, 0.7),
        ("viscosity", 0.7, 0.7),
        ("pressure_viscosity", 0.54, 0.6),
        ("pressures", -0.26, -0.26),
        ("radius", 0.3, 0.3),
        ("modulus", 0.54 - 0.7 + 0.26, 0.6 - 0.7 + 0.26),
    ],
)
def test_exponents_of_film_thickness(name: str, line: float, by_sliding: float) -> None:
    """h = rho (alpha E)^a (eta v/(E rho))^0.7 (p/E)^-0.26, by finite differences of logarithms."""
    base, step = getattr(film(), name), 1e-5
    base = float(np.ravel(base)[0])
    less, more = (film(**{name: base * math.exp(sign * step)}) for sign in (-1, 1))
    for value, expected in (
        (lambda each: each.least, line),
        (lambda each: each.by_sliding(np.array([0.7])), by_sliding),
    ):
        assert math.log(value(more)[0] / value(less)[0]) / (2 * step) == pytest.approx(expected, abs=1e-8)


def test_film_of_the_standard_thins_with_heat_by_sliding() -> None:
    cold, hot = film().by_sliding(np.array([1.0]))[0], film().by_sliding(np.array([0.5]))[0]
    assert hot / cold == pytest.approx(0.5**0.22, rel=1e-12)
    # Without sliding both are Dowson's line contact, whose constants are 1.6 and 0.6 (1966), or 2.65 and 0.54 (1968).
    assert cold / film().least[0] == pytest.approx(1.6 / 2.65 * 4520**0.06, rel=1e-12)


def test_pressure_viscosity_falls_with_heat() -> None:
    assert warmed(20.0, np.array([38.0, 600.0])).tolist() == [20.0, 0.0]
    assert warmed(20.0, np.array([70.0]))[0] == pytest.approx(20 * (1 - 516 * (1 / 311 - 1 / 343)), rel=1e-12)
    mineral = Oil(viscosity_40=100.0, viscosity_100=11.0, density=885.0, temperature=90.0)
    assert mineral.pressure_viscosity is not None and 15 < mineral.pressure_viscosity < 30  # of mineral gear oils
    assert replace(mineral, kind=OilType.ESTER).pressure_viscosity is None


def test_along_the_path_of_sections() -> None:
    task = check_task(fzg(), STEEL, LOAD, CheckOptions(film="on", permissible_film=0.5), rating=OIL)
    cycle = PlaneCycle.run(plane_pair(fzg(), STEEL), 150.0, 12)
    found = oil_film(task, cycle)
    assert found is not None and len(found.places) == sum(1 for _ in cycle.interior_contacts)
    document = found.to_dict()
    heat, thin = document["temperature"], document["micropitting"]
    standard = scuffing_of_check(fzg(), PerGear(STEEL, STEEL), LOAD, OIL).flash
    assert standard is not None and heat["theta_M"] == standard.bulk
    # One pair carries all near the pitch point, as in the standard: there the flash temperatures agree as pressures do.
    path = fzg().path_of_contact
    alone = (found.places > path.B) & (found.places < path.D)
    by_standard = np.interp(found.places[alone] / path.C - 1, standard.path.places, standard.flash)
    assert alone.sum() >= 3
    assert found.flash[alone] == pytest.approx(by_standard, rel=0.03, abs=1.0)
    assert thin["lambda_GF"] == pytest.approx(min(thin["path"]["h"]) / (4.8 / 6), rel=1e-12)
    assert thin["S_lambda"] == pytest.approx(thin["lambda_GF"] / 0.5, rel=1e-12)
    assert thin["place"] == thin["path"]["place"][int(np.argmin(thin["path"]["lambda_GF"]))]
    assert {"h", "lambda_GF", "S_lambda", "alpha_M", "alpha_38"} == set(thin["unconfirmed"])
    # A given coefficient of friction counts, in proportion.
    rubbed = check_task(fzg(), STEEL, LOAD, CheckOptions(film="on", friction=2 * found.friction), rating=OIL)
    twice = oil_film(rubbed, cycle)
    assert twice is not None and twice.flash == pytest.approx(2 * found.flash, rel=1e-12)
    assert "S_lambda" not in twice.film_document()
    assert oil_film(check_task(fzg(), STEEL, LOAD), cycle) is None


@pytest.mark.long
def test_along_the_path_of_bodies() -> None:
    pair = fzg(12.0)
    task = check_task(pair, STEEL, LOAD, CheckOptions(film="on"), rating=OIL)
    cycle = SolidCycle.run(solid_pair(pair, STEEL, sizes=SolidSizes().refined(0.6)), 150.0, 6)
    found = oil_film(task, cycle)
    assert found is not None and (np.diff(found.places[found.shown]) > 0).all()
    assert len(found.shown) <= 60 < len(found.places)
    # Pressure and half width of a cell belong together: the line load is that of Hertz for its radius.
    hertz = found.pressures * 2 * normal_radius(pair, found.places) / (MODULUS / 2)
    assert found.half_widths == pytest.approx(hertz, rel=0.05)


@pytest.mark.parametrize(
    ("options", "rating", "changes", "said"),
    [
        ({"film": "on"}, RatingOptions(), {}, "rating.oil_viscosity_40"),
        ({"film": "on"}, OIL, {"load": Load(torque=150.0)}, "the speed is 0 rpm"),
        ({"film": "on"}, replace(OIL, oil_type=OilType.ESTER), {}, "pressure_viscosity"),
        ({"film": "on", "model": "section"}, OIL, {"pair": fzg(15.0)}, "sections of helical gears"),
        (
            {"film": "on"},
            OIL,
            {"material": Material(name="POM", group=MaterialGroup.PLASTIC, youngs_modulus=2800.0)},
            "plastic",
        ),
    ],
)
def test_what_is_missing_is_named(
    options: dict[str, str], rating: RatingOptions, changes: dict[str, object], said: str
) -> None:
    given = {"pair": fzg(), "material": STEEL, "load": LOAD} | changes
    with pytest.raises(ParameterError, match=said):
        check_task(given["pair"], given["material"], given["load"], CheckOptions(**options), rating=rating)


@pytest.mark.parametrize("name", ["pressure_viscosity", "permissible_film"])
def test_keys_of_the_film_need_it(name: str) -> None:
    with pytest.raises(ParameterError, match=f'{name}.*must be left out without film = "on"'):
        CheckOptions(**{name: 1.0})
