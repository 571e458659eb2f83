"""How thick the teeth of a gear are: allowance, thickness, span, balls and pins, each between limits where it has them."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from gearcad.drawing.gear_data.row import Row, RowWriter
from gearcad.geometry import Gear

__all__ = ["thickness_rows"]

_UNFIT = {
    "span_measurement": {"span-off-involute": "off_involute", "narrow-for-span": "narrow"},
    "over_balls": {"balls-off-involute": "off_involute"},
    "between_balls": {"balls-off-involute": "off_involute"},
    "over_pins": {"balls-off-involute": "off_involute", "narrow-for-pins": "narrow"},
}
"""The notices of a gear that say that a gauge does not fit it, and the words for it."""


def thickness_rows(gear: Gear, write: RowWriter) -> Iterator[Row]:
    """The rows of a gear's thickness."""
    allowance = gear.thickness_allowance
    if allowance is not None and gear.tooth_allowance is not None:
        bounds = {"thickness_limits.allowance_upper": allowance.upper, "thickness_limits.allowance_lower": allowance.lower}
        upper, lower = (f"{write.words.number(value, 0, signed=True)} µm" for value in bounds.values())
        yield Row(
            key="tooth_allowance",
            words=write.word("tooth_allowance"),
            symbol="A_sn",
            text=gear.tooth_allowance,
            limits=(upper, lower),
            numbers=bounds,
        )
    yield _gauge(gear, write, "normal_tooth_thickness", "s_n")
    if (count := gear.inspection.spanned) is not None:
        name = "span_spaces" if gear.internal else "span_teeth"
        row = _gauge(gear, write, "span_measurement", "W_k", words=name, k=str(count))
        yield replace(row, numbers={name: count} | dict(row.numbers))
    yield write.plain("ball_diameter", gear.ball_diameter, "D_M")
    name = "between_balls" if gear.internal else "over_balls"
    either = not gear.pin_axial_shift and not (gear.internal and gear.helix_angle)  # pins then find what balls do
    yield replace(_gauge(gear, write, name, "M_dK", words=f"{name}_or_pins" if either else name), key=name)
    if gear.pin_axial_shift:  # else it is that over balls
        yield _gauge(gear, write, "over_pins", "M_dR")


def _gauge(gear: Gear, write: RowWriter, name: str, symbol: str, *, words: str = "", **named: str) -> Row:
    """What a gauge shall find: limits, else the one value, else why it finds nothing."""
    key = words or name
    if (reason := _reason(gear, name)) is not None:
        return write.text(key, f"— ({write.word(reason)})", symbol, None, **named)
    limits = gear.thickness_limits
    if limits is None:
        value = getattr(gear, name)
        return write.text(key, write.words.number(value, write.decimals), symbol, {name: value}, **named)
    found = getattr(limits, name)
    if found is None:
        return write.text(key, f"— ({write.word('off_involute')})", symbol, None, **named)
    bounds = {f"thickness_limits.{name}_greatest": found.greatest, f"thickness_limits.{name}_least": found.least}
    return write.between(key, symbol, bounds, **named)


def _reason(gear: Gear, name: str) -> str | None:
    """Why a gauge does not fit."""
    codes = {notice.code for notice in gear.notices}
    return next((reason for code, reason in _UNFIT.get(name, {}).items() if code in codes), None)
