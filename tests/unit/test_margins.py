"""Figures make room for what stands around their axes: nothing is cut off, nothing lies on anything else, drawn once."""

import io
from itertools import combinations

import pytest
from matplotlib.cm import ScalarMappable
from matplotlib.figure import Figure
from matplotlib.transforms import Bbox
from support.checks import small_check

from gearcad.plots.check import plot_mesh_stiffness, plot_stress_field
from gearcad.plots.paper import legend_above, new_figure, prepared
from gearcad.plots.stiffness import plot_stiffness

_ROUNDING = 0.5
"""Pixels by which boxes may touch."""

_MOST_EMPTY = 0.1
"""Inches that may be left at the edges."""

_SVG_DPI = 72


def wide_numbers(figure):
    axes = prepared(figure.subplots(), "place in mm", "stress in MPa")
    axes.plot([0.0, 12345678.0], [-0.000125, 0.000125], label="a long name of the only curve")
    legend_above(axes, 2)


def many_rows(figure):
    axes = prepared(figure.subplots(), r"$\sigma_{F0}$", r"$\frac{c_\gamma}{c'}$")
    for number in range(9):
        axes.plot([0, 1], [number, -number], label=f"curve {number} of those with quite long names")
    axes.secondary_xaxis("top").set_xlabel("the same in other units")
    legend_above(axes, 3, raised=34.0)


def grid(figure):
    panels = figure.subplots(3, 2, sharex=True, squeeze=False).ravel()
    for number, panel in enumerate(panels):
        prepared(panel, "speed in rpm", "load in N").plot([0, 1], [0, 10.0 ** (2 * number)], label="load")
        panel.set_title(f"shaft {number}", fontsize=9, loc="left")
    panels[1].legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)


def labels_of_the_figure(figure):
    left, right = figure.subplots(1, 2, sharey=True)
    for panel in (left, right):
        panel.plot([0, 1e6], [0, 1e6], label="curve")
    figure.supxlabel("place in mm")
    figure.supylabel("compliance in µm/N")
    figure.legend(["curve"], loc="outside upper left", ncols=3)


def colour_bar(figure):
    axes = prepared(figure.subplots(), "speed in rpm", "frequency in Hz")
    figure.colorbar(ScalarMappable(), ax=axes, label="amplitude in µm", extend="max")


def fixed_aspect(figure):
    figure.set_size_inches(6.6, 3.7)  # nearly that of the axes: made wider they are lower, made higher they are narrower
    axes = figure.subplots()
    axes.set(xlim=(0, 29), ylim=(-12, 8), aspect="equal", xlabel="from the axis in mm", ylabel="across in mm")
    figure.colorbar(ScalarMappable(), ax=axes, label="stress in MPa", extend="max")


def field(figure):
    plot_stress_field(small_check(), figure.subplots())


def stiffness(figure):
    plot_mesh_stiffness(small_check(), figure.subplots())


def methods(figure):
    plot_stiffness(small_check().stiffness_methods.comparison, figure.subplots())


_DRAWN = (wide_numbers, many_rows, grid, labels_of_the_figure, colour_bar, fixed_aspect, field, stiffness, methods)


def drawn_boxes(figure, kind):
    """What axes, legends and texts of a figure take in pixels, each time that it is drawn while it is saved."""
    boxes, plain = [], Figure.draw

    def measured(self, renderer):
        plain(self, renderer)
        boxes.append([each.get_tightbbox(renderer) for each in (*self.axes, *self.legends, *self.texts)])

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Figure, "draw", measured)
        figure.savefig(io.BytesIO(), format=kind)
    return boxes


@pytest.mark.parametrize(("draw", "kind"), [*((draw, "png") for draw in _DRAWN), (grid, "svg"), (stiffness, "svg")])
def test_nothing_is_cut_off_or_lies_on_anything_else(draw, kind):
    figure = new_figure((6.6, 4.8))
    draw(figure)
    (boxes,) = drawn_boxes(figure, kind)  # drawn once
    size = figure.get_size_inches() * (figure.dpi if kind == "png" else _SVG_DPI)
    for box in boxes:
        assert (box.min > -_ROUNDING).all() and (box.max < size + _ROUNDING).all()
    for pair in combinations(boxes, 2):
        common = Bbox.intersection(*pair)
        assert common is None or min(common.size) < _ROUNDING


def test_axes_fill_what_their_texts_leave():
    figure = new_figure()
    prepared(figure.subplots(), "x", "y")
    ((box,),) = drawn_boxes(figure, "png")
    assert max(*box.min, *(figure.bbox.size - box.max)) < _MOST_EMPTY * figure.dpi
