"""The panels of the page: each computes its content from a design without the browser, and then shows it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, Generic, TypeVar

from gearcad.designs.design import Design

if TYPE_CHECKING:
    from nicegui.element import Element

__all__ = ["Panel", "mark_stale"]

Found = TypeVar("Found")


class Panel(ABC, Generic[Found]):
    """A part of the page that follows the design. It is built at the place where NiceGUI puts elements when it is made.

    A panel that `compares` shows a kept design next to the present one, one that `keeps_all` shows all that are kept.
    """

    compares: ClassVar[bool] = False
    keeps_all: ClassVar[bool] = False

    _view: Any

    @abstractmethod
    def find(self, design: Design) -> Found:
        """Return the content to show for a design.

        It is computed in a thread, by jobs and the functions that they use; no element is touched. For a design without content
        in this panel, and for errors that gearcad raises, return content that says so.
        """

    def aside(self, design: Design) -> Callable[[Design], Found] | None:
        """`find` as a function of a module where that takes long: it is asked in another process, when the hand rests."""
        return None

    def wait(self) -> None:
        """Tell that what is shown is of an older design, and another is being found."""

    @abstractmethod
    def show(self, found: Found) -> None:
        """Show a result. A result for an older design than the one that is shown never arrives here."""

    @abstractmethod
    def clear(self) -> None:
        """Show nothing, because the inputs make no design."""

    def mark(self, stale: str) -> None:
        """Mark the content as that of other inputs than the present ones, in these words; "" if it is of these."""
        mark_stale(self._view, stale)

    def keep(self, found: Found | None) -> None:
        """Take the result for the kept design, or None, to be shown with later results."""

    def keep_all(self, found: Sequence[tuple[str, Found]]) -> None:
        """Take the names of all kept designs with their results, to be shown with later results."""


def mark_stale(view: Element, stale: str) -> None:
    """Give an element the words for content that is of other inputs than the present ones; "" takes them from it."""
    if view.props.get("data-stale", "") != stale:
        view.props["data-stale"] = stale
        if not stale:
            del view.props["data-stale"]
        view.update()
