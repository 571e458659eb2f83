"""The panels of the page: each computes its content from a design without the browser, and then shows it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from typing import ClassVar, Generic, TypeVar

from gearcad.designs.design import Design

__all__ = ["Panel"]

Found = TypeVar("Found")


class Panel(ABC, Generic[Found]):
    """A part of the page that follows the design. It is built at the place where NiceGUI puts elements when it is made.

    A panel that `compares` shows a kept design next to the present one.
    """

    compares: ClassVar[bool] = False

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

    def keep(self, found: Found | None) -> None:
        """Take the result for the kept design, or None, to be shown with later results."""
