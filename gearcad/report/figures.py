"""The figures of a report as data: URLs, with their captions."""

from __future__ import annotations

import base64
import io
from collections.abc import Callable
from typing import TYPE_CHECKING, NamedTuple

from gearcad.check.run import CheckResult
from gearcad.plots.check import (
    plot_contact_pressure,
    plot_load_share,
    plot_mesh_stiffness,
    plot_root_stress,
    plot_transmission_error,
)
from gearcad.plots.paper import new_figure
from gearcad.plots.stresses import plot_contact_zone, plot_depth_profile, plot_fillets, plot_stress_field, worst_fields
from gearcad.plots.trends import plot_convergence, plot_sweep_pressure, plot_sweep_stiffness
from gearcad.report import captions

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["Picture", "make_figures"]

_DOTS_PER_INCH = 160
"""Of the pictures of fields; the others are lines."""


class Picture(NamedTuple):
    """A figure: its title, its address (the picture itself), and what it shows in sentences."""

    title: str
    address: str
    caption: str


def make_figures(result: CheckResult) -> list[Picture]:
    """All figures in the order of the report."""
    from matplotlib import style

    fields = worst_fields(result)
    drawn: tuple[tuple[str, Callable[[CheckResult, Axes], Axes], str, str], ...] = (
        ("Stress in the teeth", lambda of, ax: plot_stress_field(of, ax, fields), captions.stress_field(result), "png"),
        (
            "Stress around the contact",
            lambda of, ax: plot_contact_zone(of, ax, fields),
            captions.contact_zone(result, fields),
            "png",
        ),
        ("Pressure along the path of contact", plot_contact_pressure, captions.contact_pressure(result), "svg"),
        ("Stresses below the flank", plot_depth_profile, captions.depth_profile(result), "svg"),
        ("Load share", plot_load_share, captions.load_share(result), "svg"),
        ("Mesh stiffness", plot_mesh_stiffness, captions.mesh_stiffness(result), "svg"),
        ("Transmission error", plot_transmission_error, captions.transmission_error(result), "svg"),
        ("Root stress over the mesh", plot_root_stress, captions.root_stress(result), "svg"),
        ("Stress along the fillets", plot_fillets, captions.fillets(result), "svg"),
        ("Pressure over torque", plot_sweep_pressure, captions.sweep_pressure(result), "svg"),
        ("Stiffness over torque", plot_sweep_stiffness, captions.sweep_stiffness(result), "svg"),
        ("Convergence", plot_convergence, captions.convergence(result), "svg"),
    )
    with style.context(["default", {"svg.hashsalt": "gearcad"}]):
        return [Picture(title, _picture(result, draw, kind), caption) for title, draw, caption, kind in drawn]


def _picture(result: CheckResult, draw: Callable[[CheckResult, Axes], Axes], kind: str) -> str:
    figure, stream = new_figure(), io.BytesIO()
    draw(result, figure.subplots())
    figure.savefig(stream, format=kind, dpi=_DOTS_PER_INCH, metadata={"Date": None} if kind == "svg" else {"Software": None})
    media = {"svg": "image/svg+xml", "png": "image/png"}[kind]
    return f"data:{media};base64,{base64.b64encode(stream.getvalue()).decode('ascii')}"
