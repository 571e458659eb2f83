"""Documents of CAD (XCAF): a solid or an assembly as products, each made once, and their occurrences."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from gearcad.solids.colours import STEEL
from gearcad.solids.exact.cad import product_name

if TYPE_CHECKING:
    import cadquery

__all__ = ["assembly_document", "part_document"]

Naming = Callable[[str], str]
"""What stands for a name in the document."""


def part_document(shape: cadquery.Shape, name: str) -> Any:
    """A document that holds one named part, in the colour of steel."""
    import cadquery
    from OCP.Quantity import Quantity_Color, Quantity_TOC_RGB
    from OCP.XCAFDoc import XCAFDoc_ColorGen, XCAFDoc_DocumentTool

    if not shape.wrapped.Location().IsIdentity():  # the kernel makes an assembly of what stands elsewhere
        shape = cadquery.Compound.makeCompound([shape])
    document = _new("XmlXCAF")
    label = XCAFDoc_DocumentTool.ShapeTool_s(document.Main()).AddShape(shape.wrapped, False)
    _name(label, name)
    _colour(document, label, Quantity_Color(*STEEL, Quantity_TOC_RGB), XCAFDoc_ColorGen)
    return document


def assembly_document(assembly: cadquery.Assembly, naming: Naming) -> Any:
    """A document of an assembly; parts of one solid, colour and product name are one product, however many there are.

    The metadata of a part, or of a sub-assembly, may have its product name, which is else its own.
    """
    document = _new("BinXCAF")
    _Tree(document, naming).add(assembly)
    return document


class _Tree:
    """Products of a document while it grows."""

    def __init__(self, document: Any, naming: Naming) -> None:
        from OCP.XCAFDoc import XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

        self._document, self._naming = document, naming
        self._shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
        XCAFDoc_ShapeTool.SetAutoNaming_s(False)
        self._parts: dict[Any, Any] = {}

    def add(self, assembly: cadquery.Assembly) -> None:
        """The top of the tree."""
        self._assembly(assembly)
        self._shapes.UpdateAssemblies()

    def _assembly(self, node: cadquery.Assembly) -> Any:
        label = self._shapes.NewShape()
        _name(label, self._naming(product_name(node)))
        for child in node.children:
            product = self._assembly(child) if child.children else self._part(child)
            occurrence = self._shapes.AddComponent(label, product, child.loc.wrapped)
            _name(occurrence, self._naming(child.name))
        return label

    def _part(self, node: cadquery.Assembly) -> Any:
        from cadquery import Compound
        from OCP.XCAFDoc import XCAFDoc_ColorSurf

        key = product_name(node), node.obj, node.color
        if key not in self._parts:
            label = self._parts[key] = self._shapes.NewShape()
            self._shapes.SetShape(label, Compound.makeCompound(node.shapes).wrapped)
            _name(label, self._naming(product_name(node)))
            if node.color is not None:
                _colour(self._document, label, node.color.wrapped, XCAFDoc_ColorSurf)
        return self._parts[key]


def _new(format_name: str) -> Any:
    from OCP.TCollection import TCollection_ExtendedString
    from OCP.TDocStd import TDocStd_Document
    from OCP.XCAFApp import XCAFApp_Application

    document = TDocStd_Document(TCollection_ExtendedString(format_name))
    XCAFApp_Application.GetApplication_s().InitDocument(document)
    return document


def _name(label: Any, name: str) -> None:
    from OCP.TCollection import TCollection_ExtendedString
    from OCP.TDataStd import TDataStd_Name

    TDataStd_Name.Set_s(label, TCollection_ExtendedString(name))


def _colour(document: Any, label: Any, colour: Any, kind: Any) -> None:
    from OCP.XCAFDoc import XCAFDoc_DocumentTool

    XCAFDoc_DocumentTool.ColorTool_s(document.Main()).SetColor(label, colour, kind)
