"""What gives way in a train: how planets share the load, how far it twists, and what both do as it runs."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from gearcad.dynamics.planetary.running import Running
from gearcad.dynamics.planetary.sharing import LoadSharing
from gearcad.dynamics.planetary.torsion import TorsionalStiffness
from gearcad.plots.paper import FIGURE_INCHES, short
from gearcad.plots.planetary.running import RUNNING_INCHES, plot_running, shown_pitches
from gearcad.plots.planetary.sharing import plot_sharing, plot_torsion, torsion_inches
from gearcad.report.check.tables import Row
from gearcad.report.dynamics.tables import WordTable
from gearcad.report.planetary.sections import Section, Table, figure, on_axes, said

if TYPE_CHECKING:
    from gearcad.dynamics.planetary.result import PlanetaryStudy

__all__ = ["sections_of_bending"]

_ROUNDING = 1e-9
"""Of shares, µm and arc seconds."""


def sections_of_bending(study: PlanetaryStudy) -> Iterator[Section]:
    """Load sharing, torsional stiffness, the run: those that are known."""
    if study.sharing is not None:
        yield _sharing(study.sharing)
    if study.torsion is not None:
        yield _torsion(study.torsion)
    if study.running is not None:
        yield _running(study.running)


def _sharing(sharing: LoadSharing) -> Section:
    picture = figure("Load sharing", on_axes(partial(plot_sharing, sharing)), FIGURE_INCHES, said("sharing", sharing))
    return Section(
        "Load sharing",
        words=(said("sharing_words", sharing),),
        tables=(
            Table("", grid=_share_table(sharing)),
            Table("Mesh load factor", rows=_factor_rows(sharing)),
            Table("Where members go", grid=_place_table(sharing), note=said("place_note")),
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


def _factor_rows(sharing: LoadSharing) -> list[Row]:
    """K_gamma as computed and as published."""
    rows = [
        Row("computed here", "K_γ", (f"{sharing.mesh_load_factor:.4f}",), "", "the greatest share of a planet over all turns")
    ]
    for each in sharing.published:
        how = "recalled, not read in the source: verify it" if each.recalled else "read in the source named"
        rows.append(Row(each.source, "K_γ", (short(each.factor),), "", how))
    return rows


def _place_table(sharing: LoadSharing) -> WordTable:
    rows = [
        (name, *(_small(each) for each in place), _small(sharing.excursions[name]))
        for name, place in sharing.displacements.items()
    ]
    return WordTable(("member", "x, µm", "y, µm", "farthest over all turns, µm"), rows)


def _torsion(torsion: TorsionalStiffness) -> Section:
    rows = [
        Row("torque on the output", "T", (short(torsion.torque),), "N·m", ""),
        Row("twist of the output", "θ", (short(torsion.twist),), "°", f"{short(3600 * torsion.twist)} arcsec"),
        Row("torsional stiffness, T/θ", "", (short(torsion.stiffness),), "N·m/rad", "secant, at this torque"),
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
    return Section(
        "Torsional stiffness",
        words=(said("torsion_words", torsion),),
        tables=(Table("", rows=rows), Table("", grid=table)),
        figures=(figure("Parts of the twist", draw, torsion_inches(torsion), said("torsion")),),
    )


def _running(running: Running) -> Section:
    rows = [
        Row("greatest share of a planet in this run", "K_γ", (f"{running.mesh_load_factor:.4f}",), "", ""),
        Row("least share of a planet", "", (f"{float(running.shares.min()):.4f}",), "", ""),
        Row("share of a planet, peak to peak, by the meshes alone", "", (_small(running.mesh_share_ripple),), "", ""),
        Row("twist of the output, peak to peak", "", (_small(3600 * running.twist_ripple),), "arcsec", ""),
        Row("the same by the meshes alone", "", (_small(3600 * running.mesh_ripple),), "arcsec", ""),
        Row("the same by what else turns", "", (_small(3600 * running.slow_ripple),), "arcsec", ", ".join(running.turning)),
    ]
    if (speed := running.ripple.speed) is not None:
        rows.append(Row("ripple of the output's speed, peak to peak", "", (_small(100 * speed),), "%", said("ripple_source")))
    amplitudes = dict(running.ripple.amplitude)
    first, *others = amplitudes.values()
    if all(np.array_equal(first, other) for other in others):  # of one frequency: the twist does not tell whose it is
        amplitudes = {"both meshes": first}
    harmonics = enumerate(zip(*amplitudes.values(), strict=True), 1)
    rows_of = [(str(number), *(f"{3600 * float(each):.4f}" for each in row)) for number, row in harmonics]
    grid = WordTable(("harmonic", *amplitudes), rows_of)
    caption = said("running", running, shown_pitches(running))
    return Section(
        "Running",
        words=(said("running_words", running),),
        tables=(Table("", rows=rows), Table("Twist by harmonics of the meshes, arcsec", grid=grid, note=said("harmonic_note"))),
        figures=(figure("Shares and twist as it runs", partial(plot_running, running), RUNNING_INCHES, caption),),
    )


def _small(value: float) -> str:
    """A figure, 0 where only rounding is left."""
    return short(value) if abs(value) > _ROUNDING else "0"
