"""What the screen shows of a search for sizes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from gearcad.reprs import grouped

if TYPE_CHECKING:
    from gearcad.sizing import SizedPair, Sizing

__all__ = ["nothing_lines", "table_lines"]

_HEADING = (
    *("pair", "a mm", "b mm", "x1", "x2", "u", "kg", "S_H", "S_F1", "S_F2", "eps_a", "eps_b", "sliding", "°C", "ripple %"),
    *("TE µm", "front"),
)

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
    "mass": "a larger --max-mass",
    "scuffing safety": "a thicker oil, a higher scuffing_stage, or more --helix-angle",
}
"""What would help where a condition takes most variants."""


def table_lines(result: Sizing) -> Iterator[str]:
    """A line for each pair, under a heading."""
    rows = [_HEADING, *(_row(each) for each in result.found)]
    shown = [number for number, column in enumerate(zip(*rows[1:], strict=True)) if any(column)]
    widths = {number: max(len(row[number]) for row in rows) for number in shown}
    for row in rows:
        first, *others = shown
        cells = (f"{row[number]:>{widths[number]}}" for number in others)
        yield "  ".join((f"{row[first]:<{widths[first]}}", *cells)).rstrip()


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
    if (best := result.strongest) is not None:
        rating, flank, root = result.task.rating, min(best.flank_safeties), min(best.root_safeties)
        required = f"{rating.required_safety_flank:g} and {rating.required_safety_root:g} are required"
        yield f"the safest is {best.name}, b {best.face_width:g} mm: S_H {flank:.2f}, S_F {root:.2f}, where {required}"
    for text in result.unmade[:1]:
        yield f"{len(result.unmade)} could not be made or did not pass the full rating; the first: {text}"
    last = {name: number for name, number in result.removed.items() if number and (not result.rated or name.endswith("safety"))}
    if last:
        yield f"what would help: {_HINTS[max(last, key=lambda name: last[name])]}"
