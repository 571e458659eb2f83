"""Notice: what to know before trusting a result, as data; who shows it chooses where and how."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace

__all__ = ["Notice", "joined", "texts"]


@dataclass(frozen=True)
class Notice:
    """One thing to know: `code` names its kind for programs, `text` says it, `where` is what it is about ("" for all of it).

    >>> notice = Notice("thin-rim", "the rim bends", where="wheel")
    >>> print(notice)
    wheel: the rim bends
    >>> print(notice.within("check"))
    check: wheel: the rim bends
    """

    code: str
    text: str
    where: str = ""

    def __str__(self) -> str:
        return f"{self.where}: {self.text}" if self.where else self.text

    def within(self, owner: str) -> Notice:
        """The same, seen from what holds its subject."""
        return replace(self, where=f"{owner}: {self.where}" if self.where else owner)

    def to_dict(self) -> dict[str, str]:
        """As documents have it."""
        return {"code": self.code, "where": self.where, "text": self.text}


def texts(notices: Iterable[Notice]) -> tuple[str, ...]:
    """Each notice in a line, without those said before."""
    return tuple(dict.fromkeys(map(str, notices)))


def joined(notices: Iterable[Notice]) -> Sequence[Notice]:
    """Each text once, where it was first, with all places that it is about.

    >>> stiff = Notice("rigid", "taken for rigid")
    >>> print(*joined([stiff.within("sharing"), stiff.within("running")]))
    sharing, running: taken for rigid
    """
    places: dict[tuple[str, str], dict[str, None]] = {}
    for notice in notices:
        places.setdefault((notice.code, notice.text), {})[notice.where] = None
    return [Notice(code, text, where=", ".join(filter(None, where))) for (code, text), where in places.items()]
