"""Options that a study has no use for: whoever gave them is told."""

from __future__ import annotations

from gearcad.dynamics.options import DynamicsOptions, PairModel
from gearcad.notice import Notice

__all__ = ["idle_in_contact", "idle_without_levels", "undamped_bearings"]


_OF_LEVELS = ("level_tolerance",)
_OF_CHARTS = ("operating_from", "operating_to")
_OF_CONTACT = (
    "tooth_errors",
    "error_distribution",
    "error_samples",
    "premature_engagement",
    "harmonics",
    "accuracy_grade",
    "seed",
)
_OF_BEARINGS = ("pinion_bearing_stiffness", "wheel_bearing_stiffness", "bearing_damping")


def idle_without_levels(options: DynamicsOptions) -> tuple[Notice, ...]:
    """What is for several models of a train, in a study of one model, or of a pair."""
    return _idle(options, _OF_LEVELS, "a train with a list of models, held against each other")


def idle_in_contact(options: DynamicsOptions) -> tuple[Notice, ...]:
    """What is for the model "mesh", in a study of the contact model; what is for several models of a train, too."""
    found = _idle(options, (*_OF_CONTACT, *_OF_CHARTS, *_OF_BEARINGS), f'the model "{PairModel.MESH.value}" of a pair')
    return (*found, *idle_without_levels(options))


def _idle(options: DynamicsOptions, keys: tuple[str, ...], subject: str) -> tuple[Notice, ...]:
    """Those of the keys that are not as they are by default, and what they are for."""
    default = DynamicsOptions()
    given = [key for key in keys if getattr(options, key) != getattr(default, key)]
    if not given:
        return ()
    verb = "is" if len(given) == 1 else "are"
    return (Notice("option-without-effect", f"without effect here: {', '.join(given)}, which {verb} for {subject}"),)


def undamped_bearings(options: DynamicsOptions) -> tuple[Notice, ...]:
    """That only the teeth damp gears on bearings."""
    if options.pinion_bearing_stiffness is None or options.bearing_damping:
        return ()
    text = (
        "the bearings are undamped: resonances of gears that travel are as sharp as the damping of the teeth leaves them, and "
        "there may be speeds at which no steady motion lasts; bearing_damping (N·s/m) damps them"
    )
    return (Notice("undamped-bearings", text),)
