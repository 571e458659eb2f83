"""What the report of every check shows: its comparisons, the figures over the mesh and the torque, the reasons of stiffness."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from typing import TYPE_CHECKING, ClassVar, Generic, NamedTuple, TypeVar

from gearcad.check.comparison import Comparison, ComparisonRole
from gearcad.check.result import CheckResult
from gearcad.plots.check import plot_mesh_stiffness, plot_root_stress, plot_transmission_error
from gearcad.plots.paper import short
from gearcad.plots.trends import plot_convergence, plot_sweep_pressure, plot_sweep_stiffness
from gearcad.report.check.figures import Picture, pair_picture, picture_address
from gearcad.report.check.strength import StrengthSection, strength_section
from gearcad.report.check.tables import Row, gear_rows, load_rows, pair_rows, rating_rows
from gearcad.report.check.views import ToothView
from gearcad.report.sentences import sentences
from gearcad.report.stiffness.report import StiffnessSection, section_of_check

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["CheckSections", "ComparisonRow"]

Checked = TypeVar("Checked", bound=CheckResult)


class ComparisonRow(NamedTuple):
    """A comparison as the tables have it; the verdict is a `word`, not only a colour."""

    quantity: str
    computed: str
    reference: str
    unit: str
    permitted: str
    deviation: str
    word: str
    style: str
    source: str
    note: str
    reason: str


@dataclass(frozen=True)
class CheckSections(ABC, Generic[Checked]):
    """Sections of the report of a `result`; each model has a `template` for what it tells in other words, and `captions`."""

    result: Checked

    template: ClassVar[str]
    captions: ClassVar[str]

    # ------------------------------------------------------------------ the verdict

    @property
    def verdict(self) -> str:
        """As a sentence begins."""
        return self.result.verdict[0].upper() + self.result.verdict[1:]

    @property
    def gates(self) -> list[ComparisonRow]:
        """What decides."""
        return [_row(each) for each in self.result.comparisons if each.role is ComparisonRole.GATE]

    @property
    def information(self) -> list[ComparisonRow]:
        """What does not decide."""
        return [_row(each) for each in self.result.comparisons if each.role is ComparisonRole.INFORMATION]

    @property
    def failed(self) -> list[ComparisonRow]:
        """Gates that are not passed."""
        return [_row(each) for each in self.result.comparisons if each.role is ComparisonRole.GATE and not each.passed]

    @property
    def outside(self) -> list[ComparisonRow]:
        """Information outside its band."""
        found = (each for each in self.result.comparisons if each.role is ComparisonRole.INFORMATION)
        return [_row(each) for each in found if each.evaluated and not each.passed and each.tolerance is not None]

    @property
    def below(self) -> tuple[str, ...]:
        """Safeties by finite elements that are less than required."""
        return self.result.safeties.below_required

    # ------------------------------------------------------------------ why they differ

    @property
    @abstractmethod
    def root_reasons(self) -> list[str]:
        """Why the root stresses differ from the standard's."""

    @property
    def stiffness_reasons(self) -> list[str]:
        """Why the stiffness differs from the standard's."""
        of, part, ring = self.result.explanations.stiffness, self.result.rating.edition.part(1), self.result.pair.internal
        return [sentences("reasons_check.txt", macro, of, part, ring) for macro in ("compared", "bodies", "load", "sharing")]

    # ------------------------------------------------------------------ figures

    @property
    def pair(self) -> Picture:
        """The gears in mesh."""
        return pair_picture(self.result.pair)

    @cached_property
    @abstractmethod
    def figures(self) -> list[Picture]:
        """In the order of the report."""

    @cached_property
    def views(self) -> list[ToothView]:
        """Teeth to be turned by hand; only solid bodies have some."""
        return []

    def figure(self, title: str, draw: Callable[[Axes], Axes], caption: str, kind: str = "svg", *values: object) -> Picture:
        """One with a caption of the model's own, of the result and of other values."""
        return Picture(title, picture_address(draw, kind), self.caption(caption, *values))

    def caption(self, name: str, *values: object) -> str:
        """One of the model's own."""
        return sentences(self.captions, name, self.result, *values)

    @property
    def over_mesh(self) -> list[Picture]:
        """Courses over one base pitch."""
        of = self.result
        return [
            _common("Mesh stiffness", partial(plot_mesh_stiffness, of), "mesh_stiffness", of),
            _common("Transmission error", partial(plot_transmission_error, of), "transmission_error", of),
            _common("Root stress over the mesh", partial(plot_root_stress, of), "root_stress", of),
        ]

    @property
    def over_torque_and_mesh_size(self) -> list[Picture]:
        """What the check varies."""
        of = self.result
        found = [
            _common("Pressure over torque", partial(plot_sweep_pressure, of), "sweep_pressure", of.trends),
            _common("Stiffness over torque", partial(plot_sweep_stiffness, of), "sweep_stiffness", of.trends),
        ]
        if of.convergence:
            found.append(self.figure("Convergence", partial(plot_convergence, of), "convergence"))
        return found

    @cached_property
    def stiffness(self) -> StiffnessSection | str:
        """By other methods; why not, where they cannot be had."""
        return section_of_check(self.result.stiffness_methods)

    @cached_property
    def strength(self) -> StrengthSection:
        """Safeties by finite elements and by the standard."""
        return strength_section(self.result.safeties)

    # ------------------------------------------------------------------ inputs and rating

    @property
    def gear_rows(self) -> list[Row]:
        """Of both gears."""
        return gear_rows(self.result.pair)

    @property
    def pair_rows(self) -> list[Row]:
        """Of the pair."""
        return pair_rows(self.result.pair)

    @property
    def load_rows(self) -> list[Row]:
        """Of material, load and mounting."""
        return load_rows(self.result.material, self.result.load, self.result.mounting)

    @property
    def rating_rows(self) -> list[Row]:
        """Of the rating."""
        return rating_rows(self.result)


def _common(title: str, draw: Callable[[Axes], Axes], caption: str, of: object) -> Picture:
    return Picture(title, picture_address(draw, "svg"), sentences("captions_check.txt", caption, of))


def _row(comparison: Comparison) -> ComparisonRow:
    gate = comparison.role is ComparisonRole.GATE
    if comparison.passed:
        word = "passed" if gate else "reached" if comparison.least else "in the band"
    elif gate or not comparison.evaluated:
        word = "NOT PASSED" if gate else "not evaluated"
    else:
        word = "below" if comparison.least else "above" if comparison.tolerance is None else "outside the band"
    return ComparisonRow(
        quantity=comparison.quantity,
        computed=_number(comparison.computed),
        reference=_number(comparison.reference),
        unit=comparison.unit,
        permitted=_permitted(comparison),
        deviation=_deviation(comparison),
        word=word,
        style="good" if comparison.passed else "bad" if gate else "aside",
        source=comparison.source,
        note=comparison.note,
        reason=comparison.reason,
    )


def _permitted(comparison: Comparison) -> str:
    if comparison.tolerance is not None:
        return f"± {100 * comparison.tolerance:g} %"
    return "at least" if comparison.least else "at most"


def _number(value: float | None) -> str:
    return "-" if value is None else short(value)


def _deviation(comparison: Comparison) -> str:
    """From a value, or how much of a limit is used up."""
    if comparison.deviation is None:
        return "-"
    percent = 100 * comparison.deviation
    return f"{100 + percent:.1f} % of it" if comparison.tolerance is None else f"{round(percent, 2) + 0.0:+.2f} %"
