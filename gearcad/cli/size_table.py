"""What the screen shows of a search for sizes."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from gearcad.reprs import grouped
from gearcad.schema import is_assumed

if TYPE_CHECKING:
    from gearcad.rating.options import RatingOptions
    from gearcad.sizing import SizedPair, Sizing

__all__ = ["basis_lines", "nothing_lines", "notice_texts", "scuffing_line", "table_lines"]

_HEADING = (
    *("pair", "a mm", "b mm", "x1", "x2", "u", "kg", "S_H", "S_F1", "S_F2", "eps_a", "eps_b", "sliding", "°C", "ripple %"),
    *("TE µm", "front", "notice"),
)

_WIDTH = 120

_HINTS = {
    "centre distance": "another --centre-distance, --module or --teeth",
    "diameter": "a larger --max-diameter",
    "undercut": "more --teeth, or a larger --shift and --shift-sum",
    "tip thickness": "a smaller --shift or --shift-sum",
    "contact ratio": "more --teeth, or a smaller --shift-sum or --helix-angle",
    "interference": "another --shift",
    "face width": "a larger --max-width, or a smaller --width-ratio",
    "range of the rating": "sizes that ISO 1328-1 has tolerances for",
    "flank safety": "a larger --module, --width-ratio or --centre-distance, or a harder material",
    "root safety": "a larger --module, or fewer --teeth at the same centre distance",
    "scuffing safety": "a thicker oil, a higher scuffing_stage, or more --helix-angle",
}
"""What would help where a condition takes most variants."""


def table_lines(result: Sizing) -> Iterator[str]:
    """A line for each pair, under a heading."""
    codes = list(notice_texts(result))
    rows = [_HEADING, *((*_row(each), _marks(each, codes)) for each in result.found)]
    shown = [number for number, column in enumerate(zip(*rows[1:], strict=True)) if any(column)]
    widths = {number: max(len(row[number]) for row in rows) for number in shown}
    for row in rows:
        first, *others = shown
        cells = (f"{row[number]:>{widths[number]}}" for number in others)
        yield "  ".join((f"{row[first]:<{widths[first]}}", *cells)).rstrip()


def _marks(each: SizedPair, codes: list[str]) -> str:
    """Numbers of the notices of its rating."""
    own = () if each.strength is None else (codes.index(notice.code) + 1 for notice in each.strength.notices)
    return ",".join(map(str, sorted(set(own))))


def notice_texts(result: Sizing) -> dict[str, list[str]]:
    """What the ratings give notice of, by code: the texts, of some kinds different with each pair."""
    found: dict[str, list[str]] = {}
    for each in result.found:
        for notice in () if each.strength is None else each.strength.notices:
            texts = found.setdefault(notice.code, [])
            if str(notice) not in texts:
                texts.append(str(notice))
    return found


def scuffing_line(options: RatingOptions) -> str | None:
    """That scuffing was not judged, and what would let it be; None where it was."""
    from gearcad.sizing.sized import unjudged_scuffing

    why = unjudged_scuffing(options)
    return None if why is None else f"{why}; --safety-scuffing 1.8 --rating scuffing_stage=12 would judge it"


def basis_lines(options: RatingOptions, application_factor: float, assumed: Iterable[str]) -> Iterator[str]:
    """What the safeties go by, said once: what is required, the accuracy, and what was assumed."""
    grade = f"accuracy grade {options.accuracy_grade} of {options.accuracy.value}"
    grade += " (assumed)" if is_assumed(options.accuracy_grade) else ""
    required = f"S_H {options.required_safety_flank:g}, S_F {options.required_safety_root:g}"
    yield f"required {required}; K_A {application_factor:g}; {grade}; {options.standard.value}"
    yield from _wrapped("assumed ", "; ".join(assumed))


def _wrapped(words: str, text: str) -> list[str]:
    return textwrap.wrap(text, _WIDTH, initial_indent=words, subsequent_indent=" " * len(words)) if text else []


def _row(each: SizedPair) -> tuple[str, ...]:
    return (
        each.name,
        f"{each.centre_distance:g}",
        f"{each.face_width:g}",
        f"{each.pinion_shift:.2f}",
        f"{each.shift_sum - each.pinion_shift:.3f}",
        f"{each.ratio:.3f}",
        f"{each.mass:.3g}" if each.mass < 100 else f"{each.mass:.0f}",
        f"{min(each.flank_safeties):.2f}",
        *(f"{safety:.2f}" for safety in each.root_safeties),
        f"{each.transverse_contact_ratio:.2f}",
        f"{each.overlap_ratio:.2f}" if each.overlap_ratio else "",
        f"{each.sliding:.2f}",
        "" if each.temperature is None else f"{each.temperature:.0f}",
        f"{100 * each.ripple:.0f}",
        "" if each.transmission_error is None else f"{each.transmission_error:.2f}",
        "*" if each.front else "",
    )


def nothing_lines(result: Sizing) -> Iterator[str]:
    """Why nothing was found: which condition took what, the safest of all, and what would help."""
    took = ", ".join(f"{grouped(number)} by {name}" for name, number in result.removed.items() if number)
    yield f"No pair of {grouped(result.considered)} variants meets all conditions: removed {took}"
    last = _last(result)
    if last == "mass" and (light := result.lightest) is not None:
        yield f"the lightest variant that is safe is {light.name}, b {light.face_width:g} mm: {light.mass:.3g} kg"
    elif (best := result.strongest) is not None:
        rating, flank, root = result.task.rating, min(best.flank_safeties), min(best.root_safeties)
        required = f"{rating.required_safety_flank:g} and {rating.required_safety_root:g} are required"
        yield f"the safest is {best.name}, b {best.face_width:g} mm: S_H {flank:.2f}, S_F {root:.2f}, where {required}"
    for text in result.unmade[:1]:
        yield f"{len(result.unmade)} could not be made or did not pass the full rating; the first: {text}"
    if last is not None:
        yield f"what would help: {_hint(last, result)}"


def _last(result: Sizing) -> str | None:
    """The condition that removed the last candidates: those that it took had met all before. None where some met all."""
    if result.cloud.size:
        return None
    return next((name for name, number in reversed(result.removed.items()) if number), None)


def _hint(condition: str, result: Sizing) -> str:
    light = result.lightest
    if condition != "mass" or light is None:
        return _HINTS[condition]
    step = 10.0 ** (math.floor(math.log10(light.mass)) - 2)
    return f"--max-mass {math.ceil(light.mass / step) * step:.3g} or more; a harder material makes lighter pairs"
