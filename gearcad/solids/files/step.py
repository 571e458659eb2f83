"""STEP files (ISO 10303-21, AP214 or AP242, mm): named and coloured parts; equal bytes for equal input."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from datetime import datetime
from enum import Enum
from io import BytesIO
from itertools import count
from pathlib import Path
from threading import RLock
from typing import TYPE_CHECKING, Any

import numpy as np

from gearcad.core.errors import SolverError
from gearcad.core.output import source_date
from gearcad.core.records import Floats
from gearcad.solids.body_plan import BRIGHT_STEEL, STEEL, Colour
from gearcad.solids.exact.boundary import (
    BezierCurve,
    BezierSurface,
    Boundary,
    Chain,
    CircleCurve,
    ConeSurface,
    CurveForm,
    CylinderSurface,
    EllipseCurve,
    Frame,
    PlaneSurface,
    StraightLine,
    SurfaceForm,
    Vector,
)
from gearcad.solids.exact.solid import AssembledProduct, Occurrence, Product, SolidProduct, product_name
from gearcad.version import __version__

if TYPE_CHECKING:
    import cadquery


_RUNS = re.compile(r"[\x20-\x7e]+|[^\x20-\x7e\U00010000-\U0010ffff]+|[\U00010000-\U0010ffff]+")
"""Pattern of the runs of characters in a string: those written as they are, those with four hexadecimal digits, and those with
eight.
"""

_TO_A_LINE = 12
"""Number of references in one line of a file."""


class StepSchema(Enum):
    """Application protocol of a file; solids, names, colours and assemblies are the same entities in both."""

    AP214 = "AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }"
    AP242 = "AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF { 1 0 10303 442 1 1 4 }"

    @property
    def context(self) -> str:
        """Words of the application context."""
        return _CONTEXTS[self][0]

    @property
    def protocol(self) -> str:
        """Name and year of the protocol, as parameters of its definition."""
        return _CONTEXTS[self][1]

    @property
    def of_kernel(self) -> str:
        """Name that the CAD kernel has for it."""
        return _CONTEXTS[self][2]


_CONTEXTS = {
    StepSchema.AP214: ("core data for automotive mechanical design processes", "'automotive_design',2000", "AP214IS"),
    StepSchema.AP242: (
        "managed model based 3d engineering",
        "'ap242_managed_model_based_3d_engineering',2014",
        "AP242DIS",
    ),
}

_NO_DATE = datetime(2000, 1, 1)
"""Date in the header if none is set, so that files of equal input are equal."""


def string(text: str) -> str:
    r"""Return a text as a string of the exchange structure, on one line, so that no character is ever broken.

    ISO 10303-21:2016, 6.4.3: backslashes are doubled, \X2\...\X0\ holds characters of the basic plane and \X4\...\X0\ all
    others; the rest is ASCII. An apostrophe is \X\27, as Open CASCADE misreads one that is doubled before `)` or `,`.
    """
    return "'" + "".join(_run(run) for run in _RUNS.findall(text)) + "'"


def _run(run: str) -> str:
    if run.isascii() and run.isprintable():
        return run.replace("\\", "\\\\").replace("'", "\\X\\27")
    kind, digits = ("2", 4) if ord(run[0]) < 0x10000 else ("4", 8)
    return f"\\X{kind}\\" + "".join(f"{ord(character):0{digits}X}" for character in run) + "\\X0\\"


def real(value: float) -> str:
    """Return a number that reads back to the last bit: a REAL has a point, and a capital E before its power of ten (6.4.2)."""
    text = repr(float(value))
    if "e" not in text:
        return text
    mantissa, power = text.split("e")
    return f"{mantissa}{'' if '.' in mantissa else '.'}E{power}"


def listed(numbers: Sequence[int]) -> str:
    """References to entities, some to a line."""
    rows = (numbers[i : i + _TO_A_LINE] for i in range(0, len(numbers), _TO_A_LINE))
    return ",\n".join(",".join([f"#{number}" for number in row]) for row in rows)


class DataSection:
    """The data section while it grows: its entities have the numbers 1, 2, 3 ..."""

    def __init__(self) -> None:
        self._lines: list[str] = []
        self._shared: dict[str, int] = {}

    def add(self, entity: str) -> int:
        """Add an entity; its number."""
        self._lines.append(entity)
        return len(self._lines)

    def shared(self, entity: str) -> int:
        """Return the number of an entity that serves for all entities of equal text; add it if there is none."""
        number = self._shared.get(entity)
        if number is None:
            number = self._shared[entity] = self.add(entity)
        return number

    def text(self) -> str:
        """Return the whole section."""
        lines = [f"#{number}={entity};\n" for number, entity in enumerate(self._lines, 1)]
        return "DATA;\n" + "".join(lines) + "ENDSEC;\n"


def step_header(name: str, schema: StepSchema = StepSchema.AP214) -> str:
    """Return the header section of what is called `name`: of nobody, at SOURCE_DATE_EPOCH or else in the year 2000."""
    stamp = (source_date() or _NO_DATE).strftime("%Y-%m-%dT%H:%M:%S")
    of = [string(text) for text in (name, stamp, f"gearcad {__version__}", schema.value)]
    return (
        "HEADER;\n"
        f"FILE_DESCRIPTION(({of[0]}),'2;1');\n"
        f"FILE_NAME({of[0]},{of[1]},(''),(''),{of[2]},{of[2]},'');\n"
        f"FILE_SCHEMA(({of[3]}));\n"
        "ENDSEC;\n"
    )


_Form = CurveForm | SurfaceForm
_Text = Callable[[DataSection, list[int], list[int]], str]
"""The text of a form, of the numbers of its points and directions; adds what else it needs to the data."""


def solid_entity(data: DataSection, boundary: Boundary) -> int:
    """Add a boundary to the data; the number of its MANIFOLD_SOLID_BREP."""
    return _SolidWriter(data, boundary).solid()


def frame_entity(data: DataSection, frame: Frame) -> int:
    """Add an AXIS2_PLACEMENT_3D; its number."""
    origin = data.shared(_triple("CARTESIAN_POINT", frame.origin))
    axis, along = (data.shared(_triple("DIRECTION", direction)) for direction in (frame.axis, frame.along))
    return data.shared(f"AXIS2_PLACEMENT_3D('',#{origin},#{axis},#{along})")


def _triple(kind: str, values: Vector) -> str:
    text = "%r,%r,%r" % values  # noqa: UP031 - the quickest
    if "e" in text:
        text = ",".join(real(value) for value in values)
    return f"{kind}('',({text}))"


class _SolidWriter:
    """Writes one solid. What many edges and faces have in common is there once: points, directions, placements."""

    def __init__(self, data: DataSection, boundary: Boundary) -> None:
        self.data, self.boundary = data, boundary
        self.points: dict[Vector, int] = {}
        self.directions: dict[Vector, int] = {}
        angles = np.array([place.angle for place in boundary.places])
        self.cosines, self.sines = np.cos(angles), np.sin(angles)
        self.lifts = np.array([place.z for place in boundary.places])

    def solid(self) -> int:
        """Write the whole solid and return the number of its entity."""
        boundary, add = self.boundary, self.data.add
        vertices = [add(f"VERTEX_POINT('',#{self._point(point)})") for point in boundary.vertices]
        curves = self._placed((edge.curve, edge.place) for edge in boundary.edges)
        edges = [
            add(f"EDGE_CURVE('',#{vertices[edge.start]},#{vertices[edge.end]},#{curves[edge.curve, edge.place]},.T.)")
            for edge in boundary.edges
        ]
        surfaces = self._placed((face.surface, face.place) for face in boundary.faces)
        faces = []
        for surface, place, loops, outward in boundary.faces:
            sense = ".T." if outward else ".F."
            bounds = [add(f"FACE_BOUND('',#{self._loop(loop, edges)},{sense})") for loop in loops]
            faces.append(add(f"ADVANCED_FACE('',({listed(bounds)}),#{surfaces[surface, place]},{sense})"))
        shell = add(f"CLOSED_SHELL('',({listed(faces)}))")
        return add(f"MANIFOLD_SOLID_BREP('',#{shell})")

    def _loop(self, loop: Chain, edges: Sequence[int]) -> int:
        add = self.data.add
        run = [add(f"ORIENTED_EDGE('',*,*,#{edges[edge]},{'.T.' if along else '.F.'})") for edge, along in loop]
        return add(f"EDGE_LOOP('',({listed(run)}))")

    def _point(self, point: Vector) -> int:
        number = self.points.get(point)
        if number is None:
            number = self.points[point] = self.data.add(_triple("CARTESIAN_POINT", point))
        return number

    def _direction(self, direction: Vector) -> int:
        number = self.directions.get(direction)
        if number is None:
            number = self.directions[direction] = self.data.add(_triple("DIRECTION", direction))
        return number

    def _placed(self, uses: Iterable[tuple[_Form, int]]) -> dict[tuple[_Form, int], int]:
        """Return every form at every place where it is used, form by form: its points are turned to all places at once."""
        places: dict[_Form, dict[int, None]] = {}
        for form, place in uses:
            places.setdefault(form, {})[place] = None
        found = {}
        for form, used in places.items():
            points, directions, text = _parts(form)
            at = list(used)
            for place, turned, pointing in zip(at, self._turned(points, at, 1), self._turned(directions, at, 0), strict=True):
                numbers = [self._point((x, y, z)) for x, y, z in turned]
                axes = [self._direction((x, y, z)) for x, y, z in pointing]
                found[form, place] = self.data.add(text(self.data, numbers, axes))
        return found

    def _turned(self, vectors: Floats, at: list[int], lift: int) -> list[list[list[float]]]:
        """Return the vectors (n, 3) as they are at places, points lifted."""
        cosine, sine = self.cosines[at, None], self.sines[at, None]
        x, y, z = vectors.T
        turned = [cosine * x - sine * y, sine * x + cosine * y, z + lift * self.lifts[at, None]]
        found: list[list[list[float]]] = np.stack(turned, -1).tolist()
        return found


def _parts(form: _Form) -> tuple[Floats, Floats, _Text]:
    """Return the points (n, 3) and directions (m, 3) of a form, and its text of their numbers."""
    match form:
        case BezierCurve():
            return form.poles, np.empty((0, 3)), _bezier_curve(form)
        case BezierSurface():
            return form.poles.reshape(-1, 3), np.empty((0, 3)), _bezier_surface(form)
        case StraightLine(start, direction):
            return np.array([start]), np.array([direction]), _line
        case CircleCurve(frame, radius):
            return _framed(frame, "CIRCLE", radius)
        case EllipseCurve(frame, major, minor):
            return _framed(frame, "ELLIPSE", major, minor)
        case PlaneSurface(frame):
            return _framed(frame, "PLANE")
        case CylinderSurface(frame, radius):
            return _framed(frame, "CYLINDRICAL_SURFACE", radius)
        case ConeSurface(frame, radius, half_angle):
            return _framed(frame, "CONICAL_SURFACE", radius, half_angle)


def _framed(frame: Frame, kind: str, *sizes: float) -> tuple[Floats, Floats, _Text]:
    """Return a form that is its frame and some sizes."""
    last = "".join(f",{real(size)}" for size in sizes)

    def text(data: DataSection, points: list[int], directions: list[int]) -> str:
        axis, along = directions
        placement = data.shared(f"AXIS2_PLACEMENT_3D('',#{points[0]},#{axis},#{along})")
        return f"{kind}('',#{placement}{last})"

    return np.array([frame.origin]), np.array([frame.axis, frame.along]), text


def _line(data: DataSection, points: list[int], directions: list[int]) -> str:
    reach = data.shared(f"VECTOR('',#{directions[0]},1.)")
    return f"LINE('',#{points[0]},#{reach})"


def _bezier_curve(curve: BezierCurve) -> _Text:
    order = len(curve.poles)
    rest = f".UNSPECIFIED.,.F.,.F.,({order},{order}),({real(curve.first)},{real(curve.last)}),.PIECEWISE_BEZIER_KNOTS."

    def text(_data: DataSection, points: list[int], _directions: list[int]) -> str:
        return f"B_SPLINE_CURVE_WITH_KNOTS('',{order - 1},({listed(points)}),{rest})"

    return text


def _bezier_surface(surface: BezierSurface) -> _Text:
    rows, columns = surface.poles.shape[:2]
    knots = f"({rows},{rows}),({columns},{columns}),(0.,1.),({real(surface.low)},{real(surface.high)})"
    rest = f".UNSPECIFIED.,.F.,.F.,.F.,{knots},.PIECEWISE_BEZIER_KNOTS."

    def text(_data: DataSection, points: list[int], _directions: list[int]) -> str:
        net = ",\n".join(f"({listed(points[i : i + columns])})" for i in range(0, len(points), columns))
        return f"B_SPLINE_SURFACE_WITH_KNOTS('',{rows - 1},{columns - 1},({net}),{rest})"

    return text


Naming = Callable[[str], str]
"""Function from a name to the text that stands for it in the document."""


def part_document(shape: cadquery.Shape, name: str) -> Any:
    """Return a document that holds one named part, in the colour of steel."""
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
    """Return a document of an assembly; parts of one solid, colour and product name are one product, however many there are.

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


_HEADER = re.compile(rb"HEADER;.*?ENDSEC;\n", re.DOTALL)
_TOKEN = re.compile(rb"'gearcad-name-(\d+)'")
_OCCURRENCE = re.compile(rb"^(#\d+ = NEXT_ASSEMBLY_USAGE_OCCURRENCE\()'\d+'([^;]*;)", re.MULTILINE)
_LINE_BREAK = re.compile(rb"\n *")
_COLOUR_BLOCK = re.compile(
    rb"^#(\d+) = MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION\([^;]*;"
    rb"\s*#\d+ = STYLED_ITEM\('color',\([^)]*\),#(\d+)\);"
    rb".*?(?=^#\d+ = MECHANICAL_DESIGN|^ENDSEC)",
    re.DOTALL | re.MULTILINE,
)
_REFERENCE = re.compile(rb"#\d+")
_ENTITY = re.compile(rb"^(#\d+) = ", re.MULTILINE)

_kernel = RLock()
"""Held while the kernel's global settings are changed."""


def write_by_kernel(
    model: cadquery.Assembly | cadquery.Shape, path: Path | str, name: str, schema: StepSchema = StepSchema.AP214
) -> None:
    """Write a shape, as one part called `name`, or an assembly, which has names of its own.

    Running numbers are fixed, and the header. Raises what `write_step` raises.
    """
    import cadquery
    from OCP.IFSelect import IFSelect_RetDone
    from OCP.STEPCAFControl import STEPCAFControl_Writer
    from OCP.STEPControl import STEPControl_StepModelType

    names = _Names()
    with _settings(schema):
        writer = STEPCAFControl_Writer()
        writer.SetColorMode(True)
        writer.SetNameMode(True)
        assembled = isinstance(model, cadquery.Assembly)
        document = assembly_document(model, names.token) if assembled else part_document(model, names.token(name))
        transferred = writer.Transfer(document, STEPControl_StepModelType.STEPControl_AsIs)
        stream = BytesIO()  # the kernel is silent about a disk that is full, Python is not
        written = transferred and writer.WriteStream(stream) == IFSelect_RetDone
    if not written:
        raise SolverError(f"the CAD kernel could not write {path}")
    header = step_header(model.name if assembled else name, schema).encode("ascii")
    content = names.put_into(_reproducible(stream.getvalue()))
    Path(path).write_bytes(_HEADER.sub(lambda _: header, content, count=1))


class _Names:
    """Short tokens that stand for names while the kernel writes: it takes no care of characters when it breaks lines."""

    def __init__(self) -> None:
        self._names: list[str] = []

    def token(self, name: str) -> str:
        self._names.append(name)
        return f"gearcad-name-{len(self._names) - 1}"

    def put_into(self, content: bytes) -> bytes:
        """Return the content with names for tokens."""
        return _TOKEN.sub(lambda match: string(self._names[int(match[1])]).encode("ascii"), content)


@contextmanager
def _settings(schema: StepSchema) -> Iterator[None]:
    """The kernel's global settings of this module while it writes; afterwards the user's are back."""
    from OCP.Interface import Interface_Static
    from OCP.STEPCAFControl import STEPCAFControl_Controller

    numbers = {"write.surfacecurve.mode": 0, "write.precision.mode": 0}
    texts = {"write.step.schema": schema.of_kernel, "xstep.cascade.unit": "MM", "write.step.unit": "MM"}
    with _kernel:
        STEPCAFControl_Controller.Init_s()  # without a controller the settings do not exist yet
        before = {name: Interface_Static.IVal_s(name) for name in numbers}
        before_texts = {name: Interface_Static.CVal_s(name) for name in texts}
        try:
            _set(numbers, texts)
            yield
        finally:
            _set(before, before_texts)


def _set(numbers: dict[str, int], texts: dict[str, str]) -> None:
    from OCP.Interface import Interface_Static

    for setting, value in numbers.items():
        Interface_Static.SetIVal_s(setting, value)
    for setting, text in texts.items():
        Interface_Static.SetCVal_s(setting, text)


def _reproducible(content: bytes) -> bytes:
    """Return the content with occurrences numbered by file, a line each: the kernel numbers them through the whole session."""
    number = count(1)

    def numbered(occurrence: re.Match[bytes]) -> bytes:
        return occurrence[1] + b"'%d'" % next(number) + _LINE_BREAK.sub(b"", occurrence[2])

    return _sort_colours(_OCCURRENCE.sub(numbered, content))


def _sort_colours(content: bytes) -> bytes:
    """Order the colours at the end of the data by the entity they colour: the kernel's order is that of addresses in memory.

    Their entities are numbered anew. What parts of one colour share stands with one of them, whichever the kernel wrote first.
    """
    blocks = list(_COLOUR_BLOCK.finditer(content))
    if len(blocks) < 2:
        return content
    ordered = b"".join(block[0] for block in sorted(blocks, key=lambda block: int(block[2])))
    anew = {old: b"#%d" % number for number, old in enumerate(_ENTITY.findall(ordered), int(blocks[0][1]))}
    ordered = _REFERENCE.sub(lambda match: anew.get(match[0], match[0]), ordered)
    return content[: blocks[0].start()] + ordered + content[blocks[-1].end() :]


_ASSEMBLED = 1e-6
"""Largest difference (mm) between places of an assembly."""

_WORLD = Frame((0.0, 0.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0))


def write_step(
    model: cadquery.Assembly | cadquery.Solid, path: Path | str, *, name: str, schema: StepSchema = StepSchema.AP214
) -> None:
    """Write a solid, as one part called `name`, or an assembly, which has names of its own, to `path` (STEP, mm).

    What was made here is written as `write_product` has it, what was gone on with in CadQuery by the CAD kernel. Names may
    hold any character; the time stamp is that of `step_header`. Raises SolverError if the kernel cannot write, ParameterError
    for a date that is none, and OSError if the file cannot be written.
    """
    from gearcad.solids.exact.solid import cad_product

    product = cad_product(model, name, BRIGHT_STEEL)
    if product is not None:
        write_product(product, path, schema)
        return

    write_by_kernel(model, path, name, schema)


def write_product(product: Product, path: Path | str, schema: StepSchema = StepSchema.AP214) -> None:
    """Write a part or an assembly to `path`. Names may hold any character; the time stamp is that of `step_header`.

    Numbers read back to the last bit. Curves in the parameters of surfaces are left out: readers make them again.
    """
    writer = _StepWriter(schema)
    writer.product(product)
    text = f"ISO-10303-21;\n{step_header(product.name, schema)}{writer.data.text()}END-ISO-10303-21;\n"
    Path(path).write_bytes(text.encode("ascii"))


class _StepWriter:
    """Writes products, and what all products of a file share."""

    def __init__(self, schema: StepSchema) -> None:
        self.data, self.number = DataSection(), count(1)
        self.made: dict[Product, tuple[int, int]] = {}
        add = self.data.add
        self.application = add(f"APPLICATION_CONTEXT('{schema.context}')")
        add(f"APPLICATION_PROTOCOL_DEFINITION('international standard',{schema.protocol},#{self.application})")
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
        add, called = self.data.add, string(name)
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
        """Write that a representation is the shape of a product."""
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
        """Write that a product occurs in an assembly: the place of its origin, and its name there."""
        add = self.data.add
        move = add(f"ITEM_DEFINED_TRANSFORMATION('','',#{frames[0]},#{frames[1]})")
        relation = add(
            f"(REPRESENTATION_RELATIONSHIP('','',#{part[1]},#{whole[1]})\n"
            f"REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(#{move})\nSHAPE_REPRESENTATION_RELATIONSHIP())"
        )
        called = string(occurrence.name)
        usage = add(f"NEXT_ASSEMBLY_USAGE_OCCURRENCE('{next(self.number)}',{called},'',#{whole[0]},#{part[0]},$)")
        shape = add(f"PRODUCT_DEFINITION_SHAPE('Placement','Placement of an item',#{usage})")
        add(f"CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(#{relation},#{shape})")
