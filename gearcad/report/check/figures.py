"""The figures of a report as data: URLs, with their captions."""

from __future__ import annotations

import base64
import io
from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, NamedTuple, TypeVar

from gearcad.check.plane.result import PlaneCheck
from gearcad.check.result import CheckResult
from gearcad.check.solid.result import SolidCheck
from gearcad.geometry import GearPair
from gearcad.per_gear import Role
from gearcad.plots.check import (
    plot_contact_pressure,
    plot_load_share,
    plot_mesh_stiffness,
    plot_root_stress,
    plot_transmission_error,
)
from gearcad.plots.lines import (
    plot_contact_pattern,
    plot_harmonics,
    plot_line_loads,
    plot_lines_share,
    plot_load_along_face,
    plot_root_along_face,
)
from gearcad.plots.pair import pair_inches, plot_pair
from gearcad.plots.paper import FIGURE_INCHES, new_figure
from gearcad.plots.stresses import plot_contact_zone, plot_depth_profile, plot_fillets, plot_stress_field, worst_fields
from gearcad.plots.trends import plot_convergence, plot_sweep_pressure, plot_sweep_stiffness
from gearcad.report.check import captions, captions_plane, captions_solid

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["Picture", "figure_address", "make_figures", "pair_picture", "picture_address"]

Checked = TypeVar("Checked", bound=CheckResult)

_DOTS_PER_INCH = 160
"""Of the pictures of fields; the others are lines."""


class Picture(NamedTuple):
    """A figure: its title, its address (the picture itself), and what it shows in sentences."""

    title: str
    address: str
    caption: str


class _Drawing(NamedTuple):
    title: str
    draw: Callable[[Axes], Axes]
    caption: str
    kind: str = "svg"


def make_figures(result: CheckResult) -> list[Picture]:
    """All figures in the order of the report."""
    if isinstance(result, SolidCheck):
        drawings = _solid_drawings(result)
    else:
        assert isinstance(result, PlaneCheck)  # there are two
        drawings = _plane_drawings(result)
    return [Picture(each.title, picture_address(each.draw, each.kind), each.caption) for each in drawings]


def _plane_drawings(of: PlaneCheck) -> list[_Drawing]:
    fields, words = worst_fields(of), captions_plane
    teeth, zone = (partial(plot, of, fields=fields) for plot in (plot_stress_field, plot_contact_zone))
    along_path, worst = "Pressure along the path of contact", of.cycle.worst_contact
    around, below = [], []
    if worst is not None:
        caption = words.contact_zone(of, worst[1], fields)
        around = [_Drawing("Stress around the contact", lambda ax: zone(ax=ax), caption, "png")]
        below = [_Drawing("Stresses below the flank", partial(plot_depth_profile, of), words.depth_profile(of, worst[1]))]
    return [
        _Drawing("Stress in the teeth", lambda ax: teeth(ax=ax), words.stress_field(of), "png"),
        *around,
        _Drawing(along_path, partial(plot_contact_pressure, of), words.contact_pressure(of)),
        *below,
        _Drawing("Load share", partial(plot_load_share, of), words.load_share(of)),
        *_over_mesh(of),
        _Drawing("Stress along the fillets", partial(plot_fillets, of), words.fillets(of)),
        *_trends(of, words.convergence),
    ]


def _solid_drawings(of: SolidCheck) -> list[_Drawing]:
    words = captions_solid
    return [
        _Drawing("Load over the plane of action", partial(plot_line_loads, of), words.line_loads(of), "png"),
        _Drawing(
            "Contact pattern, pinion",
            partial(plot_contact_pattern, of, Role.PINION),
            words.contact_pattern(of, Role.PINION),
            "png",
        ),
        _Drawing(
            "Contact pattern, wheel",
            partial(plot_contact_pattern, of, Role.WHEEL),
            words.contact_pattern(of, Role.WHEEL),
            "png",
        ),
        _Drawing("Load along the face width", partial(plot_load_along_face, of), words.load_along_face(of)),
        _Drawing("Root stress along the face width", partial(plot_root_along_face, of), words.root_along_face(of)),
        _Drawing("Load share", partial(plot_lines_share, of), words.lines_share(of)),
        *_over_mesh(of),
        _Drawing("Harmonics of the transmission error", partial(plot_harmonics, of), words.harmonics(of)),
        *_trends(of, words.convergence),
    ]


def _over_mesh(of: CheckResult) -> list[_Drawing]:
    return [
        _Drawing("Mesh stiffness", partial(plot_mesh_stiffness, of), captions.mesh_stiffness(of)),
        _Drawing("Transmission error", partial(plot_transmission_error, of), captions.transmission_error(of)),
        _Drawing("Root stress over the mesh", partial(plot_root_stress, of), captions.root_stress(of)),
    ]


def _trends(of: Checked, convergence: Callable[[Checked], str]) -> list[_Drawing]:
    found = [
        _Drawing("Pressure over torque", partial(plot_sweep_pressure, of), captions.sweep_pressure(of)),
        _Drawing("Stiffness over torque", partial(plot_sweep_stiffness, of), captions.sweep_stiffness(of)),
    ]
    if of.convergence:
        found.append(_Drawing("Convergence", partial(plot_convergence, of), convergence(of)))
    return found


def pair_picture(pair: GearPair) -> Picture:
    """Both gears as they stand in mesh."""
    address = picture_address(partial(plot_pair, pair), "svg", pair_inches(pair))
    return Picture("The pair in mesh", address, captions.pair(pair))


def picture_address(draw: Callable[[Axes], Axes], kind: str, inches: tuple[float, float] = FIGURE_INCHES) -> str:
    """What is drawn on axes, as a data: URL of an "svg" or "png"."""
    return figure_address(lambda figure: draw(figure.subplots()), kind, inches)


def figure_address(draw: Callable[[Figure], object], kind: str, inches: tuple[float, float] = FIGURE_INCHES) -> str:
    """What is drawn on a figure, as a data: URL of an "svg" or "png"."""
    from matplotlib import style

    with style.context(["default", {"svg.hashsalt": "gearcad"}]):
        figure, stream = new_figure(inches), io.BytesIO()
        draw(figure)
        nothing = {"Date": None} if kind == "svg" else {"Software": None}
        figure.savefig(stream, format=kind, dpi=_DOTS_PER_INCH, metadata=nothing)
    media = {"svg": "image/svg+xml", "png": "image/png"}[kind]
    return f"data:{media};base64,{base64.b64encode(stream.getvalue()).decode('ascii')}"
