"""Command `identify`: a gear from measurements."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from gearcad.cli.group import debug_option, require_new_file
from gearcad.cli.job import aligned_columns, echo_warnings, quiet_option
from gearcad.cli.language import say
from gearcad.core.errors import ParameterError
from gearcad.core.quantities import FieldSchema, schema_of
from gearcad.identify.measurements import Gauge, Measurements

if TYPE_CHECKING:
    from gearcad.identify import Candidate, Identification, SplineIdentification


_COLUMNS = 4
"""Candidates whose residuals are shown."""


def identification_lines(found: Identification) -> Iterator[str]:
    """Candidates, their residuals, the verdict, and what would decide."""
    from gearcad.jobs.searches import identification_verdict, tool_lines

    yield from aligned_columns(_candidate_rows(found), left=(1, 10))
    yield ""
    yield from aligned_columns(_residual_rows(found), left=(0,))
    yield ""
    if told := list(tool_lines(found)):
        yield from told
        yield ""
    yield from identification_verdict(found)


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
    from gearcad.jobs.searches import reading_text

    shown = found.candidates[:_COLUMNS]
    rows = [("off, in uncertainties", "read", "±", *(f"{number}" for number in range(1, len(shown) + 1)))]
    for place, each in enumerate(found.measured.readings):
        if each.value == 0:  # a spur gear: no candidate is off
            continue
        off = (f"{candidate.residuals[place]:+.1f}" for candidate in shown)
        rows.append((found.measured.label(each), reading_text(each, abs(each.value)), f"{each.uncertainty:g}", *off))
    return rows


Command = TypeVar("Command", bound=Callable[..., Any])

_SIZED = {gauge.value: gauge for gauge in Gauge if gauge.sized}
_METAVARS = {"span": "K:MM", "chordal_thickness": "H:MM", "teeth": "Z", "mate_teeth": "Z"}


def _reading_options(command: Command) -> Command:
    """An option for each key of [measured]."""
    for name, field in reversed(list(schema_of(Measurements).items())):
        command = click.option(f"--{name.replace('_', '-')}", name, **_option(name, field))(command)
    return command


def _option(name: str, field: FieldSchema) -> dict[str, Any]:
    words = field.symbol.words
    how: dict[str, Any] = {"help": f"{words[0].upper()}{words[1:]}."}
    if field.default is not None:
        how["help"] += f"  [default: {field.default:g}]"
    how["metavar"] = _METAVARS.get(name, "D:MM" if name in _SIZED else field.symbol.unit.upper())
    if name in _SIZED:
        how["multiple"] = True
    elif name.endswith("teeth"):
        how["type"] = int
    elif name.endswith("uncertainty"):
        how["type"] = float
    return how


@click.command(short_help="The standard gear that was measured: module, pressure angle, shift.")
@click.argument("file", required=False, type=click.Path(path_type=Path))
@_reading_options
@click.option("--spline", is_flag=True, help="It is a spline: which shaft, or hub with Z below 0.")
@click.option("--count", type=int, default=5, show_default=True, metavar="N", help="Most candidates that are listed.")
@click.option("--write", type=click.Path(path_type=Path), metavar="FILE", help="Write the spec of a candidate.")
@click.option("--candidate", type=int, default=1, show_default=True, metavar="N", help="Which one.")
@click.option("--force", is_flag=True, help="Replace a file that exists.")
@click.option("--json", "as_json", is_flag=True, help="Print the candidates as a document and nothing else.")
@quiet_option
@debug_option
def identify(
    file: Path | None,
    spline: bool,
    count: int,
    write: Path | None,
    candidate: int,
    force: bool,
    as_json: bool,
    quiet: bool,
    **given: Any,
) -> None:
    """Which standard gear has been measured: modules of ISO 54 and DIN 780, diametral pitches and sizes of no series, with all
    usual pressure angles and racks, spur or helical, external or a ring, ranked by how well they fit.

    The readings stand in the [measured] of FILE, as `gearcad new measured` has it, or behind options, which count before those
    of the file. Spans, pins, balls and chords may be given several times, for other K, D or H. A reading may have its own
    standard uncertainty, such as 52.3+-0.1 for a worn tip; it is of measuring and of making. Two spans tell most: they differ
    by the base pitch. Probabilities weigh the fit with how usual a gear is, as we judge it.

    \b
    gearcad identify measured.toml
    gearcad identify --teeth 24 --tip-diameter 52.02 --root-diameter 43.01 --span 3:15.40 --span 4:21.30
    gearcad identify --teeth 31 --tip-diameter 74.6 --over-pins 3.5:75.52 --tip-helix-angle 16
    gearcad identify --spline --teeth 22 --tip-diameter 29.7 --span 4:13.53
    gearcad identify --teeth 30 --tip-diameter 81.2+-0.2 --centre-distance 101.6 --mate-teeth 50
    """
    from gearcad.core.output import json_text
    from gearcad.jobs.job import with_summary
    from gearcad.jobs.searches import identify_measured

    if write is not None:
        require_new_file(write, force)
    if not 1 <= candidate <= count:
        raise ParameterError("candidate", candidate, f"must be a whole number from 1 to {count}, as many as are listed")
    if spline:
        _identify_spline(_measurements(file, given), count, candidate, write, as_json, quiet)
        return
    found = identify_measured(_measurements(file, given), count, None if file is None else file.parent)
    chosen = _chosen(found, candidate)
    if write is not None:
        _write(found, chosen, write)
    if as_json:
        click.echo(json_text(with_summary(found.to_dict())), nl=False)
    else:
        say("\n".join(identification_lines(found)))
        if write is not None:
            click.echo(write)
    if not quiet:
        echo_warnings(found.notices, err=True)
        if write is not None:
            say(f"Next: gearcad data {write}", err=True)
    if not found.fits:
        click.get_current_context().exit(1)


def _identify_spline(given: Measurements, count: int, number: int, write: Path | None, as_json: bool, quiet: bool) -> None:
    """Show the splines that readings may be of, and write the spec of one of them."""
    from gearcad.core.output import json_text, staged_files
    from gearcad.designs.spec_writers import toml_text
    from gearcad.identify.splines import identify_spline
    from gearcad.jobs.job import with_summary

    found = identify_spline(given.measured, count)
    if number > len(found.candidates):
        permitted = f"must be a whole number from 1 to {len(found.candidates)}, as many as there are"
        raise ParameterError("candidate", number, permitted)
    if write is not None:
        keys = {"name": write.stem, "designation": found.candidates[number - 1].designation}
        text = toml_text({"spline": keys}, ["identified from measurements, without a tolerance class"])
        with staged_files(write.parent) as staging:
            (staging / write.name).write_text(text, encoding="utf-8", newline="\n")
    if as_json:
        click.echo(json_text(with_summary(found.to_dict())), nl=False)
    else:
        say("\n".join(_spline_lines(found)))
        if write is not None:
            click.echo(write)
    if write is not None and not quiet:
        say(f"Next: gearcad data {write}", err=True)
    if not found.fits:
        click.get_current_context().exit(1)


def _spline_lines(found: SplineIdentification) -> Iterator[str]:
    """Yield the candidates with their misfit and residuals, and the verdict."""
    labels = [found.measured.label(each) for each in found.measured.readings]
    rows = [("", "designation", "root", "x", "size mm", "basic mm", "misfit")]
    for number, each in enumerate(found.candidates, 1):
        joint = each.spline.joint
        sizes = (f"{joint.profile_shift:.3f}", f"{each.size:.3f}", f"{each.spline.basic_size:.3f}", f"{each.misfit:.2f}")
        rows.append((f"{number}", each.designation, each.spline.root, *sizes))
    yield from aligned_columns(rows, left=(1, 2))
    yield ""
    shown = found.candidates[:_COLUMNS]
    off = [("off, in uncertainties", *(f"{number}" for number in range(1, len(shown) + 1)))]
    off += [(label, *(f"{each.residuals[place]:+.1f}" for each in shown)) for place, label in enumerate(labels)]
    yield from aligned_columns(off, left=(0,))
    yield ""
    if not found.fits:
        yield "No spline of a standard fits: a reading is wrong, or it is another profile"
    elif found.rivals:
        others = ", ".join(each.designation for each in found.rivals)
        yield f"Ambiguous: {found.best.designation}, or {others}"
        yield "What would decide: a span, and a size over or between pins"
    else:
        yield f"Certain: {found.best.designation} fits, and no other size does"


def _measurements(file: Path | None, given: dict[str, Any]) -> Measurements:
    """Return the measurements of a file and of the options that are given. Raises ParameterError without a number of teeth."""
    from gearcad.designs.spec_writers import read_measurements, reading_of

    readings: dict[str, Any] = {}
    for name, said in given.items():
        if said is None or said == ():
            continue
        sized, text = name in _SIZED, isinstance(said, str)
        readings[name] = _by_size(name, said) if sized else reading_of(name, said) if text else said
    if file is not None:
        return read_measurements(file, readings)
    if "teeth" not in readings:
        raise ParameterError("teeth", None, "must be given, as counted, or a FILE of measurements (`gearcad new measured`)")
    return Measurements(**readings)


def _by_size(name: str, texts: Sequence[str]) -> dict[float, Any]:
    """Readings by the number of teeth spanned, or by the diameter of pins or balls."""
    from gearcad.designs.spec_writers import reading_of, size_of

    gauge, found = _SIZED[name], {}
    for text in texts:
        first, colon, reading = text.partition(":")
        if not colon:
            example = "3:15.40" if gauge is Gauge.SPAN else "3.5:56.21"
            raise ParameterError(name, text, f"must be {gauge.size_in_words} and reading, such as {example}")
        size = size_of(gauge, first)
        if size in found:
            raise ParameterError(name, text, f"must be given once for {size:g}")
        found[size] = reading_of(name, reading)
    return found


def _chosen(found: Identification, number: int) -> Candidate:
    if number > len(found.candidates):
        permitted = f"must be a whole number from 1 to {len(found.candidates)}, as many as there are"
        raise ParameterError("candidate", number, permitted)
    return found.candidates[number - 1]


def _write(found: Identification, chosen: Candidate, path: Path) -> None:
    from gearcad.core.output import staged_files
    from gearcad.designs.spec_writers import identified_text

    with staged_files(path.parent) as staging:
        (staging / path.name).write_text(identified_text(found, chosen, path.stem), encoding="utf-8", newline="\n")
