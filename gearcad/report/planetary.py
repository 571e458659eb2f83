"""Report of a planetary train, section by section."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from functools import partial
from itertools import chain, count
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from gearcad.core.records import Floats, Role, texts
from gearcad.core.symbols import STRENGTH_FACTORS
from gearcad.dynamics.planetary.gyroscopic_modes import GyroscopicModes
from gearcad.dynamics.planetary.load_sharing import LoadSharing
from gearcad.dynamics.planetary.planar_model import Spring, SpringKind
from gearcad.dynamics.planetary.planetary_modes import ModeFamily, PlanetaryCampbell, PlanetaryModes
from gearcad.dynamics.planetary.planetary_response import PlanetaryResponse
from gearcad.dynamics.planetary.planetary_statics import TorsionalStiffness
from gearcad.dynamics.planetary.planetary_strength import TrainRating, TrainStrength
from gearcad.dynamics.planetary.quasi_static_run import Running
from gearcad.planetary import PlanetaryTrain
from gearcad.plots.paper import FIGURE_INCHES, short
from gearcad.plots.planetary import (
    front_inches,
    phases_inches,
    plot_front,
    plot_ladder,
    plot_phases,
    plot_sharing,
    plot_torsion,
    stage_gear,
    torsion_inches,
)
from gearcad.plots.planetary_scheme import plot_scheme, scheme_inches
from gearcad.plots.planetary_vibration import (
    CAMPBELL_INCHES,
    GYROSCOPIC_INCHES,
    MOST_MODES,
    RESPONSE_INCHES,
    RUNNING_INCHES,
    highest_drawn,
    modes_inches,
    plot_gyroscopic,
    plot_modes,
    plot_response,
    plot_running,
    plot_train_campbell,
    shown_families,
    shown_pitches,
)
from gearcad.rating.load_factors import LOAD_FACTORS
from gearcad.rating.nominal_rating import Rating
from gearcad.rating.strength import FactorGroup, StrengthRating
from gearcad.report.document import ReportFigure, ReportRow, figure_address, page_html, sentences, written
from gearcad.report.dynamics_tables import WordTable
from gearcad.report.planetary_tables import (
    assembly_rows,
    force_table,
    gear_table,
    harmonic_table,
    mesh_table,
    phase_table,
    pin_rows,
    power_rows,
    speed_table,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from gearcad.dynamics.planetary.planetary_result import PlanetaryStudy


class ReportTable(NamedTuple):
    """A table with a title and a note: of quantities in `rows`, or any `grid`.

    `symbols`: an underscore in a head begins an index; else it is that of a name.
    """

    title: str
    rows: list[ReportRow] | None = None
    grid: WordTable | None = None
    note: str = ""
    symbols: bool = False


class ReportSection(NamedTuple):
    """Sentences, tables and figures under one title."""

    title: str
    words: tuple[str, ...] = ()
    tables: tuple[ReportTable, ...] = ()
    figures: tuple[ReportFigure, ...] = ()


def said(macro: str, *values: object) -> str:
    """Return the text that a macro of the captions makes of values."""
    return sentences("captions_planetary.txt", macro, *values)


def figure(title: str, draw: Callable[[Figure], object], inches: tuple[float, float], caption: str) -> ReportFigure:
    """A picture with its caption."""
    return ReportFigure(title, figure_address(draw, "svg", inches), caption)


def on_axes(draw: Callable[..., object]) -> Callable[[Figure], object]:
    """Return a function that draws on a figure, from one that draws on axes."""
    return lambda of: draw(ax=of.subplots())


def sections_of_build(study: PlanetaryStudy) -> Iterator[ReportSection]:
    """Scheme, gears, assembly."""
    train, flow = study.train, study.flow
    draw = on_axes(partial(plot_scheme, train, flow=flow))
    scheme = figure("Scheme", draw, scheme_inches(train, flow), said("scheme", train, flow))
    yield ReportSection("Scheme", figures=(scheme,))
    speeds = study.speeds
    turning = {} if speeds is None else {**speeds.members, "planet": speeds.planet}
    front = partial(plot_front, train, study.pose, turning)
    yield ReportSection(
        "Gears",
        tables=(
            ReportTable("", grid=gear_table(train), note=said("gear_note"), symbols=True),
            ReportTable("Meshes", grid=mesh_table(train), note=said("mesh_note"), symbols=True),
        ),
        figures=(figure("In mesh", front, front_inches(train), said("front", train, turning)),),
    )
    yield ReportSection("Assembly", words=(said("assembly", train),), tables=(ReportTable("", rows=assembly_rows(train)),))


def sections_of_load(study: PlanetaryStudy) -> Iterator[ReportSection]:
    """Speeds and torques, power, phases, forces: those that are known."""
    train, speeds, flow = study.train, study.speeds, study.flow
    if speeds is not None:
        lever = figure(
            "Lever of the speeds",
            on_axes(partial(plot_ladder, train, speeds.members, speeds.planet, "rpm")),
            (6.6, 3.7),
            said("ladder", train),
        )
        yield ReportSection(
            "Speeds and torques",
            tables=(ReportTable("", grid=speed_table(train, speeds, flow, "rpm"), note=said("speed_note", train, flow)),),
            figures=(lever,) if study.turning is not None else (),
        )
    if flow is not None:
        yield ReportSection(
            "Power", words=(said("power", train, flow),), tables=(ReportTable("", rows=power_rows(train, flow)),)
        )
    yield _phases(study)
    if study.forces is not None:
        yield ReportSection(
            "Forces",
            words=(said("forces", train),),
            tables=(ReportTable("Meshes", grid=force_table(study.forces)), ReportTable("One pin", rows=pin_rows(study.forces))),
        )


def _phases(study: PlanetaryStudy) -> ReportSection:
    train, phases, stiffness = study.train, study.phases, study.stiffness
    words = tuple(said("phase_words", name, each.relative) for name, each in phases.items())
    picture = figure(
        "Phases",
        partial(plot_phases, train, phases, stiffness),
        phases_inches(train, stiffness),
        said("phases", train, stiffness),
    )
    table = ReportTable("", grid=phase_table(train, phases), note=said("phase_note"))
    sums = ReportTable("What their harmonics do", grid=harmonic_table(train, phases), note=said("harmonic_sum_note"))
    return ReportSection("Phases of the meshes", tuple(filter(None, words)), (table, sums), (picture,))


_ROUNDING = 1e-9
"""Greatest rounding error of shares, µm and arc seconds."""


def sections_of_bending(study: PlanetaryStudy) -> Iterator[ReportSection]:
    """Load sharing, torsional stiffness, the run: those that are known."""
    if study.sharing is not None:
        yield _sharing(study.sharing)
    if study.torsion is not None:
        yield _torsion(study.torsion)
    if study.running is not None:
        yield _running(study.running)


def _sharing(sharing: LoadSharing) -> ReportSection:
    picture = figure("Load sharing", on_axes(partial(plot_sharing, sharing)), FIGURE_INCHES, said("sharing", sharing))
    return ReportSection(
        "Load sharing",
        words=(said("sharing_words", sharing),),
        tables=(
            ReportTable("", grid=_share_table(sharing)),
            ReportTable("Mesh load factor", rows=_factor_rows(sharing)),
            ReportTable("Where members go", grid=_place_table(sharing), note=said("place_note")),
        ),
        figures=(picture,),
    )


def _share_table(sharing: LoadSharing) -> WordTable:
    """Shares of the planets, and what their meshes and pins carry at most."""
    first, second = sharing.meshes
    heads = ("planet", "share", "least", "greatest", f"{first}, at most N", f"{second}, at most N", "pin, at most N")
    rows = []
    for planet in range(len(sharing.shares)):
        shares = (sharing.shares[planet], sharing.least_shares[planet], sharing.greatest_shares[planet])
        forces = (*(float(loads.greatest[planet]) for loads in sharing.meshes.values()), float(sharing.pins.greatest[planet]))
        rows.append((str(planet + 1), *(f"{share:.4f}" for share in shares), *map(short, forces)))
    return WordTable(heads, rows)


def _factor_rows(sharing: LoadSharing) -> list[ReportRow]:
    """K_gamma as computed and as published."""
    rows = [
        ReportRow(
            "computed here", "K_γ", (f"{sharing.mesh_load_factor:.4f}",), "", "the greatest share of a planet over all turns"
        )
    ]
    for each in sharing.published:
        how = "recalled, not read in the source: verify it" if each.recalled else "read in the source named"
        rows.append(ReportRow(each.source, "K_γ", (short(each.factor),), "", how))
    return rows


def _place_table(sharing: LoadSharing) -> WordTable:
    rows = [
        (name, *(_small(each) for each in place), _small(sharing.excursions[name]))
        for name, place in sharing.displacements.items()
    ]
    return WordTable(("member", "x, µm", "y, µm", "farthest over all turns, µm"), rows)


def _torsion(torsion: TorsionalStiffness) -> ReportSection:
    rows = [
        ReportRow("torque on the output", "T", (short(torsion.torque),), "N·m", ""),
        ReportRow("twist of the output", "θ", (short(torsion.twist),), "°", f"{short(3600 * torsion.twist)} arcsec"),
        ReportRow("torsional stiffness, T/θ", "", (short(torsion.stiffness),), "N·m/rad", "secant, at this torque"),
    ]
    table = WordTable(
        ("spring", "", "twist, °", "share, %"),
        [
            (each.name, each.source.value, short(each.twist), f"{100 * each.share:.2f}")
            for each in sorted(torsion.contributions, key=lambda each: -each.share)
        ],
        2,
    )
    draw = on_axes(partial(plot_torsion, torsion))
    return ReportSection(
        "Torsional stiffness",
        words=(said("torsion_words", torsion),),
        tables=(ReportTable("", rows=rows), ReportTable("", grid=table)),
        figures=(figure("Parts of the twist", draw, torsion_inches(torsion), said("torsion")),),
    )


def _running(running: Running) -> ReportSection:
    rows = [
        ReportRow("greatest share of a planet in this run", "K_γ", (f"{running.mesh_load_factor:.4f}",), "", ""),
        ReportRow("least share of a planet", "", (f"{float(running.shares.min()):.4f}",), "", ""),
        ReportRow("share of a planet, peak to peak, by the meshes alone", "", (_small(running.mesh_share_ripple),), "", ""),
        ReportRow("twist of the output, peak to peak", "", (_small(3600 * running.twist_ripple),), "arcsec", ""),
        ReportRow("the same by the meshes alone", "", (_small(3600 * running.mesh_ripple),), "arcsec", ""),
        ReportRow(
            "the same by what else turns", "", (_small(3600 * running.slow_ripple),), "arcsec", ", ".join(running.turning)
        ),
    ]
    if (speed := running.ripple.speed) is not None:
        rows.append(
            ReportRow("ripple of the output's speed, peak to peak", "", (_small(100 * speed),), "%", said("ripple_source"))
        )
    amplitudes = dict(running.ripple.amplitude)
    first, *others = amplitudes.values()
    if all(np.array_equal(first, other) for other in others):  # of one frequency: the twist does not tell whose it is
        amplitudes = {"both meshes": first}
    harmonics = enumerate(zip(*amplitudes.values(), strict=True), 1)
    rows_of = [(str(number), *(f"{3600 * float(each):.4f}" for each in row)) for number, row in harmonics]
    grid = WordTable(("harmonic", *amplitudes), rows_of)
    caption = said("running", running, shown_pitches(running))
    return ReportSection(
        "Running",
        words=(said("running_words", running),),
        tables=(
            ReportTable("", rows=rows),
            ReportTable("Twist by harmonics of the meshes, arcsec", grid=grid, note=said("harmonic_note")),
        ),
        figures=(figure("Shares and twist as it runs", partial(plot_running, running), RUNNING_INCHES, caption),),
    )


def _small(value: float) -> str:
    """A figure, 0 where only rounding is left."""
    return short(value) if abs(value) > _ROUNDING else "0"


_NONE = "–"  # an en dash where there is no value


def section_of_rating(train: PlanetaryTrain, rating: TrainRating) -> ReportSection:
    """Stresses of all gears, load factors, and what cannot be rated."""
    heads = ("mesh", "gear", "K_A", "K_γ", "K_v", "σ_H0, MPa", "σ_H, MPa", "σ_F0, MPa", "σ_F, MPa", "Y_M")
    rows = [*_of_set(train, rating), *_of_stages(train, rating)]
    unread = [each.verify for each in rating.meshes.values()] + [each.verify for each in rating.stages.values()]
    note = said("rating_note", list(dict.fromkeys(chain.from_iterable(unread))))
    tables = (ReportTable("", grid=WordTable(heads, rows, 2), note=note, symbols=True),) if rows else ()
    unrated = tuple(said("unrated", name, why) for name, why in rating.unrated.items())
    return ReportSection("Rating of the meshes", words=(said("rating_words", rating), *unrated), tables=tables)


def _of_set(train: PlanetaryTrain, rating: TrainRating) -> Iterator[tuple[str, ...]]:
    for mesh in train.meshes:
        if (found := rating.meshes.get(mesh.name)) is None:
            continue
        factors = (found.load.application_factor, found.load.mesh_load_factor.value, found.dynamic_factor)
        names = {mesh.central_role: mesh.central.name, mesh.rim_role: mesh.rim.name}
        for role in (mesh.central_role, mesh.rim_role):
            bends = short(found.mean_stress_factor.pick(role))
            yield (mesh.name, names[role], *map(_or_none, factors), *_stresses(found.rating, role), bends)


def _of_stages(train: PlanetaryTrain, rating: TrainRating) -> Iterator[tuple[str, ...]]:
    for stage in train.stages:
        if (found := rating.stages.get(stage.name)) is not None:
            for role in Role:
                factors = (short(found.application_factor), _NONE, _NONE)
                yield (stage.name, stage_gear(stage, role), *factors, *_stresses(found, role), _NONE)


def _stresses(rating: Rating, role: Role) -> tuple[str, ...]:
    """Nominal contact stress and that under the load factors, the same in the root."""
    values = (
        rating.flank.nominal_stress,
        rating.contact_stresses.pick(role),
        rating.roots.pick(role).nominal_stress,
        rating.root_stresses.pick(role),
    )
    return tuple(map(short, values))


def _or_none(value: float | None) -> str:
    return _NONE if value is None else short(value)


_LONGEST_LIFE = 1e6
"""Hours above which a life is told as more than that."""

_GEARS = ("gear", "mesh", "S_H", "S_F", "σ_H, MPa", "σ_HG, MPa", "σ_F, MPa", "σ_FG, MPa", "load cycles", "life, h")
_FACTORS = ("mesh", *(STRENGTH_FACTORS[key].symbol for key in LOAD_FACTORS))
_SCUFFING = ("mesh", "risk", "θ_int, °C", "θ_intS, °C", "S_int", "Θ_B, °C", "Θ_S, °C", "S_B")


_SAFETIES = ("mesh", "gear", "safety", "verdict", "value", "minimum")
_ASSUMED = ("assumed", "meshes")


def section_of_strength(strength: TrainStrength) -> ReportSection:
    """Safeties with their verdicts, stresses, load factors, scuffing; what was assumed, and what was not judged."""
    factors = [
        (mesh, *map(_text, each.factors[FactorGroup.LOAD].values()))
        for mesh, each in strength.meshes.items()
        if each.load_factors is not None
    ]
    scuffed = [(mesh, *_scuffing(each)) for mesh, each in strength.meshes.items() if each.scuffing is not None]
    tables = [ReportTable("", grid=WordTable(_SAFETIES, list(_safeties(strength)), 4))] if strength.asked else []
    tables.append(ReportTable("Stresses and life", grid=WordTable(_GEARS, list(_rows(strength)), 2), symbols=True))
    if factors:
        tables.append(ReportTable("Load factors", grid=WordTable(_FACTORS, factors), symbols=True))
    if scuffed:
        tables.append(ReportTable("Scuffing", grid=WordTable(_SCUFFING, scuffed, 2), symbols=True))
    if assumed := list(_assumed(strength)):
        tables.append(ReportTable("Assumed", grid=WordTable(_ASSUMED, assumed, 2)))
    missing = tuple(said("not_judged", name, why) for name, why in strength.not_judged.items())
    words = tuple(filter(None, (said("strength_words", strength), *missing, said("strength_note", strength))))
    return ReportSection("Strength", words=words, tables=tuple(tables) if strength.meshes else ())


def _safeties(strength: TrainStrength) -> Iterator[tuple[str, ...]]:
    """Yield a row for each flank and root in each mesh, and for the scuffing of a mesh where a safety is required."""
    for mesh, rating in strength.meshes.items():
        for gear, of in strength.members.items():
            for words, parts in (("flank, S_H", of.flank), ("root, S_F", of.root)):
                if (part := parts.get(mesh)) is not None:
                    yield mesh, gear, words, part.verdict.value, _safety(part.safety), _safety(part.required)
        if (required := rating.options.required_safety_scuffing) is not None:
            found = None if rating.scuffing is None else rating.scuffing.integral_safety
            yield mesh, "both", "scuffing, S_int", rating.scuffing_verdict.value, _safety(found), _safety(required)


def _safety(value: float | None) -> str:
    return _NONE if value is None else f"{value:.3f}"


def _assumed(strength: TrainStrength) -> Iterator[tuple[str, str]]:
    """Yield each assumed input with the meshes in which it was assumed."""
    for text in strength.assumed:
        meshes = [mesh for mesh, each in strength.meshes.items() if text in each.assumed]
        yield written(text), "all" if len(meshes) == len(strength.meshes) else ", ".join(meshes)


def _rows(strength: TrainStrength) -> Iterator[tuple[str, ...]]:
    for name, gear in strength.members.items():
        for mesh, flank in gear.flank.items():
            root = gear.root[mesh]
            stresses = (flank.stress, flank.strength, root.stress, root.strength)
            known = [each.life for each in (flank, root) if each.life is not None]
            yield (
                name,
                mesh,
                *map(_text, (flank.safety, root.safety, *stresses, flank.cycles)),
                _hours(min(known, default=None)),
            )


def _scuffing(rating: StrengthRating) -> Iterator[str]:
    found = rating.scuffing
    if found is None:
        return
    limits, integral, flash = found.limits, found.integral, found.flash
    yield _NONE if found.risk is None else found.risk.value
    yield from map(_text, (None if integral is None else float(integral.value), None if limits is None else limits.integral))
    yield _text(found.integral_safety)
    yield from map(
        _text, (None if flash is None else flash.value, None if limits is None else limits.flash, found.flash_safety)
    )


def _text(value: float | None) -> str:
    return _NONE if value is None else short(value)


def _hours(value: float | None) -> str:
    if value is None or math.isinf(value):
        return _NONE if value is None else "infinite"
    return f"> {_LONGEST_LIFE:.0e}".replace("e+0", "e") if value > _LONGEST_LIFE else short(value)


_MOST_RESONANCES = 24
"""Resonances that are listed: those in which most of what the meshes could do is done, of the lowest harmonics."""


def sections_of_vibration(study: PlanetaryStudy) -> Iterator[ReportSection]:
    """Natural modes, Campbell diagram, loads over speed: those that are known."""
    if study.modes is not None:
        yield _modes(study.train, study.modes)
    if study.campbell is not None:
        yield _campbell(study.train, study.campbell)
    if study.gyroscopic is not None and study.gyroscopic.speed[-1] > 0:
        yield _gyroscopic(study.train, study.gyroscopic)
    if study.response is not None:
        yield _response(study.response)


def _modes(train: PlanetaryTrain, modes: PlanetaryModes) -> ReportSection:
    pictures: tuple[ReportFigure, ...] = ()
    if shown_families(modes):
        caption = said("modes", modes, MOST_MODES)
        pictures = (figure("Natural modes", partial(plot_modes, train, modes), modes_inches(modes), caption),)
    return ReportSection(
        "Natural frequencies and modes",
        words=(said("mode_words", modes),),
        tables=(ReportTable("", grid=_mode_table(modes), note=said("mode_note")),),
        figures=pictures,
    )


def _mode_table(modes: PlanetaryModes) -> WordTable:
    heads = ("modes", "kind", "most kinetic energy in", "most potential energy in", "Hz", "1/s")
    return WordTable(heads, [_mode(modes, family) for family in modes.families], 4)


def _mode(modes: PlanetaryModes, family: ModeFamily) -> tuple[str, ...]:
    """A frequency, and in what its modes have most of their energy."""
    first, last = family.first, family.first + family.multiplicity
    number = str(first + 1) if family.multiplicity == 1 else f"{first + 1} to {last}"
    members = modes.springs.members
    bodies = [*members, *["planets"] * (len(modes.bodies) - len(members))]
    kinetic = _most(bodies, modes.kinetic[first:last].mean(axis=0))
    if family.frequency == 0:
        return (number, family.kind.value, kinetic, "turns as a whole", "0", "0")
    springs = [_spring_words(spring) for spring in modes.springs.springs]
    potential = _most(springs, modes.potential[first:last].mean(axis=0))
    numbers = short(family.frequency), short(2 * np.pi * family.frequency)
    return (number, family.kind.value, kinetic, potential, *numbers)


def _spring_words(spring: Spring) -> str:
    """Return the words for the part to which a spring belongs; all planets together."""
    if spring.kind is SpringKind.MESH:
        return spring.owner
    if spring.kind in (SpringKind.PIN_RADIAL, SpringKind.PIN_TANGENTIAL):
        return "pins"
    return f"{'hold' if spring.kind is SpringKind.TORSION else 'support'} of {spring.owner}"


def _most(names: list[str], shares: Floats) -> str:
    """The name with the greatest share, and that in percent."""
    summed: dict[str, float] = {}
    for name, share in zip(names, shares.tolist(), strict=True):
        summed[name] = summed.get(name, 0.0) + share
    most = max(summed, key=lambda name: summed[name])
    return f"{most}, {100 * summed[most]:.0f} %"


def _campbell(train: PlanetaryTrain, campbell: PlanetaryCampbell) -> ReportSection:
    draw, table = on_axes(partial(plot_train_campbell, train, campbell)), _resonance_table(campbell)
    note = said("resonance_note", campbell, _MOST_RESONANCES)
    return ReportSection(
        "Campbell diagram",
        words=(said("campbell_words", train, campbell),),
        tables=(ReportTable("Excited modes", grid=table, note=note),) if table.rows else (),
        figures=(figure("Campbell diagram", draw, CAMPBELL_INCHES, said("campbell", campbell, highest_drawn(campbell))),),
    )


def _gyroscopic(train: PlanetaryTrain, modes: GyroscopicModes) -> ReportSection:
    draw = on_axes(partial(plot_gyroscopic, train, modes))
    picture = figure("Change of natural frequencies", draw, GYROSCOPIC_INCHES, said("gyroscopic", modes))
    return ReportSection(
        "Natural frequencies over the speed of the carrier", words=(said("gyroscopic_words", train, modes),), figures=(picture,)
    )


def _response(response: PlanetaryResponse) -> ReportSection:
    draw = on_axes(partial(plot_response, response))
    return ReportSection(
        "Loads over speed",
        words=(said("response_words", response),),
        figures=(figure("Loads over speed", draw, RESPONSE_INCHES, said("response", response)),),
    )


def _resonance_table(campbell: PlanetaryCampbell) -> WordTable:
    """Return the table of resonances: those with the largest shares where harmonics of meshes excite modes, by speed."""
    found = sorted(campbell.excited, key=lambda each: (-round(each.share or 0.0, 3), campbell.lines[each.line].harmonic))
    rows = []
    for met in sorted(found[:_MOST_RESONANCES], key=lambda each: each.speed):
        family = campbell.families[met.family]
        numbers = (short(met.speed), short(met.frequency), f"{met.share or 0.0:.3f}")
        rows.append((campbell.lines[met.line].name, f"{family.first + 1}, {family.kind.value}", *numbers))
    return WordTable(("line", "mode", "input, rpm", "Hz", "share"), rows, 2)


_MISSING = "not-computed"
"""Code of the notices of parts that are missing; they have a section of their own."""


def write_planetary_report(study: PlanetaryStudy, name: str, path: Path, head: Mapping[str, str] | None = None) -> None:
    """Write the report of a study of the design `name` to `path`; the same study gives the same bytes."""
    path.write_text(planetary_html(study, name, head), encoding="utf-8", newline="\n")


def planetary_html(study: PlanetaryStudy, name: str, head: Mapping[str, str] | None = None) -> str:
    """The report as one HTML document without links."""
    parts = (sections_of_build, sections_of_load, sections_of_bending, sections_of_vibration)
    sections = list(chain.from_iterable(part(study) for part in parts))
    if study.rating is not None:
        sections += [section_of_rating(study.train, study.rating), section_of_strength(study.rating.strength)]
    figures = [figure.title for section in sections for figure in section.figures]
    return page_html(
        "planetary.html",
        name,
        head,
        of=study,
        train=study.train,
        methods=_methods(study),
        editions=_editions(study),
        words=said("train", study.train),
        sections=sections,
        numbers=dict(zip(figures, count(1), strict=False)),
        why_not=_missing(study),
        warnings=texts(notice for notice in study.notices if notice.code != _MISSING),
    )


def _methods(study: PlanetaryStudy) -> list[str]:
    """Return the methods by which the stiffness of the meshes was found, each once."""
    return list(dict.fromkeys(each.cycle.method for each in (study.stiffness or {}).values()))


def _editions(study: PlanetaryStudy) -> list[str]:
    """The standards by which meshes were rated."""
    meshes = () if study.rating is None else study.rating.meshes.values()
    return list(dict.fromkeys(each.rating.edition.value for each in meshes))


def _missing(study: PlanetaryStudy) -> list[tuple[str, str]]:
    """Return the quantities that could not be computed, and the reason for each."""
    return [(notice.where.removeprefix("no "), notice.text) for notice in study.notices if notice.code == _MISSING]
