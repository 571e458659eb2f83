"""Job `identify`, the files of a search for sizes, and what both say of their results."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from pathlib import Path

from gearcad.core.errors import require_whole
from gearcad.core.output import json_text, staged_files
from gearcad.core.records import JsonObject, grouped, texts
from gearcad.core.shelf_tables import Place
from gearcad.designs.spec_writers import sized_pair_text, sized_set_text, write_front, write_pairs, write_sized_sets
from gearcad.geometry.tool_tables import FILE as TOOLS
from gearcad.geometry.tool_tables import ShelfTool
from gearcad.identify.candidates import Deciding, Identification
from gearcad.identify.measurements import ANGLES, Gauge, Measurements, Reading, Value
from gearcad.identify.search import identify_gear
from gearcad.jobs.job import with_summary
from gearcad.jobs.tools import write_tool_table
from gearcad.plots.ratings import save_front
from gearcad.rating.strength import RatedPart
from gearcad.sizing import SizedPair, SizeTask, Sizing
from gearcad.sizing.planetary_sets import SetSizeTask, SizedSet, SizedSets
from gearcad.sizing.proposals import unjudged_scuffing


def size_document(result: Sizing | SizedSets) -> JsonObject:
    """Return the content of size.json; its warnings are those about the ratings of what was found, behind its name."""
    rated = ((each.name, each.strength) for each in result.found)
    notices = [notice.within(name) for name, strength in rated if strength is not None for notice in strength.notices]
    return with_summary(result.to_dict(), texts(notices))


_TABLE, _BEST, _FRONT, _PICTURE, _DOCUMENT = _EVERY = ["pairs.csv", "best.toml", "front.csv", "front.png", "size.json"]


def write_sizing(result: Sizing, folder: Path) -> list[Path]:
    """Write the results, complete or not at all; only the document if nothing was found. Raises OutputError."""
    names = _EVERY if result.found else [_DOCUMENT]
    with staged_files(folder, sometimes=_EVERY) as staging:
        if (best := result.best) is not None:
            write_pairs(result, staging / _TABLE)
            (staging / _BEST).write_text(pair_spec(best), encoding="utf-8", newline="\n")
            write_front(result, staging / _FRONT)
            save_front(result, staging / _PICTURE)
            if own := _own_tools(result.task, folder):
                names = [*names, TOOLS]
                write_tool_table(own, staging / TOOLS)
        (staging / _DOCUMENT).write_text(json_text(size_document(result)), encoding="utf-8", newline="\n")
    return [folder / name for name in names]


def _own_tools(task: SizeTask, folder: Path) -> list[ShelfTool]:
    """Return the tools that the specs in a folder name and that only the table here has; none where one is there already."""
    found = [name.tool for name in task.hobs.values() if name.tool is not None and name.tool.place is Place.DESIGN]
    return [] if (folder / TOOLS).exists() else list(dict.fromkeys(found))


def pair_spec(pair: SizedPair, place: int = 1) -> str:
    """Return the spec of a pair that was found, the best or the one at another place, with its task and figures in comments."""
    return sized_pair_text(pair, list(_comments(pair, place)))


def _comments(best: SizedPair, place: int) -> Iterator[str]:
    """Yield comment lines with the task and the figures of a pair."""
    load, rating = best.task.load, best.task.rating
    life = "the endurance limit" if rating.life is None else f"{rating.life:g} h"
    rank = "best" if place == 1 else f"number {place}"
    yield f"{load.torque:g} N·m at {load.speed:g} rpm, u = {best.task.ratio:g}, {life}: {rank} by {best.task.criterion.value}"
    roots = " and ".join(f"{each:.3f}" for each in best.root_safeties)
    width = "" if best.least_width is None else f"; face width at least {best.least_width:.4g} mm"
    yield f"{best.mass:.3g} kg, S_H {min(best.flank_safeties):.3f}, S_F {roots}{width}"
    if (why := unjudged_scuffing(rating)) is not None:
        yield why
    if best.strength is not None:
        yield from map(str, best.strength.notices)
    yield "no backlash yet: tooth_thinning or tooth_allowance gives it"


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
"""Advice for each condition, given if it removes most variants."""


def nothing_lines(result: Sizing) -> Iterator[str]:
    """Yield lines that say why no pair was found: what each condition removed, the safest variant, and what would help."""
    took = ", ".join(f"{grouped(number)} by {name}" for name, number in result.removed.items() if number)
    yield f"No pair of {grouped(result.considered)} variants meets all conditions: removed {took}"
    last = _last_condition(result)
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


def _last_condition(result: Sizing) -> str | None:
    """Return the condition that removed the last candidates, which had met all conditions before it; None if some met all."""
    if result.cloud.size:
        return None
    return next((name for name, number in reversed(result.removed.items()) if number), None)


def _hint(condition: str, result: Sizing) -> str:
    light = result.lightest
    if condition != "mass" or light is None:
        return _HINTS[condition]
    step = 10.0 ** (math.floor(math.log10(light.mass)) - 2)
    return f"--max-mass {math.ceil(light.mass / step) * step:.3g} or more; a harder material makes lighter pairs"


_SET_SIZES_TABLE, _SET_SIZES_BEST, _SET_SIZES_DOCUMENT = "sets.csv", "best.toml", "size.json"


def write_set_sizes(result: SizedSets, folder: Path) -> list[Path]:
    """Write the results, complete or not at all. Raises OutputError."""
    with staged_files(folder) as staging:
        best = result.found[0]
        write_sized_sets(result, staging / _SET_SIZES_TABLE)
        (staging / _SET_SIZES_BEST).write_text(set_spec(result.task, best), encoding="utf-8", newline="\n")
        (staging / _SET_SIZES_DOCUMENT).write_text(json_text(size_document(result)), encoding="utf-8", newline="\n")
    return [folder / name for name in (_SET_SIZES_TABLE, _SET_SIZES_BEST, _SET_SIZES_DOCUMENT)]


def set_spec(task: SetSizeTask, sized: SizedSet, place: int = 1) -> str:
    """Return the spec of a set that was found, the lightest or the one at another place, with its figures in comments."""
    return sized_set_text(sized, list(_set_sizes_comments(task, sized, place)))


def _set_sizes_comments(task: SetSizeTask, best: SizedSet, place: int) -> Iterator[str]:
    """Yield comment lines with the task and the figures of a set."""
    rank = "the lightest found" if place == 1 else f"number {place} by mass"
    life = "the endurance limit" if task.rating.life is None else f"{task.rating.life:g} h"
    yield f"{task.torque_words} at {task.speed:g} rpm, i = {task.sets.ratio:g}, {life}: {rank}"
    flank, root = (best.least[part] for part in (RatedPart.FLANK, RatedPart.ROOT))
    safeties = f"S_H {flank:.3f}, S_F {root:.3f}"
    yield f"{best.mass:.3g} kg without bores, {safeties}; no backlash yet: planetary.tooth_thinning gives it"
    if (why := unjudged_scuffing(task.rating)) is not None:
        yield why


_MOST = 100


def identify(
    teeth: int,
    *,
    tip_diameter: Value | None = None,
    root_diameter: Value | None = None,
    span: Mapping[int, Value] | None = None,
    over_pins: Mapping[float, Value] | None = None,
    over_balls: Mapping[float, Value] | None = None,
    between_pins: Mapping[float, Value] | None = None,
    between_balls: Mapping[float, Value] | None = None,
    chordal_thickness: Mapping[float, Value] | None = None,
    helix_angle: Value | None = None,
    tip_helix_angle: Value | None = None,
    lead: Value | None = None,
    centre_distance: Value | None = None,
    mate_teeth: int | None = None,
    mate_tip_diameter: Value | None = None,
    uncertainty: float = 0.02,
    angle_uncertainty: float = 1.0,
    count: int = 10,
) -> Identification:
    """Return the standard gears that readings may be of, at most `count`, the most probable first. Lengths in mm, angles in
    degrees.

    `teeth` are negative for a ring, whose diameters are positive as they are read. `span` is {teeth or spaces spanned: mm},
    `chordal_thickness` {height below the tip: mm}, the others {diameter of the pins or balls: mm}. A reading is a number, or a
    number and its own standard uncertainty; the others have `uncertainty` (mm), `angle_uncertainty` (degrees), and a lead 1 %.
    `helix_angle` is that on the reference circle, 0 for a gear seen to be a spur gear; `tip_helix_angle` is that on the tip
    circle, as a gear rolled over paper prints it; below 0 for a left hand. Without any of them both are tried. The
    centre distance, and the mate's tips, are of the pair in which it runs.

    >>> found = identify(24, tip_diameter=52.02, root_diameter=43.01, span={3: 15.40, 4: 21.30}, helix_angle=0)
    >>> found.certain, found.best.gear.normal_module, found.best.gear.rack.pressure_angle
    (True, 2.0, 20.0)

    Raises ParameterError for readings that no gear can have, GeometryError where no gear comes near them.
    """
    measurements = Measurements(
        teeth=teeth,
        tip_diameter=tip_diameter,
        root_diameter=root_diameter,
        span=span,
        over_pins=over_pins,
        over_balls=over_balls,
        between_pins=between_pins,
        between_balls=between_balls,
        chordal_thickness=chordal_thickness,
        helix_angle=helix_angle,
        tip_helix_angle=tip_helix_angle,
        lead=lead,
        centre_distance=centre_distance,
        mate_teeth=mate_teeth,
        mate_tip_diameter=mate_tip_diameter,
        uncertainty=uncertainty,
        angle_uncertainty=angle_uncertainty,
    )
    return identify_measured(measurements, count)


def identify_measured(measurements: Measurements, count: int = 10, folder: Path | None = None) -> Identification:
    """Return the standard gears that the readings of a file may be of, as `identify` does.

    `read_measurements` reads such a file; tools of the shelf may be in a table in its `folder`.
    """
    require_whole("count", count, at_least=1, at_most=_MOST)
    return identify_gear(measurements.measured, count, folder)


_REST = 0.01
"""The least probability of all others that is told."""

_FAR = 100.0
"""Number of uncertainties above which the difference is not shown."""

_CLEAR = 2.0
"""Distance between candidates at which a measurement decides, in uncertainties."""


def reading_text(place: Reading, value: float) -> str:
    """Return a reading as text: degrees with their sign, lengths in mm."""
    return f"{value:.2f}°" if place.gauge in ANGLES else f"{value:.3f}"


def tool_lines(found: Identification) -> Iterator[str]:
    """Yield a line for each candidate that is left and whose root tools of the shelf would leave."""
    for number, each in enumerate(found.candidates, 1):
        if each.tools and each in (found.best, *found.rivals):
            yield f"{number}: its root is left by {', '.join(each.tools)}"


def identification_verdict(found: Identification) -> Iterator[str]:
    """Yield lines that say how certain the first candidate is, and what would decide between those that are left."""
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
    values = ", ".join(f"{number}: {reading_text(each.place, value)}" for number, value in enumerate(each.predicted, 1))
    how = " (gear rolled over paper)" if each.place.gauge is Gauge.TIP_HELIX_ANGLE else ""
    if each.less is not None:
        label = f"{found.measured.label(each.less)} and over {each.place.size:g}, their difference"
    apart = ", ".join(f"{distance:.1f}" if distance < _FAR else f"over {_FAR:g}" for distance in each.apart)
    return f"  {label}{how}: {values}{unit} (from 1: {apart} uncertainties)"
