"""Design: what one spec describes, whatever its kind - each kind has a module of its own in `kinds`."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from enum import Enum
from typing import Any, ClassVar, Protocol, Self

from gearcad.designs.files import Where
from gearcad.errors import ParameterError
from gearcad.geometry import Gear
from gearcad.notice import Notice, texts
from gearcad.reprs import concise
from gearcad.version import __version__

__all__ = [
    "LONGEST_NAME",
    "LONGEST_NAME_IN_BYTES",
    "Described",
    "Design",
    "DesignKind",
    "kinds_in_words",
    "require_plain_name",
]

LONGEST_NAME = 100
"""Most characters of a design's name: it becomes a folder, and file systems stop at 255 bytes."""

LONGEST_NAME_IN_BYTES = 200
"""The same in UTF-8, with room for what the names of files beside the folder add."""

_RESERVED = {"CON", "PRN", "AUX", "NUL", *(f"{port}{number}" for port in ("COM", "LPT") for number in range(1, 10))}


class DesignKind(Enum):
    """What a spec makes; the value names its module in `kinds`, and its main table: of a pinion and a rack that is [pair]."""

    GEAR = "gear"
    PAIR = "pair"
    RACK = "rack"
    RACK_PAIR = "rack_pair"
    TRAIN = "train"
    PLANETARY = "planetary"

    @property
    def words(self) -> str:
        """As one says it to whoever never typed the value."""
        return {"rack_pair": "rack and pinion", "planetary": "planetary train"}.get(self.value, self.value)


class Described(Protocol):
    """What has derived properties and warnings of its own: a gear, a rack, or a pair of them."""

    @property
    def notices(self) -> tuple[Notice, ...]: ...

    def to_dict(self) -> dict[str, Any]:
        """Inputs and derived properties under their field names."""


@dataclass(frozen=True, kw_only=True)
class Design(ABC):
    """What one spec describes, of any kind: its subject under the name of its kind, and the inputs that later stages need.

    `name` becomes the name of the output folder. Raises ParameterError for a name that is not a plain file name.
    """

    kind: ClassVar[DesignKind]
    elsewhere: ClassVar[str] = ""
    """What takes designs of this kind, if hardly any job does."""

    name: str

    __repr__ = concise

    def __post_init__(self) -> None:
        require_plain_name(self.name)

    @classmethod
    @abstractmethod
    def read(cls, tables: Mapping[str, Any], where: Where, default_name: str) -> Self:
        """The design that the tables of a spec describe; `where` locates a dotted key for messages. Raises SpecError."""

    @property
    def gears(self) -> dict[str, Gear]:
        """The gears under the names of their files; none of a kind that knows no teeth."""
        return {}

    @property
    def described(self) -> Mapping[str, Described]:
        """What has derived properties and warnings of its own, under its name in `data.json`."""
        return self.gears

    @property
    def notices(self) -> tuple[Notice, ...]:
        """What an engineer should know before making this."""
        return tuple(notice.within(name) for name, each in self.described.items() for notice in each.notices)

    @property
    def warnings(self) -> tuple[str, ...]:
        """The notices in words, each led by what it is about."""
        return texts(self.notices)

    def require_kind(self, *kinds: DesignKind, why: str) -> None:
        """Raise ParameterError, that ends with why no other will do, unless the design is of one of these kinds."""
        if self.kind not in kinds:
            raise ParameterError("kind", self.kind.words, f"must be {kinds_in_words(kinds)}: {self.elsewhere or why}")

    def to_dict(self) -> dict[str, Any]:
        """The document of `data.json`: inputs and derived properties under their field names (mm, degrees)."""
        document: dict[str, Any] = {"kind": self.kind.value, "name": self.name, "gearcad": __version__}
        return document | {name: each.to_dict() for name, each in self.described.items()}


def kinds_in_words(accepted: Iterable[DesignKind]) -> str:
    """ "a gear, a pair or a rack"."""
    *others, last = (f"a {each.words}" for each in accepted)
    return f"{', '.join(others)} or {last}" if others else last


def require_plain_name(name: Any) -> None:
    """Raise ParameterError unless `name` can name a folder on every system, and nothing but a folder."""
    permitted = "must be a plain file name"
    if not isinstance(name, str) or not name.strip():
        raise ParameterError("name", name, f"{permitted}: a text that is not empty")
    if len(name) > LONGEST_NAME:
        raise ParameterError("name", name, f"{permitted} of at most {LONGEST_NAME} characters")
    if not name.isprintable() or any(character in '/\\<>:"|?*' for character in name):
        raise ParameterError("name", name, f'{permitted}, without / \\ < > : " | ? * and control characters')
    if len(name.encode()) > LONGEST_NAME_IN_BYTES:
        raise ParameterError("name", name, f"{permitted} of at most {LONGEST_NAME_IN_BYTES} bytes in UTF-8")
    if name[0] in ".- " or name[-1] in ". ":
        raise ParameterError(
            "name", name, f"{permitted}: not begun with a point, a dash or a space, nor ended with a point or space"
        )
    if name.split(".")[0].strip().upper() in _RESERVED:
        raise ParameterError("name", name, f"{permitted}: Windows keeps this one for itself")
