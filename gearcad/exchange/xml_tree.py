"""Trees of XML from files that nobody vouches for: without document types and entities, of limited depth and size.

Such a file can neither grow in memory nor ask for other files.
"""

from __future__ import annotations

from collections.abc import Iterator
from xml.parsers import expat

from gearcad.core.errors import SpecError

DEEPEST = 12
"""Elements inside each other: those of REXS go six deep."""

_MOST_ELEMENTS = 400_000


class XmlElement:
    """An element of XML: its name without a namespace, its attributes, its children and its text."""

    __slots__ = ("attributes", "children", "name", "parts")

    def __init__(self, name: str, attributes: dict[str, str]) -> None:
        self.name, self.attributes = name, attributes
        self.children: list[XmlElement] = []
        self.parts: list[str] = []

    @property
    def text(self) -> str:
        """Text without the spaces around it."""
        return "".join(self.parts).strip()

    def all(self, name: str) -> Iterator[XmlElement]:
        """Yield the children of a name."""
        return (each for each in self.children if each.name == name)


class _TreeReader:
    """Handlers of the parser: they make a tree of elements, and refuse what REXS does not have."""

    def __init__(self, file: str) -> None:
        self.file, self.count = file, 0
        self.root: XmlElement | None = None
        self.open: list[XmlElement] = []

    def begin(self, name: str, attributes: dict[str, str]) -> None:
        """Begin an element."""
        self.count += 1
        if self.count > _MOST_ELEMENTS or len(self.open) >= DEEPEST:
            permitted = f"at most {_MOST_ELEMENTS:,} elements, {DEEPEST} of them inside each other, are read"
            raise SpecError(f"{self.file}: is too large or too deep: {permitted}")
        element = XmlElement(name.rpartition("}")[2], attributes)
        if self.open:
            self.open[-1].children.append(element)
        else:
            self.root = element
        self.open.append(element)

    def end(self, _name: str) -> None:
        """End the innermost element."""
        self.open.pop()

    def characters(self, text: str) -> None:
        """Add text to the innermost element."""
        self.open[-1].parts.append(text)

    def refuse(self, *_declared: object) -> None:
        """Refuse a document type, with which entities come."""
        raise SpecError(f"{self.file}: has a document type or entities, which files of REXS do not have: take them out")


def xml_tree(content: bytes, file: str) -> XmlElement:
    """Return the tree of an XML text. Raises SpecError."""
    reader, parser = _TreeReader(file), expat.ParserCreate(namespace_separator="}")
    parser.StartElementHandler, parser.EndElementHandler = reader.begin, reader.end
    parser.CharacterDataHandler = reader.characters
    parser.StartDoctypeDeclHandler = parser.EntityDeclHandler = reader.refuse
    try:
        parser.Parse(content, True)
    except expat.ExpatError as error:
        why = expat.errors.messages.get(error.code, "syntax error")
        raise SpecError(f"{file}, line {error.lineno}: is no XML that can be read ({why})") from error
    except (ValueError, LookupError) as error:
        if isinstance(error, SpecError):
            raise
        raise SpecError(f"{file}: its encoding cannot be read: save it as UTF-8") from error
    assert reader.root is not None
    return reader.root
