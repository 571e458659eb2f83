"""STEP files (AP214, mm): named and coloured parts, each there once however often it occurs; equal bytes for equal input."""

from __future__ import annotations

from itertools import count
from pathlib import Path
from typing import TYPE_CHECKING

from gearcad.solids.colours import BRIGHT_STEEL, Colour
from gearcad.solids.exact.forms import Frame
from gearcad.solids.exact.products import AssembledProduct, Occurrence, Product, SolidProduct
from gearcad.solids.files import part21
from gearcad.solids.files.part21 import DataSection, listed, real
from gearcad.solids.files.step_solid import frame_entity, solid_entity

if TYPE_CHECKING:
    import cadquery

__all__ = ["write_product", "write_step"]

_ASSEMBLED = 1e-6
"""How far (mm) places of an assembly may differ."""

_WORLD = Frame((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0))


def write_step(model: cadquery.Assembly | cadquery.Solid, path: Path | str, *, name: str) -> None:
    """Write a solid, as one part called `name`, or an assembly, which has names of its own, to `path` (STEP AP214, mm).

    What was made here is written as `write_product` has it, what was gone on with in CadQuery by the CAD kernel. Names may
    hold any character; the time stamp is that of `part21.header`. Raises SolverError if the kernel cannot write, ParameterError
    for a date that is none, and OSError if the file cannot be written.
    """
    from gearcad.solids.exact.cad import cad_product

    product = cad_product(model, name, BRIGHT_STEEL)
    if product is not None:
        write_product(product, path)
        return
    from gearcad.solids.files.step_kernel import write_by_kernel

    write_by_kernel(model, path, name)


def write_product(product: Product, path: Path | str) -> None:
    """Write a part or an assembly to `path`. Names may hold any character; the time stamp is that of `part21.header`.

    Numbers read back to the last bit. Curves in the parameters of surfaces are left out: readers make them again.
    """
    writer = _StepWriter()
    writer.product(product)
    text = f"ISO-10303-21;\n{part21.header(product.name)}{writer.data.text()}END-ISO-10303-21;\n"
    Path(path).write_bytes(text.encode("ascii"))


class _StepWriter:
    """Writes products, and what all products of a file share."""

    def __init__(self) -> None:
        self.data, self.number = DataSection(), count(1)
        self.made: dict[Product, tuple[int, int]] = {}
        add = self.data.add
        self.application = add("APPLICATION_CONTEXT('core data for automotive mechanical design processes')")
        add(f"APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2000,#{self.application})")
        self.discipline = add(f"PRODUCT_CONTEXT('',#{self.application},'mechanical')")
        self.stage = add(f"PRODUCT_DEFINITION_CONTEXT('part definition',#{self.application},'design')")
        self.units = (
            add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))"),
            add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))"),
            add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())"),
        )

    def product(self, product: Product) -> tuple[int, int]:
        """Write a product, once; the numbers of its definition and of its shape representation."""
        if product not in self.made:
            definition = self._definition(product.name)
            if isinstance(product, SolidProduct):
                self.made[product] = definition, self._solid(product, definition)
            else:
                self.made[product] = definition, self._assembly(product, definition)
        return self.made[product]

    def _definition(self, name: str) -> int:
        add, called = self.data.add, part21.string(name)
        product = add(f"PRODUCT({called},{called},'',(#{self.discipline}))")
        add(f"PRODUCT_RELATED_PRODUCT_CATEGORY('part',$,(#{product}))")
        formation = add(f"PRODUCT_DEFINITION_FORMATION('','',#{product})")
        return add(f"PRODUCT_DEFINITION('design','',#{formation},#{self.stage})")

    def _context(self, tolerance: float) -> int:
        """Space in mm and rad, in which lengths (mm) may differ by the tolerance."""
        measure = f"LENGTH_MEASURE({real(tolerance)}),#{self.units[0]},'distance_accuracy_value','confusion accuracy'"
        uncertainty = self.data.shared(f"UNCERTAINTY_MEASURE_WITH_UNIT({measure})")
        return self.data.shared(
            f"(GEOMETRIC_REPRESENTATION_CONTEXT(3)\nGLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#{uncertainty}))\n"
            f"GLOBAL_UNIT_ASSIGNED_CONTEXT(({listed(self.units)}))\n"
            "REPRESENTATION_CONTEXT('Context #1','3D Context with UNIT and UNCERTAINTY'))"
        )

    def _shape(self, definition: int, representation: int) -> None:
        """That a representation is the shape of a product."""
        shape = self.data.add(f"PRODUCT_DEFINITION_SHAPE('','',#{definition})")
        self.data.add(f"SHAPE_DEFINITION_REPRESENTATION(#{shape},#{representation})")

    def _solid(self, product: SolidProduct, definition: int) -> int:
        context = self._context(product.boundary.tolerance)
        solid, world = solid_entity(self.data, product.boundary), frame_entity(self.data, _WORLD)
        representation = self.data.add(f"ADVANCED_BREP_SHAPE_REPRESENTATION('',(#{world},#{solid}),#{context})")
        self._shape(definition, representation)
        if product.colour is not None:
            self._paint(solid, product.colour, context)
        return representation

    def _paint(self, solid: int, colour: Colour, context: int) -> None:
        """The colour of a solid, on both sides of its faces."""
        add = self.data.add
        shade = self.data.shared(f"COLOUR_RGB('',{','.join(real(share) for share in colour)})")
        filling = add(f"FILL_AREA_STYLE_COLOUR('',#{shade})")
        fill = add(f"FILL_AREA_STYLE('',(#{filling}))")
        area = add(f"SURFACE_STYLE_FILL_AREA(#{fill})")
        side = add(f"SURFACE_SIDE_STYLE('',(#{area}))")
        usage = add(f"SURFACE_STYLE_USAGE(.BOTH.,#{side})")
        style = add(f"PRESENTATION_STYLE_ASSIGNMENT((#{usage}))")
        styled = add(f"STYLED_ITEM('color',(#{style}),#{solid})")
        add(f"MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',(#{styled}),#{context})")

    def _assembly(self, product: AssembledProduct, definition: int) -> int:
        parts = [self.product(occurrence.product) for occurrence in product.occurrences]
        world = frame_entity(self.data, _WORLD)
        frames = [frame_entity(self.data, occurrence.frame) for occurrence in product.occurrences]
        context = self._context(_ASSEMBLED)
        items = listed(list(dict.fromkeys([world, *frames])))
        representation = self.data.add(f"SHAPE_REPRESENTATION('',({items}),#{context})")
        self._shape(definition, representation)
        for occurrence, part, frame in zip(product.occurrences, parts, frames, strict=True):
            self._occur(occurrence, part, (definition, representation), (world, frame))
        return representation

    def _occur(self, occurrence: Occurrence, part: tuple[int, int], whole: tuple[int, int], frames: tuple[int, int]) -> None:
        """That a product occurs in an assembly: where its origin is, and what it is called there."""
        add = self.data.add
        move = add(f"ITEM_DEFINED_TRANSFORMATION('','',#{frames[0]},#{frames[1]})")
        relation = add(
            f"(REPRESENTATION_RELATIONSHIP('','',#{part[1]},#{whole[1]})\n"
            f"REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(#{move})\nSHAPE_REPRESENTATION_RELATIONSHIP())"
        )
        called = part21.string(occurrence.name)
        usage = add(f"NEXT_ASSEMBLY_USAGE_OCCURRENCE('{next(self.number)}',{called},'',#{whole[0]},#{part[0]},$)")
        shape = add(f"PRODUCT_DEFINITION_SHAPE('Placement','Placement of an item',#{usage})")
        add(f"CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(#{relation},#{shape})")
