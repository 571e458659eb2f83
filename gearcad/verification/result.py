"""Verification: the claims of one design, the files that they are about, and the verdict."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from gearcad.core.records import Notice, texts
from gearcad.geometry import Gear, GearPair
from gearcad.verification.claims import Claim, ClaimSubject, VerificationLevel, counted, passed

Content = Mapping[str, Any]
"""Part of a JSON document."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Verification:
    """Result of a verification of the design `name`: its claims, and the files (bytes by name) that were judged.

    `spec` are the inputs of the design, `judges` the versions of the programs that judged, by their names. `strength` is the
    verdict of the rating: None where it was not asked for or not judged. `heading` has company, project, author and date by
    their words, `pictured` is the gear or pair that a report shows.
    """

    name: str
    level: VerificationLevel
    claims: Sequence[Claim]
    contents: Mapping[str, bytes]
    spec: Content
    judges: Mapping[str, str]
    strength: bool | None = None
    notices: Sequence[Notice] = ()
    heading: Mapping[str, str] = field(default_factory=dict)
    pictured: Gear | GearPair | None = None

    @property
    def passed(self) -> bool | None:
        """Verdict on all claims but those on strength, which have their own: None if nothing was judged."""
        return passed(claim for claim in self.claims if claim.subject is not ClaimSubject.STRENGTH)

    @property
    def failed(self) -> list[Claim]:
        """Claims that failed."""
        return [claim for claim in self.claims if claim.passed is False]

    @property
    def not_judged(self) -> list[Claim]:
        """Claims that nothing judged."""
        return [claim for claim in self.claims if claim.passed is None]

    @property
    def hashes(self) -> dict[str, str]:
        """SHA-256 of each file, by its name."""
        return {name: hashlib.sha256(content).hexdigest() for name, content in self.contents.items()}

    def to_dict(self) -> dict[str, Any]:
        """Return the content of verify.json after kind, name and version."""
        return {
            "level": self.level.value,
            "passed": self.passed,
            "strength": self.strength,
            "not_judged": [f"{claim.subject.value}: {claim.quantity}: {claim.reason}" for claim in self.not_judged],
            "warnings": texts(self.notices),
            "counts": dict(counted(self.claims)),
            "judges": dict(self.judges),
            "files": self.hashes,
            "spec": dict(self.spec),
            "claims": [claim.to_dict() for claim in self.claims],
        }

    def __repr__(self) -> str:
        counts = counted(self.claims)
        said = ", ".join(f"{count} {words}" for words, count in counts.items())
        return f"<Verification of {self.name!r} at level {self.level.value}: {said}>"
