"""Figures of the theory pages."""

from math import radians
from pathlib import Path

import numpy as np

import gearcad
from gearcad import read
from gearcad.geometry.fillets import ToolTip
from gearcad.plots import save_plot
from gearcad.plots.paper import new_figure, prepared
from gearcad.plots.stiffness import plot_stiffness

TEMPLATES = Path(__file__).parents[2] / "templates"


def _root(tool: ToolTip) -> tuple[np.ndarray, np.ndarray]:
    """What a tool's tip cuts, in a space that is upright in the picture (mm)."""
    radius, angle = tool.cut(np.linspace(0, tool.last_angle, 300))
    return radius * np.sin(angle), radius * np.cos(angle)


def draw_root(path: Path) -> None:
    """The root of the helical pinion, by the ellipse of its tool's tip and by a circle in its place."""
    pinion = read(TEMPLATES / "volvo-13-44.toml").pair.pinion
    module, shift = pinion.normal_module, pinion.profile_shift * pinion.normal_module
    size = {"depth": pinion.rack.dedendum * module - shift, "shift": shift, "radius": pinion.rack.root_radius * module}
    size |= {"reference_radius": pinion.reference_diameter / 2, "thinning": pinion.tooth_thinning}
    ellipse = ToolTip.cutting(normal_module=module, pressure_angle=radians(20), helix_angle=radians(pinion.helix_angle), **size)
    transverse = radians(pinion.transverse_pressure_angle)
    circle = ToolTip.cutting(normal_module=pinion.transverse_module, pressure_angle=transverse, helix_angle=0.0, **size)
    figure = new_figure((7.0, 4.4))
    axes = prepared(figure.add_subplot(), "from the middle of the space, mm", "from the axis of the gear, mm")
    for words, tool, style in (("the tip as it is, an ellipse", ellipse, "-"), ("a circle in its place", circle, "--")):
        axes.plot(*_root(tool), style, label=words)
    axes.set_aspect("equal")
    axes.legend(frameon=False)
    figure.savefig(path)


def draw_stiffness(path: Path) -> None:
    """All methods but that of solid bodies, which takes minutes."""
    design = read(TEMPLATES / "alm-18-161.toml")
    methods = ["potential-energy", "weber-banaschek", "iso6336", "strain-energy", "plane-stress", "plane-strain"]
    save_plot(plot_stiffness, gearcad.stiffness(design, methods=methods), path)


FIGURES = {"theory-root.png": draw_root, "theory-stiffness.png": draw_stiffness}
