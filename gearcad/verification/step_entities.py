"""Entities of STEP files: which solids of two files are the same, entity for entity, and a file without known solids.

The CAD kernel takes longest to make the faces of a solid. A solid of an assembly that is the same, entity for entity, as that
of a part's file needs no second judgement: the kernel reads the text of the whole assembly, and makes its tree from a copy in
which a sphere stands for each known solid.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

from gearcad.verification.claims import Claim

_REFERENCE = re.compile(rb"#(\d+)")

_SOLID = b"MANIFOLD_SOLID_BREP("

_SPHERE = (
    "CARTESIAN_POINT('',(0.,0.,0.))",
    "DIRECTION('',(0.,0.,1.))",
    "DIRECTION('',(1.,0.,0.))",
    "AXIS2_PLACEMENT_3D('',#{0},#{1},#{2})",
    "SPHERICAL_SURFACE('',#{3},{radius}.)",
    "CARTESIAN_POINT('',(0.,0.,{radius}.))",
    "VERTEX_POINT('',#{5})",
    "VERTEX_LOOP('',#{6})",
    "FACE_BOUND('',#{7},.T.)",
    "ADVANCED_FACE('',(#{8}),#{4},.T.)",
    "CLOSED_SHELL('',(#{9}))",
)
"""Entities of the shell that stands for a solid; numbers in braces are those of entities before it."""

_SAME = 1e-6
"""Relative difference of the volume of a sphere by which it is known."""


@dataclass(frozen=True, eq=False)
class StepEntities:
    """Entities of one file by their numbers: texts, numbers of the entities that they refer to, and forms.

    `head` and `tail` are the texts before and after them. Two entities have the same form if the texts of both, and of all
    that they refer to, are the same but for the numbers.
    """

    head: bytes
    tail: bytes
    texts: Mapping[int, bytes]
    references: Mapping[int, tuple[int, ...]]
    forms: Mapping[int, int]

    @cached_property
    def solids(self) -> list[int]:
        """Numbers of the solids."""
        return [number for number, text in self.texts.items() if text.startswith(_SOLID)]

    def without_solids(self) -> bytes:
        """Return the file with a sphere in place of the shell of each solid: radius 1 mm for the first, 2 mm for the next."""
        solids = self.solids
        shells = {shell for solid in solids for shell in self.references[solid]}
        inside, kept = set(shells), set[int]()
        downwards = list(self.texts)[::-1]  # each refers to those before it
        for number in downwards:
            if number in inside:
                inside.update(self.references[number])
        for number in downwards:
            if number in kept or number not in inside:
                kept.add(number)
                kept.update(() if number in solids else self.references[number])
        texts = {number: text for number, text in self.texts.items() if number in kept}
        first = max(self.texts) + 1
        for place, solid in enumerate(solids):
            numbers = list(range(first, first + len(_SPHERE)))
            for number, text in zip(numbers, _SPHERE, strict=True):
                texts[number] = text.format(*numbers, radius=place + 1).encode()
            texts[solid] = re.sub(_REFERENCE, b"#%d" % numbers[-1], self.texts[solid])
            first += len(_SPHERE)
        lines = (b"#%d=%b;\n" % entity for entity in texts.items())
        return b"".join([self.head, *lines, self.tail])


@dataclass(frozen=True)
class JudgedSolids:
    """Solids that were judged in the files of one design: their claims by form and product. Files are read one by one."""

    claims: dict[tuple[int, str], Sequence[Claim]] = field(default_factory=dict)
    _forms: dict[tuple[bytes | int, ...], int] = field(default_factory=dict)

    def read(self, content: bytes) -> StepEntities | None:
        """Return the entities of a file; None where their numbers are not unique, or an entity comes before one it needs."""
        start, end = content.find(b"DATA;\n") + len(b"DATA;\n"), content.rfind(b"ENDSEC;")
        if not len(b"DATA;\n") <= start < end:
            return None
        texts: dict[int, bytes] = {}
        references: dict[int, tuple[int, ...]] = {}
        forms: dict[int, int] = {}
        known = self._forms
        for line in content[start:end].split(b";\n")[:-1]:
            name, _, text = line.partition(b"=")
            if not (name.startswith(b"#") and name[1:].isdigit()) or (number := int(name[1:])) in texts:
                return None
            form: tuple[bytes | int, ...] = (text,)
            references[number] = ()
            if b"#" in text:
                pieces = _REFERENCE.split(text)
                references[number] = used = tuple(map(int, pieces[1::2]))
                try:
                    form = (*pieces[::2], *[forms[each] for each in used])
                except KeyError:
                    return None
            texts[number] = text
            forms[number] = known.setdefault(form, len(known))
        return StepEntities(content[:start], content[end:], texts, references, forms)

    def known(self, entities: StepEntities | None, products: Sequence[str]) -> bool:
        """Return whether every solid of a file was judged, as one of these products."""
        if entities is None or not entities.solids:
            return False
        known = {form for form, product in self.claims if product in products}
        return all(entities.forms[solid] in known for solid in entities.solids)

    def of_sphere(self, entities: StepEntities, volume: float, product: str, where: str) -> list[Claim] | None:
        """Return the claims about the solid for which a sphere of this volume (mm³) stands, None where there is none."""
        radius = round((3 * abs(volume) / (4 * math.pi)) ** (1 / 3))
        solids = entities.solids
        if not 0 < radius <= len(solids) or abs(volume / (4 / 3 * math.pi * radius**3) - 1) > _SAME:
            return None
        claims = self.claims.get((entities.forms[solids[radius - 1]], product))
        return None if claims is None else [replace(claim, where=where) for claim in claims]
