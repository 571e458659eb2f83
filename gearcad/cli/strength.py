"""Commands `check`, `rate`, `stiffness` and `modify`."""

from __future__ import annotations

import math
import os
import textwrap
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import click

from gearcad.check.comparison import Comparison, ComparisonRole
from gearcad.cli.group import debug_option, require_new_file, spec_argument
from gearcad.cli.job import echo_warnings, job_progress, json_option, output_option, perform, quiet_option
from gearcad.cli.language import say, translated
from gearcad.core.errors import InputError, OutputError, SpecError
from gearcad.version import __version__

if TYPE_CHECKING:
    from gearcad.check.result import CheckResult
    from gearcad.check.spline import SplineCheck
    from gearcad.dynamics.planetary.planetary_strength import TrainStrength
    from gearcad.jobs.modify import Proposal
    from gearcad.jobs.train import MeshResults
    from gearcad.rating.strength import StrengthRating
    from gearcad.stiffness import StiffnessComparison


_LONGEST_LIFE = 1e6
"""Hours above which a life is told as more than that."""


def train_strength_lines(strength: TrainStrength, *, verdict: bool = True) -> Iterator[str]:
    """A line for each gear that was judged, scuffing of each mesh, the life, and the verdict unless it stands elsewhere."""
    from gearcad.rating.strength import RatedPart

    for name, gear in strength.members.items():
        found = ((part, gear.least(part)) for part in RatedPart)
        texts = [f"S_{part.index} {least.safety:.4g} in {least.mesh}" for part, least in found if least is not None]
        if texts:
            yield f"{f'safety of {name}':<22}{', '.join(texts)}"
    for mesh, rating in strength.meshes.items():
        if (scuffing := rating.scuffing) is not None and scuffing.risk is not None:
            told = ", ".join(f"{symbol} {value:.4g}" for symbol, value in scuffing.safeties.items())
            yield f"{f'scuffing {mesh}':<22}risk {scuffing.risk.value}: {told}"
    if strength.life is not None:
        life = strength.life
        text = "infinite" if math.isinf(life) else f"> {_LONGEST_LIFE:g} h" if life > _LONGEST_LIFE else f"{life:.4g} h"
        yield f"{'life':<22}{text}, with the required safeties"
    if verdict:
        yield f"{'strength':<22}{strength.verdict.removeprefix('strength ')}"


_WIDE = 130
"""Console width from which the column of sources fits."""

_LEAST = (7, 42, 9, 9, 9, 9, 8)
"""Least widths (characters) of all columns but the last."""

_TO_THE_RIGHT = (2, 3, 5, 6)
"""Columns of numbers, which are aligned to the right."""

_WORDS = (
    "ok, FAILED: gates, which decide. in band, OUTSIDE: information; how far it may be from ISO 6336 is set in [check] "
    "(root_band, stiffness_band, contact_band) and decides nothing. reached, BELOW: safeties by finite elements beside those "
    "required: the standard's decide."
)
_LOCAL = " below, ABOVE: the local pressure where a linear relief starts, beside the contact limit: no gate."


class _Line(NamedTuple):
    cells: tuple[str, ...]
    style: str = ""


def print_verdict(name: str, result: CheckResult) -> None:
    """The comparisons, gates first, what could not be evaluated, notices, and the verdict on numerics and strength."""
    from rich.console import Console
    from rich.text import Text

    console = Console(highlight=False)
    heading = _Line(("", "quantity", "computed", "reference", "unit", "deviation", "permitted", "source"), "bold")
    rows = [heading, *(_verdict_row(each) for each in result.comparisons)]
    if console.width < _WIDE:
        rows = [_Line(row.cells[:-1], row.style) for row in rows]
    lines = [*_aligned(rows), (_WORDS + _LOCAL * bool(result.relief_starts), "")]
    lines += [(line, "") for line in (*_losses(result), *_exposures(result), *_films(result))]
    lines += [(f"Not evaluated: {', '.join(quantities)}: {reason}", "yellow") for reason, quantities in _reasons(result)]
    for text, style in lines:
        # Soft wrap: a narrow window may break a line, but never cut a number.
        console.print(Text(translated(text), style=style), soft_wrap=True)
    echo_warnings(result.all_notices)
    line, style = translated(verdict_line(name, result)), "bold green" if result.passed else "bold red"
    console.print(Text(line, style=style), soft_wrap=True)


def verdict_line(name: str, result: CheckResult) -> str:
    """Return the conclusion of a check in one line."""
    from gearcad.jobs.strength import Check

    return Check().conclusion(name, result)


def _conclusion(result: CheckResult | MeshResults) -> str:
    """Return the conclusion of a check, or of those of a train's meshes."""
    from gearcad.jobs.train import MeshResults

    return result.conclusion if isinstance(result, MeshResults) else verdict_line(result.pair.name, result)


def _verdict_row(of: Comparison) -> _Line:
    """Return the row of a comparison; for a limit it shows how much of it is used."""
    gate = of.role is ComparisonRole.GATE
    good, bad = ("ok", "FAILED") if gate else ("reached", "BELOW") if of.least else ("in band", "OUTSIDE")
    if not gate and of.tolerance is None and not of.least:
        good, bad = "below", "ABOVE"
    word = good if of.passed else bad if gate or of.evaluated else "-"
    if of.deviation is None:
        deviation = "-"
    else:
        deviation = f"{100 * (1 + of.deviation):.4g} %" if of.tolerance is None else f"{100 * of.deviation:+.2f} %"
    limit = "at least" if of.least else "of limit"
    permitted = limit if of.tolerance is None else f"±{100 * of.tolerance:g} %"
    figures = ("-" if value is None else f"{value:.5g}" for value in (of.computed, of.reference))
    cells = (word, of.quantity, *figures, of.unit, deviation, permitted, of.source.split(":")[0])
    return _Line(cells, "" if of.passed else "bold red" if gate else "yellow")


def _losses(result: CheckResult) -> Iterator[str]:
    """Yield a line on the friction of the flanks, if there is any."""
    if (losses := result.losses) is None:
        return
    watts = "" if losses.mean_loss is None else f", {losses.mean_loss:.4g} W lost"
    factors = "" if losses.loss_factor is None else f"; H_V {losses.loss_factor:.4f} in the contact"
    if losses.ohlendorf is not None:
        factors += f", {losses.ohlendorf:.4f} by Ohlendorf"
    efficiency = f"efficiency of the mesh {100 * losses.efficiency:.3f} %{watts}{factors}"
    yield f"Friction: µ = {losses.coefficient:.4f}, {losses.words}; {efficiency}"


def _exposures(result: CheckResult) -> Iterator[str]:
    """Yield a line on the material exposure below the flanks of each gear, if its hardness over depth is known."""
    for role, of in result.exposure.items():
        found = f"{of.worst:.3f} at {of.worst_depth:.3g} mm"
        yield f"Material exposure of the {role.value}: {found}; line contact {of.line_contact:.3f} at {of.line_depth:.3g} mm"


def _films(result: CheckResult) -> Iterator[str]:
    """Yield the lines on temperature and oil film along the path of contact, if they are asked for."""
    if (film := result.film) is None:
        return
    hottest, thinnest = film.hottest, film.thinnest
    hot = f"contact {film.contact[hottest]:.1f} °C at {film.places[hottest]:.4g} mm from T1"
    yield f"Temperature: bulk {film.bulk:.1f} °C, flash up to {film.flash[hottest]:.1f} K, {hot}; µ = {film.friction:.4f}"
    least = f"{film.thickness[thinnest]:.3g} µm over Ra {film.roughness:.3g} µm at {film.places[thinnest]:.4g} mm from T1"
    safety = "" if film.safety is None else f"; S_lambda {film.safety:.3f}"
    yield f"Specific film thickness: least {film.specific[thinnest]:.3f}, {least}{safety}; unconfirmed"


def _reasons(result: CheckResult) -> Iterable[tuple[str, list[str]]]:
    """Return the reasons why quantities were not evaluated, each once, with the quantities."""
    found: dict[str, list[str]] = {}
    for each in result.comparisons:
        if not each.evaluated:
            found.setdefault(each.reason, []).append(each.quantity)
    return found.items()


def _aligned(rows: list[_Line]) -> list[tuple[str, str]]:
    """Return lines with their styles, columns as wide as their contents."""
    widths = [max(map(len, column)) for column in zip(*(row.cells for row in rows), strict=True)]
    widths[: len(_LEAST)] = map(max, widths, _LEAST)
    found = []
    for cells, style in rows:
        padded = (
            cell.rjust(width) if at in _TO_THE_RIGHT else cell.ljust(width)
            for at, (cell, width) in enumerate(zip(cells, widths, strict=True))
        )
        found.append(("  ".join(padded).rstrip(), style))
    return found


@click.command(short_help="Check the strength of SPEC's pair by finite elements.")
@spec_argument
@output_option
@click.option("--model", type=click.Choice(["2d", "3d", "section"]), help="Plane, solid, section.  [default: 3d if helical]")
@json_option
@quiet_option
@debug_option
def check(spec: Path, output: Path | None, model: str | None, as_json: bool, quiet: bool) -> None:
    """Check the pair of SPEC under its [load]: contact and root stress by finite elements, beside Hertz and ISO 6336.

    Writes check.json and report.html, and for solid bodies the stresses in the loaded teeth (stress_*.vtu). Exit status 1 if a
    gate is not passed or cannot be evaluated, or if the strength that is asked for is not passed or cannot be judged, as in
    `gearcad rate`: contact_limit and root_limit are further gates and replace none.

    [check] in SPEC sets model, body, torques and bands. Of a spline joint the contact of all its teeth, and mean stresses. Of a
    train of pairs each mesh under the train's load, with its files in a folder of its name; the worst mesh decides.
    """
    from gearcad.designs.design import read_tables
    from gearcad.jobs.strength import Check

    if "spline" in read_tables(spec)[0]:
        from gearcad.jobs.spline import CheckSpline

        if not perform(CheckSpline(), spec, output, print_spline, as_json=as_json, quiet=quiet).passed:
            click.get_current_context().exit(1)
        return

    result = perform(Check(model=model), spec, output, print_verdict, as_json=as_json, quiet=quiet)
    if as_json and not quiet:
        say(_conclusion(result), err=True)
    if not result.passed:
        click.get_current_context().exit(1)


def print_spline(name: str, result: SplineCheck) -> None:
    """Print the figures of a spline joint, its notices, and the verdict."""
    from gearcad.jobs.spline import CheckSpline, spline_lines

    say("\n".join(spline_lines(result)))
    echo_warnings(result.notices)
    say(CheckSpline().conclusion(name, result), bold=True)


_WIDTH = 110


def print_strength(name: str, result: StrengthRating | TrainStrength) -> None:
    """All of a rating, or of those of the meshes of a train, its notices, and the verdict."""
    from gearcad.jobs.strength import load_words
    from gearcad.rating.strength import StrengthRating

    if isinstance(result, StrengthRating):
        say("\n".join(strength_lines(result)))
    else:
        for mesh, rating in result.meshes.items():
            say("\n".join([f"{mesh}: {load_words(rating)}", *strength_lines(rating)]))
        say("\n".join(train_strength_lines(result, verdict=False)))
    echo_warnings(result.notices)
    colour = {True: "green", False: "red", None: "yellow"}[result.passed]
    say(strength_line(name, result), fg=None if os.environ.get("NO_COLOR") else colour, bold=True)


def strength_line(name: str, result: StrengthRating | TrainStrength | MeshResults) -> str:
    """Return the conclusion of a rating in one line."""
    from gearcad.jobs.strength import Rate
    from gearcad.jobs.train import MeshResults

    return result.conclusion if isinstance(result, MeshResults) else Rate().conclusion(name, result)


def strength_lines(rating: StrengthRating) -> Iterator[str]:
    """All but notices and verdict, line by line."""
    document, names = rating.to_dict(), tuple(rating.names)
    yield f"{document['standard']}, {rating.options.accuracy.value}"
    yield _row("", (*rating.gear_names, "required"))
    yield from _safeties(document, names)
    yield from _wrapped("spectrum", [rating.told_load], "; ")
    yield from _wrapped("scuffing", _scuffing(rating))
    for group, factors in rating.factors.items():
        yield from _wrapped(group.value, (_factor(symbol, value, names) for symbol, value in factors.items()))
    yield from _plastic(rating, document)
    yield from _wrapped("efficiency", _efficiency(rating))
    for words, key in (("assumed", "assumed"), ("unconfirmed", "verify")):
        yield from _wrapped(words, document[key], "; ")
    yield from _wrapped("not judged", _not_judged(document["not_judged"]), "; ")


def _efficiency(rating: StrengthRating) -> Iterator[str]:
    """Yield the efficiency of the mesh with what it goes by, if friction is known."""
    from gearcad.rating.friction import LAW_WORDS

    if (found := rating.efficiency) is None:
        return
    yield f"{100 * found.efficiency:.3f} %"
    if found.mean_loss is not None:
        yield f"{found.mean_loss:.4g} W lost"
    yield f"H_V {found.loss_factor:.4f}, Ohlendorf"
    yield f"µ {found.coefficient:.4f}, {LAW_WORDS[found.law]}"


def _not_judged(reasons: Mapping[str, str]) -> Iterator[str]:
    """Yield each reason once, with all quantities that it applies to."""
    for why in dict.fromkeys(reasons.values()):
        yield f"{', '.join(what for what, of in reasons.items() if of == why)}: {why}"


def _safeties(document: Mapping[str, Any], names: tuple[str, ...]) -> Iterator[str]:
    """Safety, stress, strength, torque and life, of flanks and roots."""
    for part, index in (("flank", "H"), ("root", "F")):
        required = document["required"][part]
        least = " / ".join(map(_text, required.values())) if isinstance(required, Mapping) else _text(required)
        yield _row(f"S_{index}, {part}", (*(_text(document["safety"][part][name]) for name in names), least))
        for symbol, words in ((f"sigma_{index}", "stress"), (f"sigma_{index}G", "strength")):
            yield _row(f"  {symbol}, {words} (MPa)", [_text(document["stresses"][symbol][name]) for name in names])
        yield _row("  permissible torque (N·m)", [_text(document["permissible_torque"][part][name]) for name in names])
        yield _row("  life at the required safety (h)", [_hours(document["life"][part][name]) for name in names])


def _plastic(rating: StrengthRating, document: Mapping[str, Any]) -> Iterator[str]:
    """Yield the lines of VDI 2736-2 for gears of plastic: heat, wear and deformation, a line for each quantity."""
    from gearcad.sheet.trains import OF_PLASTIC, plastic_quantities

    if found := plastic_quantities(rating, document):
        yield OF_PLASTIC
    for each in found:
        values = each.value.values() if isinstance(each.value, Mapping) else (each.value,)
        unit = f" ({each.symbol.unit})" if each.symbol.unit else ""
        doubt = ("unconfirmed",) if each.verify else ()
        yield _row(f"  {each.key.removeprefix('plastic.')}{unit}", (*map(_text, values), *doubt))


def _scuffing(rating: StrengthRating) -> Iterator[str]:
    found = rating.scuffing
    if found is None:
        return
    yield from (f"{symbol} {_text(value)}" for symbol, value in found.safeties.items())
    if found.risk is not None:
        yield f"risk {found.risk.value}"
    if found.reason:
        yield f"not judged: {found.reason}"


def _factor(symbol: str, value: Any, names: tuple[str, ...]) -> str:
    """One number, or those of both gears where they differ; nothing for what is not known."""
    if isinstance(value, Mapping):
        both = list(dict.fromkeys(_text(value[name]) for name in names))
        return f"{symbol} {' / '.join(both)}"
    return "" if value is None else f"{symbol} {_text(value)}"


def _row(words: str, cells: Iterable[str]) -> str:
    return f"{words:<34}" + "".join(f"{cell:>12}" for cell in cells)


def _wrapped(words: str, items: Iterable[str], between: str = "  ") -> Iterator[str]:
    told = map(translated, filter(None, items))
    text = between.join(item.replace(" ", "\0") if between == "  " else item for item in told)
    if text:
        lines = textwrap.wrap(text, _WIDTH - 16, break_long_words=False, break_on_hyphens=False)
        yield from (f"{words if not at else '':<16}{line}".replace("\0", " ") for at, line in enumerate(lines))


def _text(value: float | None) -> str:
    return "-" if value is None else f"{value:.4g}"


def _hours(value: float | str | None) -> str:
    """A life in hours; beyond all machines no digits are told."""
    if isinstance(value, float) and math.isfinite(value) and value > _LONGEST_LIFE:
        return f"> {_LONGEST_LIFE:.0e}".replace("e+0", "e")
    return value if isinstance(value, str) else _text(value)


@click.command(short_help="Rate SPEC's pair by ISO 6336: safeties, life, permissible torque.")
@spec_argument
@output_option
@json_option
@quiet_option
@debug_option
def rate(spec: Path, output: Path | None, as_json: bool, quiet: bool) -> None:
    """Rate the pair of SPEC under its [load] by ISO 6336 or DIN 3990: safeties of flanks and roots, life, permissible torque.

    Of a planetary train each mesh is rated, under what the planet carries that carries most. Of a train of pairs each mesh is
    rated under the train's load, with its files in a folder of its name; the worst mesh decides.

    [rating] in SPEC sets standard, accuracy, life, oil, shafts and required safeties; [material] what the gears bear, by group,
    quality and hardness of ISO 6336-5. What is not given is assumed and told; without its limit a flank or root is not judged.

    Writes rate.json and rate.html, of a train rate-MESH.html of each mesh. Exit status 0 if strength is
    passed, or not asked for: no endurance limit, local limit or quality of a material and no required_safety_* is given. Exit
    status 1 if a required safety is not reached, or if a flank, a root or the scuffing that is asked for cannot be judged.
    """
    from gearcad.jobs.strength import Rate

    with _blaming(spec):
        result = perform(Rate(), spec, output, print_strength, as_json=as_json, quiet=quiet)
    if as_json and not quiet:
        say(strength_line(result.name, result), err=True)
    if result.strength.falls_short:
        click.get_current_context().exit(1)


@contextmanager
def _blaming(spec: Path) -> Iterator[None]:
    """Turn an InputError into a SpecError that names the spec and the key: all inputs of a rating are in the spec."""
    from gearcad.jobs.strength import KEYS

    try:
        yield
    except OutputError:
        raise
    except InputError as error:
        key = KEYS.get(error.parameter, error.parameter)
        raise SpecError(f"{spec}: {type(error)(key, error.value, error.permitted, error.unit)}", key) from error


_ALL = "all"
_NONE = "-"


@click.command(short_help="Mesh stiffness of SPEC's pair by every method, side by side.")
@spec_argument
@click.option(
    "--method", "methods", multiple=True, metavar="NAME", help="One of them, or all; may be given again.  [default: all]"
)
@click.option("--positions", type=int, default=0, metavar="N", help="Over one base pitch.  [default: the method's own]")
@click.option("--fourier", "harmonics", type=int, default=0, metavar="N", help="Write the first N harmonics of each curve too.")
@output_option
@json_option
@quiet_option
@debug_option
def stiffness(
    spec: Path,
    methods: tuple[str, ...],
    positions: int,
    harmonics: int,
    output: Path | None,
    as_json: bool,
    quiet: bool,
) -> None:
    """Mesh stiffness of the pair of SPEC under its [load] over one base pitch, by every method or those of --method:

    \b
    potential-energy   beam of the true tooth, Sainsot's foundation
    weber-banaschek    beam, half-plane below it, Hertz under the load
    iso6336            ISO 6336-1 Method B: the mean
    strain-energy      energy of FE bodies (Pedersen and Jorgensen)
    plane-stress       FE contact of a plane section
    plane-strain
    3d                 FE contact of solid bodies: takes a minute

    Writes stiffness.json, stiffness.csv (the curves) and stiffness.html. Bodies are held where [check] in SPEC says, or in
    their bores. A method that cannot treat the pair is left out, with its reason.
    """
    from gearcad.core.errors import ParameterError
    from gearcad.jobs.strength import Stiffness
    from gearcad.stiffness import METHODS

    for name in methods:
        if name not in (_ALL, *METHODS):
            raise ParameterError("method", name, f"must be one of {', '.join((_ALL, *METHODS))}")
    wanted = tuple(METHODS) if not methods or _ALL in methods else tuple(dict.fromkeys(methods))
    job = Stiffness(methods=wanted, positions=positions, fourier=harmonics)
    perform(job, spec, output, _show, as_json=as_json, quiet=quiet)


def _show(_name: str, comparison: StiffnessComparison) -> None:
    """The methods, a line each, then what to know of them."""
    from gearcad.stiffness import METHODS

    say("\n".join(_table(comparison)))
    echo_warnings(comparison.notices)
    for name, reason in comparison.left_out.items():
        say(f"{METHODS[name].title}: left out: {reason}")


def _table(comparison: StiffnessComparison) -> list[str]:
    """The methods, a line each."""
    from gearcad.stiffness import METHODS

    heads = ("mean", "max", "min", "at C", "c_γβ", "c_γα", "one pair", "to 3d")
    units = ("N/µm", "N/µm", "N/µm", "N/µm", "N/(mm µm)", "N/(mm µm)", "N/µm", "%")
    lines = [_line("secant, over one base pitch", heads), _line("", units)]
    for cycle in comparison.cycles:
        course = (_NONE,) * 3 if cycle.mean_only else (cycle.maximum, cycle.minimum, cycle.pitch_point)
        deviation = comparison.deviation(cycle)
        cells = (
            cycle.mean,
            *course,
            cycle.secant_per_width,
            cycle.tangent_per_width,
            _NONE if cycle.single_stiffness is None else cycle.single_stiffness,
            _NONE if deviation is None else f"{100 * deviation:+.1f}",
        )
        lines.append(_line(METHODS[cycle.method].title, [cell if isinstance(cell, str) else f"{cell:.5g}" for cell in cells]))
    lines.append("c_γβ: mean secant, c_γα: mean tangent stiffness per face width; 'to 3d': of the mean from that of 3d")
    return lines


def _line(words: str, cells: tuple[str, ...] | list[str]) -> str:
    return f"{words:<28}" + "".join(f"{cell:>10}" for cell in cells)


@click.command(short_help="Propose tip relief and crowning for SPEC's load.")
@spec_argument
@click.option("-o", "--output", type=click.Path(path_type=Path), metavar="FILE", help="[default: NAME-modified.toml here]")
@click.option("--torque", type=float, metavar="N·m", help="On the pinion.  [default: that of the load, times its factor]")
@click.option("--pressure", type=float, metavar="MPa", help="Most contact pressure.  [default: the material's limit]")
@click.option("--shape", metavar="SHAPE", help="Of the tip relief: linear or parabolic.  [default: the better one]")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON document and nothing else.")
@click.option("--quiet", is_flag=True, help="No progress and no warnings on the screen.")
@click.option("--force", is_flag=True, help="Replace a file that exists.")
@debug_option
def modify(
    spec: Path,
    output: Path | None,
    torque: float | None,
    pressure: float | None,
    shape: str | None,
    as_json: bool,
    quiet: bool,
    force: bool,
) -> None:
    """Propose tip relief on both gears and lead crowning on the pinion for the load of SPEC, and write the modified spec.

    The transmission error is made as small as it gets with the contact pressure kept below --pressure and, if possible, the
    edges of the tips out of contact. By default the bound is the lower end of the material's contact_limit or, where no
    modification gets there, 5 % more than without. Against a misalignment of [mounting] the pinion's helix angle is modified
    too.
    """
    from gearcad.core.errors import as_choice
    from gearcad.core.output import json_text, staged_files
    from gearcad.designs import read_spec
    from gearcad.geometry import ReliefShape
    from gearcad.jobs.modify import Modify, modified_spec

    wanted = None if shape is None else as_choice("shape", shape, ReliefShape)
    job = Modify(torque=torque, pressure=pressure, shape=wanted)
    design = read_spec(spec)
    path = output or Path(f"{design.name}-modified.toml")
    require_new_file(path, force)
    with job_progress(shown=not quiet) as progress:
        proposal = job.run(design, progress)
    text = modified_spec(spec.read_bytes().decode("utf-8-sig"), proposal)
    with staged_files(path.parent) as staging:
        (staging / path.name).write_text(text, encoding="utf-8", newline="")
    if as_json:
        head = {"kind": "modify", "name": proposal.name, "gearcad": __version__, "output": str(path)}
        click.echo(json_text(head | job.complete_document(proposal)), nl=False)
    else:
        click.echo("\n".join([*_lines(proposal), str(path)]))
    if not quiet:
        echo_warnings((*job.design_notices(design), *proposal.notices), err=True)


def _on_shafts(proposal: Proposal) -> list[tuple[str, str, float, float]]:
    """The row of K_Hbeta on the shafts, where the design has any."""
    lead = proposal.lead
    return [] if lead is None else [("face load factor K_Hβ on the shafts", "", lead.K_Hbeta_before, lead.K_Hbeta_after)]


def _lines(proposal: Proposal) -> list[str]:
    """The proposal, and what it does to the mesh."""
    lines = [f"{proposal.design.name} at {proposal.torque:g} N·m, {proposal.variants} variants"]
    for key, value in proposal.changes.items():
        if key != "pair.name":
            lines.append(f"  {key} = {value}{'' if isinstance(value, str) else ' ' + proposal.notes[key]}")
    before, after = proposal.before, proposal.after
    rows: list[tuple[str, str, float, float]] = [
        (
            "transmission error, peak to peak",
            "µm",
            before.transmission_error_peak_to_peak,
            after.transmission_error_peak_to_peak,
        )
    ]
    harmonics = zip(before.transmission_error_harmonics, after.transmission_error_harmonics, strict=True)
    rows += [(f"  harmonic {number}", "µm", *pair) for number, pair in enumerate(harmonics, 1)]
    rows += [
        ("contact pressure", "MPa", before.contact_pressure, after.contact_pressure),
        ("root stress, pinion", "MPa", before.root_tension_pinion, after.root_tension_pinion),
        ("root stress, wheel", "MPa", before.root_tension_wheel, after.root_tension_wheel),
        ("face load factor K_Hβ", "", before.face_load_factor, after.face_load_factor),
        *_on_shafts(proposal),
        ("positions with a tip edge in contact", "", before.edge_positions, after.edge_positions),
    ]
    lines.append(f"{'':<42}{'before':>10}{'after':>10}")
    lines += [f"{words:<42}{one:>10.4g}{other:>10.4g} {unit}".rstrip() for words, unit, one, other in rows]
    over = after.contact_pressure / proposal.bound - 1
    beyond = f"; the proposal is {100 * over:.2g} % above it" if over > 0 else ""
    lines.append(f"bound of the contact pressure: {proposal.bound:.4g} MPa{beyond}")
    lines.append(f"figures of solid bodies, as gearcad check --model {proposal.model.value} has them")
    if (lead := proposal.lead) is not None:
        lines.append(f"K_Hβ on the shafts by slices, f_sh = {lead.f_sh:.3g} µm, f_ma = {lead.f_ma:.3g} µm")
    lines.append("transmission error, peak to peak, under other conditions")
    for each in proposal.robustness:
        of = each.condition
        words = f"  {of.torque:g} N·m"
        words += f", misaligned by {of.misalignment:+g} µm more" if of.misalignment else ""
        words += f", pitch error of {of.pitch_error:g} µm" if of.pitch_error else ""
        lines.append(f"{words:<42}{each.before:>10.4g}{each.after:>10.4g} µm")
    if (found := proposal.loads) is not None:
        lines.append("transmission error, peak to peak, under the loads")
        each_load = zip(found.loads.torques, found.loads.weights, found.before, found.after, strict=True)
        lines += [f"{f'  {at:g} N·m, weight {of:g}':<42}{one:>10.4g}{other:>10.4g} µm" for at, of, one, other in each_load]
        one, other = found.statistics
        lines.append(f"{f'  {found.loads.statistic.value} of all, made least':<42}{one:>10.4g}{other:>10.4g} µm")
    return lines
