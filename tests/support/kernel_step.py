"""STEP by the CAD kernel's own writer, as a witness: of solids of the kernel, and of assemblies of CadQuery."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import cadquery
from OCP.IFSelect import IFSelect_RetDone
from OCP.Interface import Interface_Static
from OCP.Quantity import Quantity_Color, Quantity_TOC_RGB
from OCP.STEPCAFControl import STEPCAFControl_Controller, STEPCAFControl_Reader, STEPCAFControl_Writer
from OCP.STEPControl import STEPControl_StepModelType
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDocStd import TDocStd_Document
from OCP.XCAFApp import XCAFApp_Application
from OCP.XCAFDoc import XCAFDoc_ColorGen, XCAFDoc_ColorSurf, XCAFDoc_DocumentTool, XCAFDoc_ShapeTool

from gearcad.solids.colours import STEEL

__all__ = ["new_document", "opened_document", "write_by_kernel"]

_SETTINGS = {"write.surfacecurve.mode": 0, "write.precision.mode": 0}


def write_by_kernel(model: cadquery.Assembly | cadquery.Solid, path: Path, name: str) -> None:
    """Write a solid as one part of the colour of steel, or an assembly whose alike parts are one product."""
    STEPCAFControl_Controller.Init_s()
    before = {setting: Interface_Static.IVal_s(setting) for setting in _SETTINGS}
    schema = Interface_Static.CVal_s("write.step.schema")
    try:
        for setting, value in _SETTINGS.items():
            Interface_Static.SetIVal_s(setting, value)
        Interface_Static.SetCVal_s("write.step.schema", "AP214IS")
        writer = STEPCAFControl_Writer()
        writer.SetColorMode(True)
        writer.SetNameMode(True)
        document = _assembled(model) if isinstance(model, cadquery.Assembly) else _part(model, name)
        assert writer.Transfer(document, STEPControl_StepModelType.STEPControl_AsIs)
        assert writer.Write(str(path)) == IFSelect_RetDone
    finally:
        for setting, value in before.items():
            Interface_Static.SetIVal_s(setting, value)
        Interface_Static.SetCVal_s("write.step.schema", schema)


def opened_document(path: Path) -> Any:
    """A document (XCAF) of all that a file has, read by the kernel."""
    document, reader = new_document(), STEPCAFControl_Reader()
    reader.SetNameMode(True)
    reader.SetColorMode(True)
    assert reader.ReadFile(str(path)) == IFSelect_RetDone
    assert reader.Transfer(document)
    return document


def new_document() -> Any:
    """An empty document (XCAF)."""
    document = TDocStd_Document(TCollection_ExtendedString("BinXCAF"))
    XCAFApp_Application.GetApplication_s().InitDocument(document)
    return document


def _part(solid: cadquery.Solid, name: str) -> Any:
    document = new_document()
    label = XCAFDoc_DocumentTool.ShapeTool_s(document.Main()).AddShape(solid.wrapped, False)
    _name(label, name)
    colour = Quantity_Color(*STEEL, Quantity_TOC_RGB)
    XCAFDoc_DocumentTool.ColorTool_s(document.Main()).SetColor(label, colour, XCAFDoc_ColorGen)
    return document


def _assembled(assembly: cadquery.Assembly) -> Any:
    document = new_document()
    shapes = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    XCAFDoc_ShapeTool.SetAutoNaming_s(False)
    _node(document, shapes, assembly, {})
    shapes.UpdateAssemblies()
    return document


def _node(document: Any, shapes: Any, node: cadquery.Assembly, parts: dict[Any, Any]) -> Any:
    label = shapes.NewShape()
    _name(label, _product_name(node))
    for child in node.children:
        product = _node(document, shapes, child, parts) if child.children else _child(document, shapes, child, parts)
        _name(shapes.AddComponent(label, product, child.loc.wrapped), child.name)
    return label


def _child(document: Any, shapes: Any, node: cadquery.Assembly, parts: dict[Any, Any]) -> Any:
    key = _product_name(node), node.obj, node.color
    if key not in parts:
        label = parts[key] = shapes.NewShape()
        shapes.SetShape(label, cadquery.Compound.makeCompound(node.shapes).wrapped)
        _name(label, _product_name(node))
        if node.color is not None:
            XCAFDoc_DocumentTool.ColorTool_s(document.Main()).SetColor(label, node.color.wrapped, XCAFDoc_ColorSurf)
    return parts[key]


def _product_name(node: cadquery.Assembly) -> str:
    return str(node.metadata.get("product", node.name))


def _name(label: Any, name: str) -> None:
    TDataStd_Name.Set_s(label, TCollection_ExtendedString(name))
