"""First picture of any result: drawn by `plot`, and shown in notebooks."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Callable
from contextlib import suppress
from html import escape
from importlib import import_module
from io import BytesIO
from typing import TYPE_CHECKING, Any

from gearcad.core.errors import InputError, ParameterError

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["plot", "shown_in_notebook"]

_FIRST: dict[str, tuple[str, Callable[[Any], Any]]] = {
    "Gear": ("plot_gear", lambda it: it),
    "GearPair": ("plot_pair", lambda it: it),
    "PlanetaryTrain": ("plot_scheme", lambda it: it),
    "ElementMesh": ("plot_mesh", lambda it: it),
    "MeshResult": ("plot_mesh", lambda it: next(iter(it.meshes.values()))),
    "PlaneCheck": ("plot_stress_field", lambda it: it),
    "SolidCheck": ("plot_line_loads", lambda it: it),
    "MeshCycle": ("plot_cycle", lambda it: it),
    "StiffnessComparison": ("plot_stiffness", lambda it: it),
    "StrengthRating": ("plot_life", lambda it: it),
    "TrainStrength": ("plot_safeties", lambda it: it),
    "SideBySide": ("plot_beside", lambda it: it),
    "Identification": ("plot_residuals", lambda it: it),
    "TrainStudy": ("plot_factors", lambda it: it),
    "PairStudy": ("plot_factors", lambda it: it.study),
    "SpeedSpectra": ("plot_campbell", lambda it: it),
    "ContactStudy": ("plot_campbell", lambda it: it.study),
    "PlanetaryStudy": ("plot_scheme", lambda it: it.train),
    "Proposal": (
        "plot_modification",
        lambda it: next(gear for gear in it.pair.gears if gear.modification.present),
    ),
    "Sizing": ("plot_front", lambda it: it),
}
"""The function that draws an object, and the one that gives its argument, by the name of the class."""

_DOTS_PER_INCH = 60
"""Resolution of the small picture of a result, in dots per inch."""


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
            function, part = _FIRST[kind.__name__]
            drawn: Axes = getattr(import_module("gearcad.plots"), function)(part(shown), ax=ax)
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
