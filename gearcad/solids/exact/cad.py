"""Boundaries and their assemblies as objects of CadQuery, to go on with in Python - and back."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from gearcad.solids.colours import Colour
from gearcad.solids.exact.boundary import Boundary
from gearcad.solids.exact.forms import Frame, vector
from gearcad.solids.exact.kernel import kernel_solid, local_axes
from gearcad.solids.exact.products import AssembledProduct, Occurrence, Product, SolidProduct

if TYPE_CHECKING:
    import cadquery

__all__ = ["cad_assembly", "cad_product", "cad_solid", "product_name"]

_MADE = "_gearcad_made"
"""The attribute of a solid of ours that holds what it was made of."""

_PRODUCT = "product"
"""In the metadata of a part of an assembly: what it is called as a product, where its own name is that of one of many."""


def cad_solid(boundary: Boundary) -> cadquery.Solid:
    """The solid of a boundary."""
    import cadquery

    made = kernel_solid(boundary)
    solid = cadquery.Solid(made)
    setattr(solid, _MADE, (made.Located(made.Location()), boundary))
    return solid


def cad_assembly(product: AssembledProduct) -> cadquery.Assembly:
    """An assembly, what is alike in it one solid."""
    return _assembly(product, {})


def _assembly(product: AssembledProduct, solids: dict[SolidProduct, cadquery.Solid]) -> cadquery.Assembly:
    import cadquery

    assembly = cadquery.Assembly(name=product.name)
    for occurrence in product.occurrences:
        name, made, place = occurrence.name, occurrence.product, _location(occurrence.frame)
        metadata = {_PRODUCT: made.name}
        if isinstance(made, AssembledProduct):
            inner = _assembly(made, solids)
            inner.name = name
            inner.metadata = metadata
            assembly.add(inner, loc=place)
            continue
        if made not in solids:
            solids[made] = cad_solid(made.boundary)
        colour = None if made.colour is None else cadquery.Color(*made.colour, 1.0)
        assembly.add(solids[made], name=name, loc=place, color=colour, metadata=metadata)
    return assembly


def _location(frame: Frame) -> cadquery.Location:
    import cadquery
    from OCP.gp import gp_Ax3, gp_Trsf

    place = gp_Trsf()
    place.SetDisplacement(gp_Ax3(), local_axes(frame))
    return cadquery.Location(place)


# ---------------------------------------------------------------------- and back


def cad_product(model: cadquery.Assembly | cadquery.Solid, name: str, colour: Colour) -> Product | None:
    """What a solid, as a part of a name and colour, or an assembly is made of; None where not all solids in it are ours."""
    import cadquery

    if isinstance(model, cadquery.Assembly):
        return _product_of(model, {})
    boundary = _boundary_of(model)
    return None if boundary is None else SolidProduct(name, boundary, colour)


def _product_of(node: cadquery.Assembly, parts: dict[Any, SolidProduct]) -> AssembledProduct | None:
    found = []
    for child in node.children:
        product = _product_of(child, parts) if child.children else _part_of(child, parts)
        if product is None:
            return None
        found.append(Occurrence(child.name, product, _frame(child.loc)))
    return AssembledProduct(product_name(node), tuple(found)) if node.obj is None else None


def _part_of(node: cadquery.Assembly, parts: dict[Any, SolidProduct]) -> SolidProduct | None:
    """Parts of one solid, colour and product name are one product."""
    boundary = _boundary_of(node.obj)
    if boundary is None:
        return None
    red, green, blue = (round(share, 6) for share in node.color.toTuple()[:3]) if node.color else (None, None, None)
    colour = None if red is None or green is None or blue is None else (red, green, blue)
    name = product_name(node)
    return parts.setdefault((name, boundary, colour), SolidProduct(name, boundary, colour))


def _boundary_of(solid: Any) -> Boundary | None:
    """What a solid was made of, if it is one of ours and stands where it stood then."""
    made, boundary = getattr(solid, _MADE, (None, None))
    return boundary if made is not None and solid.wrapped.IsEqual(made) else None


def product_name(node: cadquery.Assembly) -> str:
    """What a part of an assembly, or a sub-assembly, is called as a product."""
    return str(node.metadata.get(_PRODUCT, node.name))


def _frame(place: cadquery.Location) -> Frame:
    from OCP.gp import gp_Ax3

    axes = gp_Ax3().Transformed(place.wrapped.Transformation())
    origin, axis, along = (
        vector((each.X(), each.Y(), each.Z())) for each in (axes.Location(), axes.Direction(), axes.XDirection())
    )
    return Frame(origin, axis, along)
