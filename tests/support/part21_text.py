"""Is a text well formed by ISO 10303-21, and whole: a reader of its own, which knows nothing of geometry."""

from __future__ import annotations

import re
from collections import Counter
from dataclasses import dataclass

_TOKEN = re.compile(
    r"\s*(?:(?P<string>'(?:[^'\\\x00-\x1f\x7f-\U0010ffff]|''|\\\\|\\X\\[0-9A-F]{2}|\\X2\\(?:[0-9A-F]{4})+\\X0\\|\\X4\\(?:[0-9A-F]{8})+\\X0\\)*')"
    r"|(?P<reference>#[1-9][0-9]*)|(?P<real>[+-]?[0-9]+\.[0-9]*(?:E[+-]?[0-9]+)?)|(?P<integer>[+-]?[0-9]+)"
    r"|(?P<enumeration>\.[A-Z][A-Z0-9_]*\.)|(?P<keyword>[A-Z][A-Z0-9_]*)|(?P<mark>[()=,;*$]))"
)
"""6.3 and 6.4: what may stand in the data section, once comments are ruled out."""

_PARAMETERS = {
    "ADVANCED_BREP_SHAPE_REPRESENTATION": 3, "ADVANCED_FACE": 4, "APPLICATION_CONTEXT": 1, "APPLICATION_PROTOCOL_DEFINITION": 4,
    "AXIS2_PLACEMENT_3D": 4, "B_SPLINE_CURVE_WITH_KNOTS": 9, "B_SPLINE_SURFACE_WITH_KNOTS": 13, "CARTESIAN_POINT": 2,
    "CIRCLE": 3, "CLOSED_SHELL": 2, "COLOUR_RGB": 4, "CONICAL_SURFACE": 4, "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION": 2,
    "CYLINDRICAL_SURFACE": 3, "DIRECTION": 2, "EDGE_CURVE": 5, "EDGE_LOOP": 2, "ELLIPSE": 4, "FACE_BOUND": 3,
    "FILL_AREA_STYLE": 2, "FILL_AREA_STYLE_COLOUR": 2, "GEOMETRIC_REPRESENTATION_CONTEXT": 1,
    "GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT": 1, "GLOBAL_UNIT_ASSIGNED_CONTEXT": 1, "ITEM_DEFINED_TRANSFORMATION": 4,
    "LENGTH_MEASURE": 1, "LENGTH_UNIT": 0, "LINE": 3, "MANIFOLD_SOLID_BREP": 2,
    "MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION": 3, "NAMED_UNIT": 1, "NEXT_ASSEMBLY_USAGE_OCCURRENCE": 6,
    "ORIENTED_EDGE": 5, "PLANE": 2, "PLANE_ANGLE_UNIT": 0, "PRESENTATION_STYLE_ASSIGNMENT": 1, "PRODUCT": 4,
    "PRODUCT_CONTEXT": 3, "PRODUCT_DEFINITION": 4, "PRODUCT_DEFINITION_CONTEXT": 3, "PRODUCT_DEFINITION_FORMATION": 3,
    "PRODUCT_DEFINITION_SHAPE": 3, "PRODUCT_RELATED_PRODUCT_CATEGORY": 3, "REPRESENTATION_CONTEXT": 2,
    "REPRESENTATION_RELATIONSHIP": 4, "REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION": 1,
    "SHAPE_DEFINITION_REPRESENTATION": 2,
    "SHAPE_REPRESENTATION": 3, "SHAPE_REPRESENTATION_RELATIONSHIP": 0, "SI_UNIT": 2, "SOLID_ANGLE_UNIT": 0, "STYLED_ITEM": 3,
    "SURFACE_SIDE_STYLE": 2, "SURFACE_STYLE_FILL_AREA": 1, "SURFACE_STYLE_USAGE": 2, "UNCERTAINTY_MEASURE_WITH_UNIT": 4,
    "VECTOR": 3, "VERTEX_POINT": 2,
}  # fmt: skip
"""Entities of AP214 that solids and assemblies need, and how many parameters each has."""

_TOP = {
    "APPLICATION_PROTOCOL_DEFINITION", "CONTEXT_DEPENDENT_SHAPE_REPRESENTATION", "PRODUCT_RELATED_PRODUCT_CATEGORY",
    "MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION", "SHAPE_DEFINITION_REPRESENTATION",
}  # fmt: skip
"""Those that nothing refers to."""


@dataclass(frozen=True)
class CheckedText:
    """How many entities of each kind there are, and how long the longest line is."""

    kinds: Counter[str]
    longest: int


def checked_text(text: str) -> CheckedText:
    """Check a file: AssertionError where it is none."""
    head, data = text.split("DATA;\n")
    assert text.isascii()
    assert head.startswith("ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(") and head.endswith("ENDSEC;\n")
    data, end = data.rsplit("ENDSEC;\n", 1)
    assert end == "END-ISO-10303-21;\n"
    defined, referred, kinds = set[str](), set[str](), Counter[str]()
    for number, kind, references in _entities(data):
        assert number not in defined, f"{number} twice"
        defined.add(number)
        referred |= references
        kinds[kind] += 1
        if kind in _TOP:
            referred.add(number)
    assert referred == defined, (sorted(referred - defined)[:5], sorted(defined - referred)[:5])
    return CheckedText(kinds, max(map(len, text.splitlines())))


def _entities(data: str) -> list[tuple[str, str, set[str]]]:
    """Number, kind and references of each entity."""
    found, tokens, at = [], list[tuple[str, str]](), 0
    data = data.rstrip()
    while at < len(data):
        match = _TOKEN.match(data, at)
        assert match is not None, data[at : at + 60]
        at = match.end()
        assert match.lastgroup is not None
        if match[match.lastgroup] == ";":
            found.append(_entity(tokens))
            tokens = []
        else:
            tokens.append((match.lastgroup, match[match.lastgroup]))
    assert not tokens
    return found


def _entity(tokens: list[tuple[str, str]]) -> tuple[str, str, set[str]]:
    (kind, number), (_, equals), *rest = tokens
    assert (kind, equals) == ("reference", "="), tokens[:4]
    words = [text for kind, text in rest if kind == "keyword"]
    assert words and set(words) <= set(_PARAMETERS), words
    names = rest[1:-1] if rest[0][1] == "(" else rest  # several types at once
    at = 0
    while at < len(names):
        assert names[at][0] == "keyword", names[at]
        at = _instance(names, at)
    name = "" if rest[0][1] == "(" else words[0]
    return number, name, {text for kind, text in rest if kind == "reference"}


def _instance(tokens: list[tuple[str, str]], at: int) -> int:
    """Behind a type and its parameters, which are as many as it has."""
    name, depth, count, empty = tokens[at][1], 0, 0, True
    assert tokens[at + 1][1] == "("
    for place in range(at + 1, len(tokens)):
        text = tokens[place][1]
        if text == "(" or (tokens[place][0] == "keyword"):
            depth += text == "("
            empty = empty and depth < 2
        elif text == ")":
            depth -= 1
            if depth == 0:
                assert count + (not empty) == _PARAMETERS[name], (name, count, tokens[at : place + 1])
                return place + 1
        elif text == "," and depth == 1:
            count += 1
        else:
            empty = False
    raise AssertionError(f"{name} has no end")
