"""Finite element meshes of a design: mesh."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from gearcad.cli.group import debug_option, spec_argument
from gearcad.cli.job import echo_warnings, json_option, output_option, perform, quiet_option
from gearcad.cli.language import say
from gearcad.core.records import grouped
from gearcad.meshing.fem import Element
from gearcad.meshing.options import MeshFormat

if TYPE_CHECKING:
    from gearcad.meshing.result import Deck, JudgedMesh, MeshResult

__all__ = ["mesh"]

_FORMATS = f"Comma-separated list of {', '.join(kind.value for kind in MeshFormat)}.  [default: vtu,msh]"


@click.command(short_help="Mesh SPEC's gears with finite elements.")
@spec_argument
@output_option
@click.option("--what", metavar="WHAT", help="sector, teeth:5, ring, pair, pair:5 or part.  [default: ring, or pair]")
@click.option("--model", metavar="2d|3d", help="Section or body.  [default: 3d for helical gears]")
@click.option("--element", metavar="KIND", help="quad8, tri6; hex20, hex8; tet10.  [default: the first; of a 2d pair tri6]")
@click.option("--gear", metavar="NAME", help="pinion, wheel or both.  [default: both]")
@click.option("--size", type=float, metavar="MM", help="Edge of elements on the flanks; the others follow.")
@click.option("--elements", type=int, metavar="N", help="Elements in each file, instead of a size.")
@click.option("--fillet-elements", type=int, metavar="N", help="About so many over 30° of a fillet.  [default: 4]")
@click.option("--refined-teeth", metavar="LIST", help="Numbers of teeth that have finer tetrahedra: 0,1.")
@click.option("--roll", type=float, metavar="DEG", help="Where a pair stands in mesh, 0 at the pitch point.")
@click.option("--deck", metavar="LIST", help="For CalculiX: pair, tooth, shafts.  [default: none]")
@click.option("--positions", type=int, metavar="N", help="Decks over one base pitch.  [default: 1]")
@click.option("--format", metavar="LIST", help=_FORMATS)
@json_option
@quiet_option
@debug_option
def mesh(spec: Path, output: Path | None, as_json: bool, quiet: bool, **options: str | float | None) -> None:
    """Mesh the gears of SPEC with finite elements: nodes exactly on flanks and fillets, sides with names.

    \b
    sector    one tooth and its share of the body, with matched cuts
    teeth:5   so many teeth next to each other
    ring      all teeth, down to the bore
    pair      pinion and wheel in mesh; pair:5 has five teeth of each
    part      the whole part with keyway, hub and chamfers, of tetrahedra

    Writes a file for each gear, or one for the pair, in each format, and mesh.json, which says how good the elements are and
    how far they are from the exact gear. Exit status 1 if that is too bad. The flanks of a pair are fine where its [load]
    presses them. --deck pair adds *_deck.inp, the loaded pair in mesh as CalculiX runs it, --deck tooth each gear under the
    contact loads that our own check finds, whose figures are in mesh.json, --deck shafts the pair as whole rings on its shafts.
    [mesh] in SPEC holds the same options.
    """
    from gearcad.jobs.mesh import Mesh

    job = Mesh(given={name: value for name, value in options.items() if value is not None})
    result = perform(job, spec, output, _show, as_json=as_json, quiet=quiet)
    if not result.passed:
        click.get_current_context().exit(1)


def _show(name: str, result: MeshResult) -> None:
    """Each gear's mesh, what to know, and the verdict."""
    for role, judged in result.judged.items():
        say("\n".join(_lines(role, judged, result)))
    if result.plan.pair is not None:
        say(_of_pair(result))
    for file, deck in result.decks.items():
        say(_of_deck(file, deck))
    echo_warnings(result.notices)
    for role, judged in result.judged.items():
        for gate in judged.gates:
            if not gate.passed:
                say(f"FAILED: {role}: {gate}", fg="red")
    say(f"{name}: mesh {result.verdict}", fg="green" if result.passed else "red", bold=True)


def _lines(role: str, judged: JudgedMesh, result: MeshResult) -> list[str]:
    measured, solid = judged.quality, result.plan.solid
    size, unit = ("volume", "mm³") if solid else ("area", "mm²")
    amount = f"{grouped(judged.elements)} {measured.element.value}, {grouped(judged.nodes)} nodes"
    return [
        f"{role}: {_extent(judged, result)}, {amount}",
        f"  scaled Jacobian at least {measured.least_jacobian:.3f}, {measured.mean_jacobian:.3f} on the mean; the worst is "
        f"{measured.worst[0]}",
        f"  longest over shortest edge at most {measured.largest_aspect:.1f}, angles at least {measured.least_angle:.1f}°",
        f"  nodes within {judged.deviations.nodes:.1g} mm of the exact flanks and fillets; between them these are at most "
        f"{judged.deviations.between:.2g} µm off ({judged.deviations.worst})",
        f"  {size} {judged.whole:.8g} {unit}, exact {judged.exact:.8g} {unit}",
    ]


def _of_pair(result: MeshResult) -> str:
    """Return both gears of a pair in one mesh."""
    side, mesh, roll = "left" if result.plan.left else "right", result.mesh, result.plan.options.roll
    amount = f"{grouped(len(mesh.cells))} elements, {grouped(len(mesh.points))} nodes"
    return f"pair: {amount}, {side} flanks in mesh at a roll angle of {roll:g}° of the pinion"


def _of_deck(file: str, deck: Deck) -> str:
    """Return the line of a deck: the figures of gearcad's own check for comparison, and the command that runs it."""
    of, job = deck.expected, file.removesuffix(".inp")
    root = of["root_stress"]
    stress = " and ".join(f"{each:.4g}" for each in (root.values() if isinstance(root, dict) else [root]))
    error = f"a transmission error of {of['transmission_error']:.4g} µm, " if "transmission_error" in of else ""
    return f"{file}: at {of['roll_angle']:.4g}° our own check has {error}root stress of {stress} MPa; ccx {job} runs it"


def _extent(judged: JudgedMesh, result: MeshResult) -> str:
    if result.plan.element is Element.TET10:
        return f"whole part with {judged.teeth} teeth"
    if judged.teeth == judged.every_tooth:
        return f"ring of {judged.teeth} teeth"
    return "1 tooth" if judged.teeth == 1 else f"{judged.teeth} teeth"
