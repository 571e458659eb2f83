"""What the screen shows of an identification."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from gearcad.identify.measured import ANGLES, Gauge, Reading

if TYPE_CHECKING:
    from gearcad.identify import Candidate, Deciding, Identification

__all__ = ["identification_lines"]

_COLUMNS = 4
"""Candidates whose residuals are shown."""

_REST = 0.01
"""The least probability of all others that is told."""

_FAR = 100.0
"""Uncertainties beyond which nobody asks how far."""

_CLEAR = 2.0
"""How far apart candidates must be for a measurement to decide."""


def identification_lines(found: Identification) -> Iterator[str]:
    """Candidates, their residuals, the verdict, and what would decide."""
    yield from _aligned(_candidate_rows(found), left=(1, 10))
    yield ""
    yield from _aligned(_residual_rows(found), left=(0,))
    yield ""
    yield from _verdict(found)


def _aligned(rows: Sequence[Sequence[str]], left: Sequence[int]) -> Iterator[str]:
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        cells = (
            f"{cell:<{width}}" if number in left else f"{cell:>{width}}"
            for number, (cell, width) in enumerate(zip(row, widths, strict=True))
        )
        yield "  ".join(cells).rstrip()


def _candidate_rows(found: Identification) -> list[tuple[str, ...]]:
    heading = ("", "size", "%", "chi²", "m_n mm", "α_n °", "β °", "x", "thinning mm", "k", "rack (h_a/h_f)")
    return [heading, *(_row(number, each) for number, each in enumerate(found.candidates, 1))]


def _row(number: int, each: Candidate) -> tuple[str, ...]:
    gear = each.gear
    pitch = each.diametral_pitch
    return (
        f"{number}",
        " ".join([each.series, *([f"{pitch:g}"] if pitch is not None else []), *(["transverse"] if each.transverse else [])]),
        f"{100 * each.probability:.1f}",
        f"{each.chi_square:.1f}",
        f"{gear.normal_module:.5g}" + (f" ±{each.module_uncertainty:.1g}" if each.module_uncertainty else ""),
        f"{gear.rack.pressure_angle:g}",
        f"{gear.helix_angle:.2f} ±{each.helix_uncertainty:.1g}" if gear.helix_angle else "0",
        f"{gear.profile_shift:.3f} ±{each.shift_uncertainty:.1g}",
        f"{gear.tooth_thinning:.3f} ±{each.thinning_uncertainty:.1g}",
        f"{gear.tip_alteration:.3f}" if gear.tip_alteration else "0",
        f"{each.rack.name} ({gear.rack.addendum:g}/{gear.rack.dedendum:.4g})",
    )


def _residual_rows(found: Identification) -> list[tuple[str, ...]]:
    """Readings, and how far each candidate is off, in uncertainties."""
    shown = found.candidates[:_COLUMNS]
    rows = [("off, in uncertainties", "read", "±", *(f"{number}" for number in range(1, len(shown) + 1)))]
    for place, each in enumerate(found.measured.readings):
        if each.value == 0:  # a spur gear: no candidate is off
            continue
        off = (f"{candidate.residuals[place]:+.1f}" for candidate in shown)
        rows.append((found.measured.label(each), _number(each, abs(each.value)), f"{each.uncertainty:g}", *off))
    return rows


def _number(place: Reading, value: float) -> str:
    return f"{value:.2f}°" if place.gauge in ANGLES else f"{value:.3f}"


def _verdict(found: Identification) -> Iterator[str]:
    if found.certain:
        yield "Certain: all others together are less probable than 5 %"
        return
    if not found.fits:
        yield "Not certain: no candidate fits"
    elif not found.rivals and found.best.off_involute:
        yield "Not certain: a gauge would not touch the flanks of 1, so that it cannot have read what was read"
    elif not found.rivals:
        yield f"Not certain: many others are left, each less probable than {100 * found.candidates[-1].probability:.1g} %"
    else:
        first, *others = (f"{number}" for number in range(1, len(found.rivals) + 2))
        rest = f", or one that is not listed ({100 * found.unlisted:.0f} %)" if found.unlisted >= _REST else ""
        yield f"Ambiguous: {first} or {', '.join(others)}{rest}"
    if found.alike:
        same = ", ".join(f"{found.candidates.index(each) + 1}" for each in found.alike)
        yield f"The flanks of {same} are those of 1 under another name, within uncertainty: as a replacement they are alike"
    if found.deciding:
        apart = found.deciding[0].apart
        yield (
            "What would decide:"
            if min(apart) >= _CLEAR
            else "What would tell some of them from 1:"
            if max(apart) >= _CLEAR
            else "Nothing else decides at once; these tell most, measured more finely:"
        )
        yield from (_deciding_line(found, each) for each in found.deciding)


def _deciding_line(found: Identification, each: Deciding) -> str:
    label, unit = found.measured.label(each.place), "" if each.place.gauge in ANGLES else " mm"
    values = ", ".join(f"{number}: {_number(each.place, value)}" for number, value in enumerate(each.predicted, 1))
    how = " (gear rolled over paper)" if each.place.gauge is Gauge.TIP_HELIX_ANGLE else ""
    if each.less is not None:
        label = f"{found.measured.label(each.less)} and over {each.place.size:g}, their difference"
    apart = ", ".join(f"{distance:.1f}" if distance < _FAR else f"over {_FAR:g}" for distance in each.apart)
    return f"  {label}{how}: {values}{unit} (from 1: {apart} uncertainties)"
