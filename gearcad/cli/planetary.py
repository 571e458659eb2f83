"""Command `planetary`: a train at its load, or tooth numbers for a ratio."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from gearcad.cli.group import debug_option, require_new_file
from gearcad.cli.job import echo_warnings, json_option, output_option, perform_on, quiet_option
from gearcad.cli.language import say
from gearcad.cli.strength import train_strength_lines
from gearcad.core.errors import ParameterError, as_choice
from gearcad.core.records import grouped, is_assumed, joined

if TYPE_CHECKING:
    from gearcad.dynamics.planetary.planetary_response import PlanetaryResponse
    from gearcad.dynamics.planetary.planetary_result import PlanetaryStudy
    from gearcad.dynamics.response.chart_findings import GreatestFactor
    from gearcad.jobs.planetary import Studied
    from gearcad.planetary.search import PlanetarySet, SearchResult
    from gearcad.planetary.tooth_numbers import SearchTask


Command = TypeVar("Command", bound=Callable[..., Any])

_OPTIONS: tuple[tuple[str, dict[str, Any]], ...] = (
    ("--ratio", {"type": float, "metavar": "I", "help": "Search: speed of the input over that of the output."}),
    ("--type", {"metavar": "TYPES", "help": "A sun and ring, B with stepped planets, C two suns, D two rings.  [default: A]"}),
    ("--module", {"type": float, "metavar": "MM", "help": "Normal module; needed for a search."}),
    ("--module-2", {"type": float, "metavar": "MM", "help": "That of the second mesh of stepped planets."}),
    ("--planets", {"metavar": "N[:N]", "help": "How many planets.  [default: 3:5]"}),
    ("--fixed", {"metavar": "MEMBER", "help": "sun, ring, carrier, sun_2 or ring_2; so for --in and --out."}),
    ("--in", {"metavar": "MEMBER", "help": "The input."}),
    ("--out", {"metavar": "MEMBER", "help": "The output."}),
    ("--tolerance", {"type": float, "metavar": "%", "help": "Most deviation of the ratio.  [default: 1]"}),
    ("--teeth", {"metavar": "Z[:Z]", "help": "Of suns and planets.  [default: 17:100]"}),
    ("--ring-teeth", {"metavar": "Z[:Z]", "help": "Of rings.  [default: 30:200]"}),
    ("--diameter", {"type": float, "metavar": "MM", "help": "Most diameter over all teeth."}),
    ("--helix-angle", {"type": float, "metavar": "DEG", "help": "Of the first sun or ring.  [default: 0]"}),
    ("--face-width", {"type": float, "metavar": "MM", "help": "Of all gears.  [default: 10 modules]"}),
    ("--tip-distance", {"type": float, "metavar": "MM", "help": "Least between planets.  [default: 1 module]"}),
    ("--mesh-efficiency", {"type": float, "metavar": "ETA", "help": "Of a mesh, to compare sets.  [default: 0.99]"}),
    ("--count", {"type": int, "metavar": "N", "help": "Most sets that are listed.  [default: 20]"}),
)

_NAMES = {"in": "input", "out": "output", "type": "types"}
"""Fields of the task that options call otherwise."""

_RANGES = ("planets", "teeth", "ring_teeth")

_COUNT = 20
_MOST_COUNT = 1000


def search_options(command: Command) -> Command:
    """The options of a search."""
    for name, how in reversed(_OPTIONS):
        command = click.option(name, name.lstrip("-").replace("-", "_"), **how)(command)
    force = click.option("--force", is_flag=True, help="Search: replace a table that exists.")
    return force(command)


def require_no_search(given: Mapping[str, Any], *, force: bool) -> None:
    """Raise ParameterError for an option of a search where no ratio is wanted."""
    for name, value in {**given, "force": force or None}.items():
        if value is not None:
            raise ParameterError(name, value, "applies to a search only: needs --ratio")


def search_sets(given: Mapping[str, Any], output: Path | None, *, force: bool, as_json: bool, quiet: bool) -> None:
    """Search for what options ask for; show it, or print its document, and write the design table if there is a place.

    Ends the command with status 1 where nothing is found.
    """
    from gearcad.core.output import json_text
    from gearcad.designs.spec_writers import write_found
    from gearcad.jobs.job import with_summary
    from gearcad.planetary.search import search

    task, count = _task(given), _COUNT if given["count"] is None else given["count"]
    if not 1 <= count <= _MOST_COUNT:
        raise ParameterError("count", count, f"must be a whole number from 1 to {_MOST_COUNT}")
    if output is not None:
        require_new_file(output, force)
        if output.suffix.lower() != ".csv":
            raise ParameterError("output", str(output), "must end in .csv: a search writes a design table")
    result = search(task, count)
    if output is not None and result.found:
        write_found(result, output)
    if as_json:
        click.echo(json_text(with_summary(result.to_dict())), nl=False)
    elif result.found:
        say("\n".join(_table(result)))
    if not result.found:
        say(_nothing(result), err=True)
        click.get_current_context().exit(1)
    if not quiet:
        say("\n".join(_remarks(result, output)), err=True)
    if output is not None and not as_json:
        click.echo(output)


# ---------------------------------------------------------------------- what is asked


def _task(given: Mapping[str, Any]) -> SearchTask:
    """The task of the options that are given. Raises ParameterError."""
    from gearcad.planetary.members import SetType
    from gearcad.planetary.tooth_numbers import SearchTask

    if given.get("module") is None:
        raise ParameterError("module", None, "must be given, in mm, with --ratio")
    fields: dict[str, Any] = {}
    for name, value in given.items():
        if value is None or name == "count":
            continue
        field = _NAMES.get(name, name)
        if field == "types":
            value = tuple(as_choice("type", each.strip().upper(), SetType) for each in value.split(","))
        elif field in _RANGES:
            value = _ends(name, value)
        fields[field] = value
    try:
        return SearchTask(**fields)
    except ParameterError as error:
        called = {field: name for name, field in _NAMES.items()}
        raise ParameterError(called.get(error.parameter, error.parameter), error.value, error.permitted, error.unit) from error


def _ends(name: str, text: str) -> tuple[int, int]:
    """Least and most of "3:5", or twice the one of "3"."""
    try:
        ends = tuple(int(each) for each in text.split(":"))
    except ValueError:
        ends = ()
    if len(ends) not in (1, 2):
        raise ParameterError(name, text, "must be a whole number or two, the least and the most: 3:5")
    return ends[0], ends[-1]


# ---------------------------------------------------------------------- what is shown


def _table(result: SearchResult) -> Iterator[str]:
    """A line for each set, under a heading, and what their members do."""
    for kind in dict.fromkeys(candidate.kind for candidate in result.found):
        roles = result.task.roles(kind)
        gears = ", ".join(next(each for each in result.found if each.kind is kind).teeth)
        yield f"type {kind.value}: {gears}; input {roles.input}, output {roles.output}, fixed {roles.fixed}"
    rows = [_HEADING, *(_row(candidate) for candidate in result.found)]
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        name, *numbers = row
        cells = (f"{cell:>{width}}" for cell, width in zip(numbers, widths[1:], strict=True))
        yield "  ".join((f"{name:<{widths[0]}}", *cells)).rstrip()


_HEADING = ("set", "ratio", "off %", "diameter mm", "a mm", "N", "q", "z mod N", "gcd", "efficiency", "error share")


def _row(each: PlanetarySet) -> tuple[str, ...]:
    return (
        each.name,
        f"{each.ratio:.6g}",
        f"{each.deviation:+.3f}" if each.deviation else "0",
        f"{each.diameter:.2f}",
        f"{each.centre_distance:.3f}",
        str(each.planets),
        str(each.positions),
        " ".join(map(str, each.phases)),
        " ".join(map(str, each.common)),
        f"{each.efficiency:.4f}",
        f"{each.error_share:.2f}",
    )


def _remarks(result: SearchResult, output: Path | None) -> Iterator[str]:
    """Yield lines about further sets, sets that could not be made, the columns, and the next command."""
    if result.left:
        yield f"{grouped(result.left)} more meet all conditions: --count"
    if result.unmade:
        yield f"{len(result.unmade)} could not be made; the first: {result.unmade[0]}"
    yield "a centre distance, N planets, on q places where their teeth fit; z mod N is 0 where they are in phase; gcd 1 is a"
    yield "hunting tooth; error share: of the load that an error of one planet brings, what is left while a central floats"
    yield "No set has backlash yet: planetary.tooth_thinning is 0 in the table"
    yield f"Next: gearcad batch {output}" if output is not None else "-o FILE.csv writes a design table for gearcad batch"


def _nothing(result: SearchResult) -> str:
    """One line: which condition removed what, and the ratios that are nearest."""
    kinds = ", ".join(kind.value for kind in result.task.types)
    took = ", ".join(f"{grouped(number)} by {name}" for name, number in result.removed.items() if number)
    text = f"No set of type {kinds} has ratio {result.task.ratio:g} within {result.task.tolerance:g} %"
    text += f": of {grouped(result.considered)} within the limits, removed {took}" if took else ": none is within the limits"
    if result.unmade:
        text += f", and {len(result.unmade)} could not be made: {result.unmade[0]}"
    nearest = " and ".join(f"{ratio:.6g}" for ratio in result.nearest)
    return text + (f"; nearest ratios {nearest}" if nearest else "")


_MOST_FREQUENCIES = 6


@click.command(short_help="Speeds, torques, sharing, stiffness, modes of SPEC's planetary train; sets for a --ratio.")
@click.argument("spec", type=click.Path(path_type=Path), required=False)
@click.option("--response", is_flag=True, help="The loads of the meshes over speed, too: may take minutes.")
@output_option
@json_option
@quiet_option
@search_options
@debug_option
def planetary(
    spec: Path | None, response: bool, output: Path | None, as_json: bool, quiet: bool, force: bool, **wanted: Any
) -> None:
    """What comes of the planetary train of SPEC under its [load]: speeds and torques of its members, with losses; forces on
    teeth and pins; phases of the meshes; how planets share the load with the errors that are given; torsional stiffness of
    the output; natural frequencies and modes; safeties of all gears, where [material] and [rating] let them be judged.

    Writes planetary.html with the scheme and pictures of all, planetary.json, data.json, and a spec for each mesh, such as
    sun-planet.toml, which every command of pairs takes: `gearcad check`, `gearcad stiffness` and the others. What cannot be
    had without a load, a speed, a stiffness or a mass is left out, with its reason.

    Of a gearbox of several sets ([[planetary.set]], joined members, [planetary.states]) it tells the ratio, the efficiency
    and the torques of brakes and clutches of each state.

    Without SPEC, and with --ratio and --module, it searches instead: tooth numbers of sets with that ratio that can be
    assembled and mesh, best first: by deviation of the ratio, diameter, planets out of phase, hunting teeth, efficiency.
    -o FILE.csv writes them as a design table.

    \b
    gearcad planetary --ratio 5.2 --module 2 --planets 3:5
    gearcad planetary --ratio -30 --module 2 --type C,D --teeth 17:60 -o sets.csv
    """
    from gearcad.core.errors import ParameterError
    from gearcad.designs.keys import DesignKind
    from gearcad.designs.reader import read_spec
    from gearcad.jobs.planetary import Planetary

    if wanted["ratio"] is not None:
        if spec is not None:
            raise ParameterError("ratio", wanted["ratio"], f"searches without a spec: leave out {spec}")
        search_sets(wanted, output, force=force, as_json=as_json, quiet=quiet)
        return
    require_no_search(wanted, force=force)
    if spec is None:
        raise ParameterError("spec", None, "must be given, a file that `gearcad new planetary` begins; or --ratio, to search")
    design = read_spec(spec)
    if design.kind is DesignKind.GEARBOX:
        from gearcad.cli.gearbox import show_gearbox
        from gearcad.jobs.gearbox import PlanetaryGearbox

        perform_on(PlanetaryGearbox(), design, output, show_gearbox, as_json=as_json, quiet=quiet)
        return
    perform_on(Planetary(response=response), design, output, _show, as_json=as_json, quiet=quiet)


def _show(_name: str, found: Studied) -> None:
    say("\n".join(_lines(found.study)))
    echo_warnings(joined(found.study.notices))


def _lines(study: PlanetaryStudy) -> Iterator[str]:
    """Yield the results of a study in a few lines."""
    train = study.train
    teeth = " / ".join(str(gear.teeth) for gear in train.gears.values())
    ratio = "no fixed member" if train.ratio is None else f"i = {train.ratio:.7g}"
    yield f"{'set':<22}type {train.set_type.value}, {train.planets} planets, z = {teeth}, {ratio}"
    yield from _member_lines(study)
    if study.flow is not None:
        yield f"{'efficiency':<22}{_efficiency(study)}; {study.flow.circulation}"
    yield f"{'planets at':<22}{', '.join(f'{angle:.6g}' for angle in train.angles)} deg of {train.positions} places"
    for name, phases in study.phases.items():
        yield f"{f'phases {name}':<22}{', '.join(f'{each:.4f}' for each in phases.relative)} base pitches"
    yield from _force_lines(study)
    yield from _stiffness_lines(study)
    yield from _frequency_lines(study)
    if study.rating is not None:
        yield from train_strength_lines(study.rating.strength)


def _member_lines(study: PlanetaryStudy) -> Iterator[str]:
    train, flow, turning = study.train, study.flow, study.turning
    if study.speeds is None:
        return
    roles = {train.input: "input", train.output: "output", train.fixed: "fixed"}
    yield f"{'member':<22}{'rpm':>12}{'N·m':>12}{'W':>12}"
    for name in study.speeds.members:
        speed = None if turning is None else turning.members[name]
        torque = None if flow is None else flow.torques.get(name)
        power = None if flow is None or turning is None else flow.powers.get(name)
        cells = _cell(speed, 6) + _cell(torque, 5) + _cell(power, 5)
        words = filter(None, (roles.get(name), "" if train.fixed else _power_words(power)))
        yield f"{name:<22}{cells}  {', '.join(words)}".rstrip()
    if turning is not None:
        yield f"{'planet':<22}{turning.planet:>12.6g}{'':>24}  {turning.planet_relative:.6g} rpm on its pin"


def _cell(value: float | None, digits: int) -> str:
    """A number in its column, or "-" where there is none."""
    return f"{'-':>12}" if value is None else f"{value:>12.{digits}g}"


def _power_words(power: float | None) -> str:
    """Return whether a member drives or is driven, as words, from its power; "" without power.

    In a differential this depends on the speeds.
    """
    return "" if not power else "drives" if power > 0 else "is driven"


def _efficiency(study: PlanetaryStudy) -> str:
    flow = study.flow
    if flow is None or flow.efficiency is None:
        return "-"
    if is_assumed(flow.load.mesh_efficiency):
        return "not known: mesh_efficiency is not given, and 1 (no losses) is assumed"
    forth = f"{100 * flow.efficiency:.4g} %"
    if flow.efficiency_back is None:
        return forth
    if flow.efficiency <= 0:
        forth = "locks itself"
    return forth + (", locks itself backwards" if flow.self_locking else f", {100 * flow.efficiency_back:.4g} % backwards")


def _force_lines(study: PlanetaryStudy) -> Iterator[str]:
    if study.forces is None:
        return
    for name, force in study.forces.meshes.items():
        yield f"{f'force {name}':<22}{force.normal:.5g} N along the line of action, of each planet"
    pin = study.forces.pin
    away = pin.radial + (pin.centrifugal or 0.0)
    yield f"{'force on a pin':<22}{pin.size:.5g} N: {away:.5g} outwards, {pin.tangential:.5g} along the rotation"


def _stiffness_lines(study: PlanetaryStudy) -> Iterator[str]:
    if study.stiffness is not None:
        means = ", ".join(f"{name} {mesh.mean:.5g}" for name, mesh in study.stiffness.items())
        method = next(iter(study.stiffness.values())).cycle.method
        yield f"{'mesh stiffness':<22}{means} N/µm mean secant ({method})"
    if study.sharing is not None:
        shares = ", ".join(f"{share:.4f}" for share in study.sharing.greatest_shares)
        published = ", ".join(f"{each.factor:g} {each.source}" for each in study.sharing.published)
        yield f"{'load sharing':<22}K_gamma {study.sharing.mesh_load_factor:.4f}, greatest shares {shares} ({published})"
    if (torsion := study.torsion) is not None:
        parts = sorted(torsion.contributions, key=lambda each: -each.share)
        shares = ", ".join(f"{100 * each.share:.3g} % {each.name}" for each in parts if each.share >= 0.01)
        yield f"{'torsional stiffness':<22}{torsion.stiffness:.5g} N·m/rad at {study.train.output}: {shares}"


def _factor_words(response: PlanetaryResponse) -> str:
    """Greatest factors at the load's speed and where the train runs under load."""
    at_load, most, where = response.at_load, response.greatest_in_operation, response.operating.heading
    found = [
        f"{each.factor:.4g}, of {each.mesh} at {each.speed:.5g} rpm of {response.train.input}{_lasting(each)}"
        for each in (at_load, most)
        if each is not None
    ]
    if len(found) == 1 or found[0] == found[1]:
        return f"{where}at most {found[-1]}"
    return f"{found[0]}; {where}at most {found[1]}"


def _lasting(factor: GreatestFactor) -> str:
    return "" if factor.stable else ", of a motion that does not last: greater loads can follow"


def _frequency_lines(study: PlanetaryStudy) -> Iterator[str]:
    if study.modes is None:
        return
    above = [family for family in study.modes.families if family.frequency > 0]
    few = f"; first {_MOST_FREQUENCIES} of {len(above)}" if len(above) > _MOST_FREQUENCIES else ""
    listed = ", ".join(
        f"{family.frequency:.5g} {family.kind.value}{f' ({family.multiplicity})' if family.multiplicity > 1 else ''}"
        for family in above[:_MOST_FREQUENCIES]
    )
    yield f"{'natural frequencies':<22}{listed} Hz{few}"
    if study.campbell is not None:
        speeds = dict.fromkeys(f"{each.speed:.5g}" for each in study.campbell.excited)
        met = ", ".join(list(speeds)[:_MOST_FREQUENCIES])
        few = f"; first {_MOST_FREQUENCIES} of {len(speeds)}" if len(speeds) > _MOST_FREQUENCIES else ""
        yield f"{'resonances':<22}{met or 'none'} rpm of {study.train.input}, up to {study.campbell.highest_speed:.6g}{few}"
    if study.response is not None:
        yield f"{'dynamic load factor':<22}{_factor_words(study.response)}"
