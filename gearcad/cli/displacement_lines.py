"""How far everything moves, as the screen shows it."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from gearcad.dynamics.train_result import TrainStudy
    from gearcad.dynamics.trains.bearing_modes import BearingModes

__all__ = ["bearing_mode_lines", "displacement_lines"]


def displacement_lines(study: TrainStudy) -> list[str]:
    """How far everything moves at most, and what bearings carry."""
    swings = {
        quantity: [
            f"{each.name} {each.amplitude:.4g} {each.unit} at {each.speed:.5g} rpm"
            for each in study.greatest_amplitudes
            if each.quantity == quantity
        ]
        for quantity in ("turn", "approach")
    }
    lines = [f"amplitude of {quantity}: {', '.join(listed)}" for quantity, listed in swings.items()]
    return lines + [
        f"bearings of {each.gear}: at most {each.force:.5g} N at {each.speed:.5g} rpm, {each.static:.5g} N at rest"
        for each in study.greatest_bearing_forces
    ]


def bearing_mode_lines(modes: BearingModes) -> list[str]:
    """The six modes of gears on bearings."""
    lines = [f"{'on bearings':<20}{'Hz':>10}{'1/s':>12}{'in mesh, %':>12}  what moves most"]
    for number, words in enumerate(modes.words):
        share = 100 * modes.potential[number, 0]
        lines.append(
            f"{number + 1:<20}{modes.frequency[number]:>10.6g}{modes.circular[number]:>12.6g}{share:>12.1f}  {words}"
            + ("" if modes.shaken[number] or not number else ": teeth do not shake it")
        )
    return lines
