"""What a STEP file has for the CAD kernel: a document of it."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from OCP.IFSelect import IFSelect_RetDone
from OCP.STEPCAFControl import STEPCAFControl_Reader
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDocStd import TDocStd_Document
from OCP.XCAFApp import XCAFApp_Application


def opened_document(path: Path) -> Any:
    """A document (XCAF) of all that a file has, read by the kernel."""
    document, reader = TDocStd_Document(TCollection_ExtendedString("BinXCAF")), STEPCAFControl_Reader()
    XCAFApp_Application.GetApplication_s().InitDocument(document)
    reader.SetNameMode(True)
    reader.SetColorMode(True)
    assert reader.ReadFile(str(path)) == IFSelect_RetDone
    assert reader.Transfer(document)
    return document
