"""Design: what one spec describes - a gear or a pair with its name, material, load and mounting - ready to be computed."""

from __future__ import annotations

from dataclasses import asdict, dataclass, replace
from enum import Enum
from typing import Any, TypedDict, Unpack

from gearcad.check.options import CheckOptions
from gearcad.dynamics.options import DynamicsOptions
from gearcad.errors import ParameterError, as_choice
from gearcad.geometry import Gear, GearPair
from gearcad.load import Load
from gearcad.material import Material
from gearcad.mounting import Mounting
from gearcad.rating.options import RatingOptions
from gearcad.reprs import concise

__all__ = ["Design", "DesignKind", "Inputs", "as_design", "require_plain_name"]

LONGEST_NAME = 100
"""Most characters of a design's name: it becomes a folder, and file systems stop at 255 bytes."""

LONGEST_NAME_IN_BYTES = 200
"""The same in UTF-8, with room for what the names of files beside the folder add."""

_RESERVED = {"CON", "PRN", "AUX", "NUL", *(f"{port}{number}" for port in ("COM", "LPT") for number in range(1, 10))}


class DesignKind(Enum):
    """What a spec makes."""

    GEAR = "gear"
    PAIR = "pair"


@dataclass(frozen=True, kw_only=True)
class Design:
    """A single gear (`gear` is set) or a pair (`pair` is set), with the inputs that later stages need.

    `name` becomes the name of the output folder. Raises ParameterError for a name that is not a plain file name.
    """

    kind: DesignKind
    name: str
    gear: Gear | None = None
    pair: GearPair | None = None
    material: Material | None = None
    load: Load | None = None
    mounting: Mounting | None = None
    check: CheckOptions | None = None
    dynamics: DynamicsOptions | None = None
    rating: RatingOptions | None = None

    __repr__ = concise

    def __post_init__(self) -> None:
        object.__setattr__(self, "kind", as_choice("kind", self.kind, DesignKind))
        require_plain_name(self.name)
        if (self.kind is DesignKind.GEAR) != (self.gear is not None) or (self.kind is DesignKind.PAIR) != (
            self.pair is not None
        ):
            raise ParameterError("kind", self.kind, "must match the gear or the pair that is given")

    def loaded_pair(self, no_mate: str, no_load: str) -> tuple[GearPair, Load]:
        """The pair and its load. Raises ParameterError where one is missing: it ends with why it is needed."""
        if self.pair is None:
            raise ParameterError("kind", self.kind.value, f"must be a pair: a single gear has {no_mate}")
        if self.load is None:
            raise ParameterError("load.torque", None, f"must be given, in N·m on the pinion: {no_load}")
        return self.pair, self.load

    @property
    def gears(self) -> dict[str, Gear]:
        """The gears under the names of their files: `gear`, or `pinion` and `wheel`."""
        if self.pair is not None:
            return {"pinion": self.pair.pinion, "wheel": self.pair.wheel}
        assert self.gear is not None  # __post_init__ saw to it
        return {"gear": self.gear}

    @property
    def warnings(self) -> tuple[str, ...]:
        """What an engineer should know before making this, each led by what it is about."""
        found = [f"{name}: {text}" for name, gear in self.gears.items() for text in gear.warnings]
        if self.pair is not None:
            found += [f"pair: {text}" for text in self.pair.warnings]
        return tuple(found)

    def to_dict(self) -> dict[str, Any]:
        """The document of `data.json`: inputs and derived properties under their field names (mm, degrees)."""
        from gearcad import __version__

        document: dict[str, Any] = {"kind": self.kind.value, "name": self.name, "gearcad": __version__}
        document |= {name: gear.to_dict() for name, gear in self.gears.items()}
        if self.pair is not None:
            document["pair"] = self.pair.to_dict()
        if self.material is not None:
            document["material"] = asdict(self.material)
        if self.load is not None:
            document["load"] = asdict(self.load)
        if self.mounting is not None:
            document["mounting"] = asdict(self.mounting)
        if self.check is not None:
            document["check"] = asdict(self.check)
        if self.dynamics is not None:
            document["dynamics"] = asdict(self.dynamics)
        if self.rating is not None:
            document["rating"] = asdict(self.rating)
        return document


class Inputs(TypedDict, total=False):
    """What a job may be given beside a pair and its load, under the names of a spec's tables."""

    material: Material
    mounting: Mounting
    check: CheckOptions
    dynamics: DynamicsOptions
    rating: RatingOptions


def as_design(subject: Design | GearPair, load: Load | None = None, **inputs: Unpack[Inputs]) -> Design:
    """A design as it is, or that of a pair, with what is given in place of its own. Raises ParameterError."""
    if isinstance(subject, GearPair):
        subject = Design(kind=DesignKind.PAIR, name=subject.name, pair=subject)
    if not isinstance(subject, Design):
        raise ParameterError("subject", subject, "must be a GearPair or a Design")
    return replace(subject, load=subject.load if load is None else load, **inputs)


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
