"""The picture that one looks at first, of whatever it is: what `plot` draws, and notebooks show of a result."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Callable
from contextlib import suppress
from html import escape
from importlib import import_module
from io import BytesIO
from typing import TYPE_CHECKING, Any

from gearcad.errors import InputError, ParameterError

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["plot", "shown_in_notebook"]

_FIRST: dict[str, tuple[str, Callable[[Any], Any]]] = {
    "Gear": ("gear.plot_gear", lambda it: it),
    "GearPair": ("pair.plot_pair", lambda it: it),
    "PlanetaryTrain": ("planetary.scheme.plot_scheme", lambda it: it),
    "ElementMesh": ("mesh.plot_mesh", lambda it: it),
    "MeshResult": ("mesh.plot_mesh", lambda it: next(iter(it.meshes.values()))),
    "PlaneCheck": ("stresses.plot_stress_field", lambda it: it),
    "SolidCheck": ("lines.plot_line_loads", lambda it: it),
    "MeshCycle": ("speeds.plot_cycle", lambda it: it),
    "StiffnessComparison": ("stiffness.plot_stiffness", lambda it: it),
    "StrengthRating": ("strength.plot_life", lambda it: it),
    "TrainStrength": ("strength.plot_safeties", lambda it: it),
    "SideBySide": ("side_by_side.plot_beside", lambda it: it),
    "Identification": ("measured.plot_residuals", lambda it: it),
    "TrainStudy": ("speeds.plot_factors", lambda it: it),
    "PairStudy": ("speeds.plot_factors", lambda it: it.study),
    "SpeedSpectra": ("campbell.plot_campbell", lambda it: it),
    "ContactStudy": ("campbell.plot_campbell", lambda it: it.study),
    "PlanetaryStudy": ("planetary.scheme.plot_scheme", lambda it: it.train),
    "Proposal": (
        "gear.plot_modification",
        lambda it: next(gear for gear in it.pair.gears if gear.modification.present),
    ),
    "Sizing": ("sizing.plot_front", lambda it: it),
}
"""By the name of a class: the function that draws it, and what of it that takes."""

_DOTS_PER_INCH = 60
"""Of the small picture of a result."""


def plot(shown: object, ax: Axes | None = None) -> Axes:
    """Draw the picture that one looks at first: of a gear, a pair, a mesh, or of what a verb gave.

    A gear: its section. A pair: both in mesh with the path of contact. Elements: all of them. A check: the stress field, of
    solid bodies the loads on the lines of contact. Stiffness: its course over the mesh. A rating: life of the flanks. Dynamics:
    K_v over speed, of several side by side too. A planetary train: its scheme; whether it holds: the safeties of its gears.
    Modifications: how far flanks are taken back. Sizes: mass and safety. A measured gear: how far candidates are off.
    Raises ParameterError for anything else.
    """
    for kind in type(shown).__mro__:
        if kind.__name__ in _FIRST:
            place, part = _FIRST[kind.__name__]
            module, _, function = place.rpartition(".")
            drawn: Axes = getattr(import_module(f"gearcad.plots.{module}"), function)(part(shown), ax=ax)
            return drawn
    raise ParameterError("shown", type(shown).__name__, f"must be one of {', '.join(_FIRST)}")


def shown_in_notebook(result: object) -> str:
    """HTML of a result: its line as in a Python session, above its first picture, small, where there is something to draw."""
    words, picture = f"<code>{escape(repr(result).removeprefix('<').removesuffix('>'))}</code>", ""
    with suppress(InputError):
        picture = f'<br/><img alt="" src="data:image/png;base64,{b64encode(_small(plot(result))).decode()}"/>'
    return f"<div>{words}{picture}</div>"


def _small(axes: Axes) -> bytes:
    file, figure = BytesIO(), axes.get_figure(root=True)
    assert figure is not None  # that of the axes
    figure.savefig(file, format="png", dpi=_DOTS_PER_INCH)
    return file.getvalue()
