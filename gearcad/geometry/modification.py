"""Flank modifications (ISO 21771): how far a flank is taken back from the exact involute helicoid.

A depth is measured in the transverse section along the base tangent, the normal of the involute: every point of the modified
flank on the radius r lies that far from the involute, so the flank is turned about the axis by depth/r_b at that radius.
Fillet, tip chamfer and the ends of the lands turn with the flank's own ends.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, replace
from enum import Enum
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from numpy.typing import ArrayLike

from gearcad.core.errors import GeometryError, at_most
from gearcad.core.quantities import Range, Words, require_fields
from gearcad.core.records import Floats, JsonObject, concise
from gearcad.geometry.involute import tangent_length

if TYPE_CHECKING:
    from gearcad.geometry.profile import ToothProfile

__all__ = [
    "ASSUMED_TRANSITION",
    "LEAST_TRANSITION",
    "FlankForm",
    "FlankModification",
    "ReliefShape",
    "ReliefTransition",
    "TransitionSource",
    "check_flanks",
    "longest_transition",
]


_RELIEFS = ("tip_relief", "root_relief", "end_relief")
_PROFILE_RELIEFS = ("tip_relief", "root_relief")
_SETTINGS = ("_length", "_shape", "_transition")
"""Endings of the fields that describe a relief beside its amount."""

_AMOUNT = Range("µm", -1000, 1000)
_RELIEF = Range("µm", 0, 1000)
_LENGTH = Range("mm", 0, None)

_LEAST_LENGTH = 1e-3
"""Least length (mm) of a relief."""

LEAST_TRANSITION = 1e-3
"""Least transition (mm of roll) that can be given, apart from 0."""

ASSUMED_TRANSITION = 0.1
"""Transition (normal modules of roll) from flank to linear relief where none is given: an assumption, not measured."""

_LEAST_LAND = 1e-3
"""Least width (mm) of what modifications leave of a tip land."""

_ONE = 3e-7
"""Breaks closer than this (mm) are one: a solid cannot tell them apart, and no depth changes by what would be seen."""

_NOTHING = 1e-200
"""Share of a length in place of 0 that is divided by."""

_ROUNDING = 1e-9
"""Overlap (mm) in a root that comes to a point which is rounding."""


class ReliefShape(Enum):
    """Growth of a relief from its start: in proportion to the distance, or to its square."""

    LINEAR = "linear"
    PARABOLIC = "parabolic"

    def grown(self, share: Floats, transition: float | Floats = 0.0) -> Floats:
        """Return 0 before the start and 1 at the end, at shares (...) of its length.

        A parabola rounds the start of the linear one over `transition`, a share of the length; it has no part in the other.
        """
        inside: Floats = np.maximum(share, 0.0)
        if self is ReliefShape.PARABOLIC:
            return inside**2
        if isinstance(transition, float) and not transition:
            return inside
        rounded = (share + transition / 2) ** 2 / np.maximum(2 * transition, _NOTHING)
        return np.where(np.abs(share) < transition / 2, rounded, inside)


class TransitionSource(Enum):
    """Source of the transition of a linear relief; SHORTENED is the assumed one cut to what fits the flank."""

    GIVEN = "given"
    ASSUMED = "assumed"
    SHORTENED = "shortened"


@dataclass(frozen=True)
class ReliefTransition:
    """The rounded start of a linear relief: `onset`, its `length` t (mm of roll) half before and half after that, and `slope`.

    The slope (mm per mm of roll, above 0) is that of the depth of the relief behind the transition.
    """

    onset: float
    length: float
    slope: float
    source: TransitionSource

    @property
    def rounding(self) -> float:
        """Height w (mm) that the transition removes at the onset: C_a t/(8 l_a)."""
        return self.slope * self.length / 8


def longest_transition(length: Any, roll: float) -> Any:
    """Return the longest transition (mm of roll) of a relief of that length on a flank of that length of roll."""
    return 2 * np.minimum(length, roll - length)


@dataclass(frozen=True, kw_only=True)
class FlankModification:
    """Modifications of both flanks of every tooth. Amounts in µm, positive takes material off; lengths in mm. ISO 21771.

    `tip_relief` C_alpha_a at the tip form circle, nothing `tip_relief_length` of roll below it; `root_relief` C_alpha_f the
    same from the root form circle up. `profile_crowning` C_alpha at both ends of the profile, a parabola with nothing in its
    middle; `pressure_angle_modification` C_H_alpha at the tip in proportion to the roll from the root form circle, positive
    for a larger pressure angle. `lead_crowning` C_beta at both ends of the face, nothing in its middle; `end_relief` C_beta_I,
    C_beta_II at both ends, nothing `end_relief_length` along the axis inside. `helix_angle_modification` C_H_beta over the
    face width: the sections turn about the middle one, positive for a steeper helix (right hand on a spur gear).
    `twist` S_alpha is the change of the profile slope from z = 0 to the other end.
    A linear relief of tip or root starts with a parabola over `tip_relief_transition`, `root_relief_transition` (mm of roll),
    half of it before its start; None assumes 0.1 m_n, or what fits; 0 is a kink. Amount and length stay.
    Raises ParameterError for one value, GeometryError for a relief without a length, and from `Gear` for what does not fit it.
    """

    tip_relief: Annotated[float, _RELIEF, Words("tip relief", "C_αa", "6.2")] = 0.0
    tip_relief_length: Annotated[float, _LENGTH, Words("tip relief, length of roll", "L_Cαa", "6.2")] = 0.0
    tip_relief_shape: Annotated[ReliefShape, Words("tip relief, shape", "", "6.2")] = ReliefShape.LINEAR
    tip_relief_transition: Annotated[float | None, _LENGTH, Words("tip relief, transition of roll", "t")] = None
    root_relief: Annotated[float, _RELIEF, Words("root relief", "C_αf", "6.2")] = 0.0
    root_relief_length: Annotated[float, _LENGTH, Words("root relief, length of roll", "L_Cαf", "6.2")] = 0.0
    root_relief_shape: Annotated[ReliefShape, Words("root relief, shape", "", "6.2")] = ReliefShape.LINEAR
    root_relief_transition: Annotated[float | None, _LENGTH, Words("root relief, transition of roll", "t")] = None
    profile_crowning: Annotated[float, _AMOUNT, Words("profile crowning", "C_α", "6.2")] = 0.0
    pressure_angle_modification: Annotated[float, _AMOUNT, Words("pressure angle modification", "C_Hα", "6.2")] = 0.0
    lead_crowning: Annotated[float, _AMOUNT, Words("lead crowning", "C_β", "6.3")] = 0.0
    end_relief: Annotated[float, _RELIEF, Words("end relief at both ends", "C_βI", "6.3")] = 0.0
    end_relief_length: Annotated[float, _LENGTH, Words("end relief, length along the axis", "L_CβI", "6.3")] = 0.0
    end_relief_shape: Annotated[ReliefShape, Words("end relief, shape", "", "6.3")] = ReliefShape.LINEAR
    helix_angle_modification: Annotated[float, _AMOUNT, Words("helix angle modification", "C_Hβ", "6.3")] = 0.0
    twist: Annotated[float, _AMOUNT, Words("twist of the flank", "S_α", "6.4")] = 0.0

    __repr__ = concise

    def __post_init__(self) -> None:
        require_fields(self)
        for name in _RELIEFS:
            length = getattr(self, f"{name}_length")
            if getattr(self, name) and length < _LEAST_LENGTH:
                permitted = f"must be at least {_LEAST_LENGTH} mm for a {name} above 0 µm"
                raise GeometryError(f"{name}_length", length, permitted, "mm")
        for name in _PROFILE_RELIEFS:
            given = getattr(self, f"{name}_transition")
            if given and getattr(self, f"{name}_shape") is ReliefShape.PARABOLIC:
                permitted = f"must be left out: a parabolic {name} starts without a kink"
                raise GeometryError(f"{name}_transition", given, permitted, "mm")
            if given and given < LEAST_TRANSITION:
                raise GeometryError(f"{name}_transition", given, f"must be 0 or at least {LEAST_TRANSITION} mm", "mm")

    @property
    def present(self) -> bool:
        """True if any amount is not 0."""
        return self.on_profile or self.along_face

    @property
    def on_profile(self) -> bool:
        """True if the depth depends on the place on the profile."""
        return any((self.tip_relief, self.root_relief, self.profile_crowning, self.pressure_angle_modification, self.twist))

    @property
    def along_face(self) -> bool:
        """True if the depth depends on the place along the face width."""
        return any((self.lead_crowning, self.end_relief, self.helix_angle_modification, self.twist))

    def to_dict(self) -> JsonObject:
        """Return all fields, shapes as words."""
        values = {each.name: getattr(self, each.name) for each in fields(self)}
        return {name: value.value if isinstance(value, ReliefShape) else value for name, value in values.items()}

    @property
    def in_use(self) -> dict[str, Any]:
        """The fields that do something, shapes as words: amounts that are not 0, and what belongs to them."""
        idle = tuple(name for name in _RELIEFS if not getattr(self, name))
        used = {name: value for name, value in self.to_dict().items() if not name.startswith(idle)}
        return {name: value for name, value in used.items() if value or (value is not None and name.endswith("_transition"))}

    def check_lengths(self, roll: float, face_width: float) -> None:
        """Raise GeometryError for lengths that do not fit a flank of that length of roll and width (mm)."""
        for name, most, words in (
            ("tip_relief_length", roll, "the length of roll of the flank"),
            ("root_relief_length", roll, "the length of roll of the flank"),
            ("end_relief_length", face_width / 2, "half the face width"),
        ):
            if getattr(self, name) > most:
                raise GeometryError(name, getattr(self, name), f"must be at most {at_most(most)} mm, {words}", "mm")


@dataclass(frozen=True)
class FlankForm:
    """The modified flanks of a gear: roll lengths from `first` to `last` and heights from 0 to `width`, all in mm.

    Roll lengths of a ring are negative, as its radii of curvature are (ISO 21771): they too grow from root to tip.
    `hand` is 1 for a right-hand helix and spur gears, -1 for a left-hand one.
    """

    modification: FlankModification
    first: float
    last: float
    width: float
    base_radius: float
    hand: int
    module: float

    @classmethod
    def of(
        cls, modification: FlankModification, profile: ToothProfile, face_width: float, helix_angle: float, module: float
    ) -> FlankForm:
        """Return the flank form of teeth of this profile; face width and normal module in mm, helix angle in degrees."""
        base, side = profile.base_diameter, -1 if profile.internal else 1
        first, last = (side * tangent_length(end, base) for end in (profile.form_diameter, profile.tip_form_diameter))
        return cls(modification, first, last, face_width, base / 2, -1 if helix_angle < 0 else 1, module)

    def depth(self, lengths: ArrayLike, heights: ArrayLike, *, left: bool = True) -> Floats:
        """Return the depth (mm) of the relief of the left or right flank at roll lengths and heights z (mm).

        The result has the shape to which both broadcast. Beyond the ends of the flank the depth is that at the end.
        """
        # A contact asks many thousand times for a few dozen places: amounts of 0 are left out.
        of = self.modification
        roll = np.minimum(np.maximum(lengths, self.first), self.last)
        amount = np.zeros(np.broadcast(roll, heights).shape)
        for most, end, length, shape, transition in self._reliefs:
            amount += most * shape.grown(1 - np.abs(end - roll) / length, transition)
        if self._on_whole_flank:
            up = (roll - self.first) / (self.last - self.first)
            amount += of.profile_crowning * (2 * up - 1) ** 2 + of.pressure_angle_modification * up
        if self._along_face:
            amount += self._along(np.clip(heights, 0.0, self.width), roll, left=left)
        return amount / 1000

    def _along(self, z: Floats, roll: Floats, *, left: bool) -> Floats:
        """Return the amount (µm) of what changes along the face at heights and roll lengths on the flank."""
        of, up, along = self.modification, (roll - self.first) / (self.last - self.first), z / self.width
        amount: Floats = of.lead_crowning * (2 * along - 1) ** 2 + of.twist * (along - 0.5) * (up - 0.5)
        amount = amount + of.helix_angle_modification * (along - 0.5) * self.hand * (-1 if left else 1)
        if of.end_relief:
            to_end = np.minimum(z, self.width - z)
            amount = amount + of.end_relief * of.end_relief_shape.grown(1 - to_end / of.end_relief_length)
        return amount

    @cached_property
    def _along_face(self) -> bool:
        return self.modification.along_face

    @cached_property
    def _on_whole_flank(self) -> bool:
        return bool(self.modification.profile_crowning or self.modification.pressure_angle_modification)

    @cached_property
    def _reliefs(self) -> tuple[tuple[float, float, float, ReliefShape, float], ...]:
        """Amounts (µm) of the reliefs of tip and root, their ends and lengths (mm), shapes, and transitions over lengths."""
        of, found = self.modification, []
        for name, end in (("tip_relief", self.last), ("root_relief", self.first)):
            if most := getattr(of, name):
                length, transition = getattr(of, f"{name}_length"), self.transitions.get(name)
                share = transition.length / length if transition else 0.0
                found.append((most, end, length, getattr(of, f"{name}_shape"), share))
        return tuple(found)

    def lead_depth(self, heights: ArrayLike, *, left: bool = True) -> Floats:
        """Return the depth (mm) at heights z (mm) of what depends on the place along the face alone.

        That is crowning, end relief and helix angle modification; a twist is 0 in the middle of the profile.
        """
        of = self.modification
        alone = FlankModification(
            lead_crowning=of.lead_crowning,
            end_relief=of.end_relief,
            end_relief_length=of.end_relief_length,
            end_relief_shape=of.end_relief_shape,
            helix_angle_modification=of.helix_angle_modification,
        )
        return replace(self, modification=alone).depth((self.first + self.last) / 2, heights, left=left)

    def turn(self, lengths: ArrayLike, heights: ArrayLike, *, left: bool = True) -> Floats:
        """Return the angle (rad), counter-clockwise, by which the flank's points are turned: depth/r_b, in its shape.

        Taking material off turns the left flank clockwise and the right one counter-clockwise. The left one is that with
        y > 0 of a tooth on +x.
        """
        return self.depth(lengths, heights, left=left) / self.base_radius * (-1 if left else 1)

    @cached_property
    def transitions(self) -> dict[str, ReliefTransition]:
        """The transitions of the linear reliefs that start on the flank, by `tip_relief` and `root_relief`."""
        of, found, roll = self.modification, dict[str, ReliefTransition](), self.last - self.first
        for name in _PROFILE_RELIEFS:
            amount, length = getattr(of, name), getattr(of, f"{name}_length")
            if not amount or roll - length < _ONE or getattr(of, f"{name}_shape") is not ReliefShape.LINEAR:
                continue
            transition, source = getattr(of, f"{name}_transition"), TransitionSource.GIVEN
            if transition is None:
                transition, source = ASSUMED_TRANSITION * self.module, TransitionSource.ASSUMED
                if transition > (longest := float(longest_transition(length, roll))):
                    transition, source = longest, TransitionSource.SHORTENED
            found[name] = ReliefTransition(self._starts[name], transition, amount / 1000 / length, source)
        return found

    def to_dict(self) -> JsonObject:
        """Return all fields of the modification and what `in_use` adds to them, None where there is no transition."""
        added = {f"{name}_{what}": None for name in _PROFILE_RELIEFS for what in ("transition_source", "rounding")}
        return self.modification.to_dict() | added | self.in_use

    @property
    def in_use(self) -> dict[str, Any]:
        """Fields that do something, as of the modification, with the transitions that are used and their sources.

        The rounding w at the start of a relief is in µm.
        """
        used = self.modification.in_use
        for name, of in self.transitions.items():
            used[f"{name}_transition"] = of.length
            used[f"{name}_transition_source"] = of.source.value
            used[f"{name}_rounding"] = 1000 * of.rounding
        return used

    @property
    def relief_starts(self) -> tuple[float, ...]:
        """Roll lengths (mm) inside the flank where reliefs start: the middle of a transition, where there is one."""
        return _inside(list(self._starts.values()), self.first, self.last)

    @property
    def _starts(self) -> dict[str, float]:
        """Roll length (mm) where each relief that takes something off starts, inside the flank or not."""
        of = self.modification
        starts = {"tip_relief": self.last - of.tip_relief_length, "root_relief": self.first + of.root_relief_length}
        return {name: start for name, start in starts.items() if getattr(of, name)}

    @property
    def roll_breaks(self) -> tuple[float, ...]:
        """Roll lengths (mm) inside the flank where the depth is not smooth: ends of transitions, else starts of reliefs."""
        found = []
        for name, start in self._starts.items():
            half = self.transitions[name].length / 2 if name in self.transitions else 0.0
            found += [start - half, start + half]
        return _inside(found, self.first, self.last)

    @property
    def height_breaks(self) -> tuple[float, ...]:
        """Heights z (mm) inside the face width where the depth is not smooth: the starts of the end reliefs."""
        of = self.modification
        found = [of.end_relief_length, self.width - of.end_relief_length] if of.end_relief else []
        return _inside(found, 0.0, self.width)


def check_flanks(form: FlankForm, profile: ToothProfile) -> None:
    """Raise GeometryError for modifications that do not fit their teeth: lengths beyond the flanks, no tip or no space left."""
    amounts = form.modification
    amounts.check_lengths(form.last - form.first, form.width)
    for name, of in form.transitions.items():
        most = float(longest_transition(getattr(amounts, f"{name}_length"), form.last - form.first))
        if of.length > most:
            permitted = (
                f"must be at most {at_most(most)} mm: its halves fit between the {name}'s start and the ends of the flank"
            )
            raise GeometryError(f"{name}_transition", of.length, permitted, "mm")
    if not amounts.present:
        return
    largest = max(
        (name for name in amounts.in_use if not name.endswith(_SETTINGS)),
        key=lambda name: abs(getattr(amounts, name)),
    )
    heights = np.unique([*np.linspace(0, form.width, 33), *form.height_breaks])
    tip, root = profile.tip_diameter / 2, profile.root_diameter / 2
    land = 2 * tip * np.radians(profile.half_angle(tip))
    space = 2 * root * (np.pi / profile.teeth - np.radians(profile.half_angle(root)))
    # What turns one flank towards the other; a change of the helix turns both alike.
    taken_at_tip, taken_at_root = (
        (form.depth(end, heights) + form.depth(end, heights, left=False)) / form.base_radius for end in (form.last, form.first)
    )
    for words, room, least in (
        ("tip land", land - tip * taken_at_tip.max(), _LEAST_LAND),
        ("root of the space", space + root * taken_at_root.min(), -_ROUNDING),
    ):
        if room < least:
            permitted = f"must be smaller: all modifications together leave {room:.4f} mm of the {words}"
            raise GeometryError(largest, getattr(amounts, largest), permitted, "µm")


def _inside(places: list[float], first: float, last: float) -> tuple[float, ...]:
    """Return the places between both ends, in order; those that are one for a solid count once."""
    slack = max(_ONE, 1e-9 * (last - first))
    ordered = sorted(place for place in places if first + slack < place < last - slack)
    return tuple(ordered[:1]) + tuple(after for before, after in pairwise(ordered) if after - before > slack)
