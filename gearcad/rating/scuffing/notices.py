"""What to know of scuffing temperatures: where they leave what their formulas were found for, and what of them is uncertain."""

from __future__ import annotations

from collections.abc import Iterator

from gearcad.geometry import GearPair
from gearcad.notice import Notice
from gearcad.rating.both import both
from gearcad.rating.lubricant_options import Lubrication, OilType
from gearcad.rating.options import RatingOptions
from gearcad.rating.scuffing.flash import FlashTemperature
from gearcad.rating.scuffing.integral import GREATEST_SPEED, LEAST_LOAD, IntegralTemperature

__all__ = ["scuffing_notices", "uncertain"]

LEAST_SPEED = 1.0
"""Circumferential speed (m/s) below which friction is higher than the formula says (ISO/TR 13989-2, 5.1)."""

DEEPEST = 2.5
"""Transverse contact ratio up to which ISO/TR 13989-2, 6.1, holds."""

FINE = 6
"""The coarsest accuracy grade whose tip relief ISO/TR 13989-2, 6.1.12, counts."""


def scuffing_notices(
    pair: GearPair, options: RatingOptions, integral: IntegralTemperature, flash: FlashTemperature | None
) -> Iterator[Notice]:
    """Limits of validity, and what was done at them."""
    load, speed = float(integral.specific_load), float(integral.speed)
    if load < LEAST_LOAD:
        text = f"friction is that of {LEAST_LOAD:g} N/mm in the integral temperature, the load is {load:.4g} N/mm"
        yield Notice("scuffing-low-load", f"scuffing: {text}")
    if speed > GREATEST_SPEED:
        text = f"friction is that of {GREATEST_SPEED:g} m/s, the speed is {speed:.4g} m/s"
        yield Notice("scuffing-high-speed", f"scuffing: {text}")
    elif speed < LEAST_SPEED:
        text = f"at {speed:.3g} m/s, below {LEAST_SPEED:g} m/s, friction is higher than ISO/TR 13989 says"
        yield Notice("scuffing-low-speed", f"scuffing: {text}")
    if (ratio := pair.transverse_contact_ratio) > DEEPEST:
        text = f"ISO/TR 13989-2 holds for contact ratios up to {DEEPEST:g}, here {ratio:.4f}"
        yield Notice("scuffing-contact-ratio", f"scuffing: {text}")
    if flash is None:
        text = f"a spur pair with a contact ratio of 2 and more, here {ratio:.4f}, has no shares of load in ISO/TR 13989-1"
        yield Notice("no-flash-temperature", f"scuffing: no flash temperature: {text}")
    elif (helical := float(integral.helical_load)) > 1:
        hotter = 100 * (helical**0.75 - 1)
        text = f"the flash temperature leaves K_Bgamma = {helical:.4g} out, which would raise it by {hotter:.2g} %"
        yield Notice("helical-load-factor", f"scuffing: {text}: sources do not agree")
    grade = max(options.accuracy_grade if gear.accuracy_grade is None else gear.accuracy_grade for gear in pair.gears)
    if integral.relief > 0 and grade > FINE:
        text = f"X_Ca counts tip relief, which ISO/TR 13989-2 does up to accuracy grade {FINE}, here {grade}"
        yield Notice("relief-of-coarse-gears", f"scuffing: {text}")


def uncertain(pair: GearPair, options: RatingOptions, integral: IntegralTemperature) -> Iterator[str]:
    """Symbols of what stands in one source only, or is remembered."""
    yield from ("X_J", "X_Gamma")
    if float(integral.helical_load) > 1:
        yield "K_Bgamma"
    if options.scuffing_stage is not None and options.relative_structure_factor is None:
        yield "X_W"
    if options.oil_type not in (None, OilType.MINERAL):
        yield "X_L"
    if options.oil_supply is not Lubrication.DIP:
        yield "X_S"
    if max(both(options.contacts_per_turn)) != 1:
        yield "X_mp"
    if pair.internal:
        yield from ("X_BE", "X_G")
