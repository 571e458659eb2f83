"""Job `build`: solids, facets, contours, points and the data of a design as files."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias, cast

from gearcad.core.errors import GeometryError, ParameterError, as_choice, require_one_of, require_switch
from gearcad.core.records import JsonObject, Notice, naming
from gearcad.core.runtime import Progress
from gearcad.designs.design import Design
from gearcad.designs.gear_designs import ToothedDesign
from gearcad.designs.keys import DesignKind
from gearcad.geometry import Gear, Rack
from gearcad.geometry.making import Making
from gearcad.jobs import job_for
from gearcad.jobs.job import Data, Job, Subject, Writer, as_design
from gearcad.solids import FileOptions, Format
from gearcad.solids.body_plan import require_rim
from gearcad.solids.facets.tessellation import gear_chord_error
from gearcad.solids.files.formats import formats_minding
from gearcad.solids.files.products import GearProduct, MadeProduct, PairProduct, RackProduct, SplineProduct
from gearcad.solids.files.shaft_products import ShaftProduct, shaft_chord_error
from gearcad.solids.shaft_plan import SeatedShaft, TurnedPlan, pair_shafts
from gearcad.version import __version__

if TYPE_CHECKING:
    from gearcad.designs import PairDesign, PlanetaryDesign, RackDesign, RackPairDesign, SplineDesign
    from gearcad.designs.shaft_spec import ShaftDesign
    from gearcad.solids.files.products import RackPairProduct
    from gearcad.solids.files.train_products import TrainProduct


PartProduct: TypeAlias = GearProduct | RackProduct
AssemblyProduct: TypeAlias = "PairProduct | RackPairProduct | SplineProduct | TrainProduct"


def products_of(design: ToothedDesign, options: FileOptions) -> tuple[Mapping[str, PartProduct], AssemblyProduct | None]:
    """Return gears and racks by the names of their files, and the product that they make in mesh."""
    if design.kind is DesignKind.PLANETARY:
        train = _train_product(cast("PlanetaryDesign", design), options)
        return train.parts, train
    if design.kind is DesignKind.PAIR:
        pair = PairProduct(cast("PairDesign", design).pair, options, seated_shafts(design))
        return pair.parts, pair
    if design.kind is DesignKind.SPLINE:
        spline = SplineProduct(cast("SplineDesign", design).spline, options)
        return spline.parts, spline if len(spline.parts) > 1 else None
    if design.kind in (DesignKind.RACK, DesignKind.RACK_PAIR):
        return _with_rack(cast("RackDesign | RackPairDesign", design), options)
    return {name: GearProduct(gear=gear, name=design.name, options=options) for name, gear in design.gears.items()}, None


def shaft_alone(design: Design, options: FileOptions) -> ShaftProduct:
    """Return the product of a shaft by itself. Raises GeometryError for one that is no solid."""
    return ShaftProduct(plan=TurnedPlan(cast("ShaftDesign", design).shaft), name=design.name, options=options)


def seated_shafts(design: ToothedDesign) -> tuple[SeatedShaft, ...]:
    """Return the shafts of a pair where they stand in its assembly; none of another design."""
    shafts = cast("PairDesign", design).shafts if design.kind is DesignKind.PAIR else None
    if shafts is None:
        return ()
    mounted = shafts.gears
    positions = mounted.map(lambda own: 0.0 if own is None else own.mesh_position)
    return pair_shafts(cast("PairDesign", design).pair, mounted.map(lambda own: None if own is None else own.shaft), positions)


def _train_product(design: PlanetaryDesign, options: FileOptions, *, as_made: bool = False) -> TrainProduct:
    from gearcad.solids.files.train_products import TrainProduct

    return TrainProduct(design.train, options, given_speeds(design), as_made)


def _with_rack(
    design: RackDesign | RackPairDesign, options: FileOptions
) -> tuple[Mapping[str, PartProduct], RackPairProduct | None]:
    from gearcad.designs import RackPairDesign
    from gearcad.solids.files.products import RackPairProduct

    if isinstance(design, RackPairDesign):
        pair = RackPairProduct(design.pair, options)
        return pair.parts, pair
    return {"rack": RackProduct(rack=design.rack, name=design.name, options=options)}, None


def require_bodies(design: ToothedDesign, options: FileOptions) -> None:
    """Raise GeometryError for a ring without a rim, its parameter led by the gear's name, and a train that has no room."""
    for name, gear in design.gears.items():
        _require_body(name, gear)
    if design.kind is DesignKind.PLANETARY:
        _train_product(cast("PlanetaryDesign", design), options).require_room()
    if design.kind is DesignKind.SHAFT:
        shaft_alone(design, options)
    for shaft in seated_shafts(design):
        _ = shaft.plan


def require_facets(design: ToothedDesign, options: FileOptions) -> None:
    """Raise ParameterError for a chord error that the facets of some gear or rack cannot have, before any is made."""
    for gear in design.gears.values():
        gear_chord_error(gear, options.chord_error)
    if design.kind is DesignKind.SHAFT:
        shaft_chord_error(shaft_alone(design, options).plan, options.chord_error)
    for shaft in seated_shafts(design):
        with naming(shaft.role):
            shaft_chord_error(shaft.plan, options.chord_error)
    if design.kind in (DesignKind.RACK, DesignKind.RACK_PAIR):
        from gearcad.solids.facets.tessellation import rack_chord_error

        part = cast("RackPairDesign", design).pair if design.kind is DesignKind.RACK_PAIR else cast("RackDesign", design)
        rack_chord_error(part.rack, options.chord_error)


def _require_body(name: str, gear: Gear) -> None:
    try:
        if gear.internal:
            require_rim(gear)
        if gear.body.step is not None:
            from gearcad.solids.exact.own_blank import toothed_blank

            toothed_blank(gear)
    except GeometryError as error:
        raise error.within(name) from error


def given_speeds(design: PlanetaryDesign) -> dict[str, float]:
    """Return the speeds (rpm) of a train that its design has."""
    of_load = {design.train.input: design.load.speed} if design.load is not None and design.load.speed else {}
    return {**design.speeds, **of_load}


_DEFAULT = (Format.STEP, Format.STL)

_WHERE = {
    "bracket": "the bracket is part of assembly.step",
    "circles": "the circles are drawn there",
    "carrier": "the carrier is a body",
    "exploded": "the assembly is there",
    "turning": "it is an animation of assembly.glb",
    "ap242": "it is a protocol of STEP",
}
"""The effect of options that only a few formats show, for messages."""

_OF_TRAINS = ("carrier", "exploded", "turning")
"""Options that only planetary trains have."""


@dataclass(frozen=True, kw_only=True)
class Build(Job[ToothedDesign, ToothedDesign]):
    """The files of a design in some formats. Its result is the design itself: solids are made as they are written.

    Per part `pinion.step`, `wheel.step`, `rack.step` or `gear.step` and so on, of a planetary train by the names of its gears
    and of its carrier, if one is made, of a pair on shafts also `pinion-shaft.step` and `wheel-shaft.step`; a pair, or a
    train, also gets `assembly.*`, posed in mesh, in the formats that have assemblies. The `stage` "precut" makes each gear as
    it is before its flanks are finished, and no assembly. With `as_made` there are also `gear-as-made.step` and so on of each
    gear with a table making: what its mould or print is made to, or as DXF the path of the wire or beam; and
    `assembly-as-made.*` of a planetary train that is printed as a whole. A shaft by itself is `shaft.step` and so on.
    Raises ParameterError without a format.
    """

    verb = "build"
    accepts = (
        *(DesignKind.GEAR, DesignKind.PAIR, DesignKind.RACK, DesignKind.RACK_PAIR, DesignKind.PLANETARY, DesignKind.SPLINE),
        DesignKind.SHAFT,
    )
    why = "there are no teeth"
    with_shafts = True

    formats: tuple[Format, ...] = _DEFAULT
    options: FileOptions = field(default_factory=FileOptions)
    stage: str = "finished"
    as_made: bool = False

    def __post_init__(self) -> None:
        require_one_of("stage", self.stage, ("precut", "finished"))
        require_switch("as_made", self.as_made)
        object.__setattr__(self, "formats", _formats(self.formats))
        if not self.formats:
            raise ParameterError("format", "", f"must be one or more of {', '.join(kind.value for kind in Format)}")

    def run(self, design: Design, progress: Progress | None = None) -> ToothedDesign:
        design = self.accepted(design, progress)
        if design.kind is DesignKind.SHAFT:
            self._require_shaft_formats()
        if self.options.bracket and design.kind is not DesignKind.PAIR:
            alone = (
                "a single gear has no assembly"
                if getattr(design, "assembly", None) is None
                else "it stands on the shafts of both"
            )
            alone = "a planetary train has a carrier" if design.kind is DesignKind.PLANETARY else alone
            alone = "shaft and hub have one axis" if design.kind is DesignKind.SPLINE else alone
            raise GeometryError("bracket", True, f"needs a pair of gears: {alone}")
        if self.options.bracket and seated_shafts(design):
            raise GeometryError("bracket", True, "must be left out with shafts in the spec: the gears stand on these")
        if self.stage == "precut" and not _precut(design):
            raise GeometryError("stage", self.stage, "needs a gear with a table premachining, such as [pinion.premachining]")
        if self.as_made:
            self._require_made(design)
        for option in _OF_TRAINS:
            if getattr(self.options, option) and design.kind is not DesignKind.PLANETARY:
                raise GeometryError(option, True, "needs a planetary train")
        for option, where in _WHERE.items():
            needed = formats_minding(option)
            if getattr(self.options, option) and not set(self.formats).intersection(needed):
                raise GeometryError(option, True, f"needs the format {' or '.join(kind.value for kind in needed)}: {where}")
        if any(kind.entry.of_bodies for kind in self.formats):
            require_bodies(design, self.options)
        if set(self.formats).intersection(formats_minding("chord_error")):
            require_facets(design, self.options)
        return design

    def _require_shaft_formats(self) -> None:
        """Raise ParameterError unless all formats have bodies without teeth."""
        of_shafts = [kind.value for kind in Format if kind.entry.write_body is not None]
        for kind in self.formats:
            if kind.value not in of_shafts:
                raise ParameterError(
                    "format", kind.value, f"must be one or more of {', '.join(of_shafts)} for a shaft by itself"
                )

    def _require_made(self, design: ToothedDesign) -> None:
        """Raise GeometryError unless some gear says how it is made, and there are files of it as made."""
        gears = {name: gear for name, gear in design.gears.items() if gear.making.present}
        if not gears:
            raise GeometryError("as_made", True, "needs a gear with a table making, such as [pinion.making]")
        if self.stage != "finished":
            raise GeometryError("as_made", True, f'must be left out of the stage "{self.stage}"')
        for name, gear in gears.items():
            if gear.modification.present:
                raise GeometryError("as_made", True, f"needs flanks without modification: leave out [{name}.modification]")
            if not any(_is_made(gear, kind) for kind in self.formats):
                needed = "dxf, for the path" if gear.making.cuts else "one other than csv"
                raise GeometryError("as_made", True, f"needs the format {needed} of {name}")

    def document(self, result: ToothedDesign) -> JsonObject:
        """Return the document that `--json` prints: kind, name of the design, gearcad's version, shafts with places."""
        shafts = {each.file: each.to_dict() for each in self._shafts(result)}
        return {"kind": "build", "name": result.name, "gearcad": __version__, **({"shafts": shafts} if shafts else {})}

    def notices(self, result: ToothedDesign) -> Sequence[Notice]:
        """Return the notices of the design, but that shafts are not taken into account, and those of seats on shafts."""
        return (*self.design_notices(result), *(notice for shaft in self._shafts(result) for notice in shaft.notices))

    def _shafts(self, design: ToothedDesign) -> tuple[SeatedShaft, ...]:
        """Return the shafts of which files are made."""
        of_bodies = any(kind.entry.write_body is not None for kind in self.formats)
        return seated_shafts(design) if of_bodies and self.stage == "finished" else ()

    def files(self, result: ToothedDesign) -> dict[str, Writer]:
        """Return every file of the design, quickest first."""
        found = Data().files(result)
        parts, assembly = self._products(result)
        for kind in reversed(Format):
            if kind not in self.formats:
                continue
            found |= {f"{name}.{kind.value}": partial(kind.entry.write, product) for name, product in parts.items()}
            if assembly is not None and result.kind is DesignKind.PLANETARY:
                found |= _train_writers(kind, cast("TrainProduct", assembly))
            elif assembly is not None and kind.entry.write_pair is not None:
                found[f"assembly.{kind.value}"] = partial(kind.entry.write_pair, assembly)
            if kind.entry.write_body is not None:
                writer, bodies = kind.entry.write_body, self._bodies(result, assembly)
                found |= {f"{name}.{kind.value}": partial(writer, body) for name, body in bodies.items()}
        return found | (self._made_files(result, parts) if self.as_made else {})

    def _bodies(self, design: ToothedDesign, assembly: AssemblyProduct | None) -> Mapping[str, ShaftProduct]:
        """Return the shafts of a pair, or the shaft by itself, by the names of their files."""
        if design.kind is DesignKind.SHAFT:
            return {"shaft": shaft_alone(design, self.options)}
        return assembly.bodies if isinstance(assembly, PairProduct) else {}

    def _made_files(self, design: ToothedDesign, parts: Mapping[str, PartProduct]) -> dict[str, Writer]:
        """Return the files of the gears as they are made, and of a train that is printed as a whole."""
        found: dict[str, Writer] = {}
        made = {
            name: MadeProduct.of(product)
            for name, product in parts.items()
            if isinstance(product, GearProduct) and product.gear.making.present
        }
        train = None
        if design.kind is DesignKind.PLANETARY and _printed_as_one([gear.making for gear in design.gears.values()]):
            train = _train_product(cast("PlanetaryDesign", design), self.options, as_made=True)
        for kind in reversed(self.formats):
            found |= {
                f"{name}-as-made.{kind.value}": partial(kind.entry.write, product)
                for name, product in made.items()
                if _is_made(parts[name].gear, kind)  # type: ignore[union-attr]
            }
            if train is not None and kind.entry.write_train is not None:
                found[f"assembly-as-made.{kind.value}"] = partial(kind.entry.write_train, train)
        return found

    def _products(self, design: ToothedDesign) -> tuple[Mapping[str, PartProduct], AssemblyProduct | None]:
        """Return the parts at this stage and, of finished ones, what they make in mesh."""
        if self.stage == "finished":
            return products_of(design, self.options)
        parts: dict[str, PartProduct] = {}
        for name, part in _precut(design).items():
            if isinstance(part, Rack):
                parts[name] = RackProduct(rack=part, name=design.name, options=self.options)
            else:
                parts[name] = GearProduct(gear=part, name=design.name, options=self.options)
        return parts, None

    @property
    def parts(self) -> dict[str, dict[str, Any]]:
        """The data, and each format with the options that matter to it."""
        stage: dict[str, Any] = {} if self.stage == "finished" else {"stage": self.stage}
        stage |= {"as_made": True} if self.as_made else {}
        return Data().parts | {kind.value: kind.minded(self.options) | stage for kind in self.formats}

    def part_of(self, file: str) -> str:
        """Formats are called as their files end."""
        return Data().part_of(file) or file.rpartition(".")[2]

    def for_row(self, design: Design, parts: Collection[str]) -> Job[Any, Any]:
        """Return the job for these formats only, with the options that matter to them.

        A gear gets no bracket, and only planetary trains get a carrier.
        """
        formats = tuple(kind for kind in self.formats if kind.value in parts)
        if not formats:
            return Data()
        options = FileOptions(**{name: value for kind in formats for name, value in kind.minded(self.options).items()})
        foreign = () if design.kind is DesignKind.PLANETARY else _OF_TRAINS
        foreign = foreign if design.kind is DesignKind.PAIR else (*foreign, "bracket")
        as_made = self.as_made and any(gear.making.present for gear in getattr(design, "gears", {}).values())
        options = replace(options, **dict.fromkeys(foreign, False))
        return Build(formats=formats, options=options, stage=self.stage, as_made=as_made)


def _is_made(gear: Gear, kind: Format) -> bool:
    """Return whether a format has a gear as it is made: a path is drawn as DXF alone, and no table of points is made."""
    return kind is Format.DXF if gear.making.cuts else kind is not Format.CSV


def _printed_as_one(makings: Sequence[Making]) -> bool:
    """Return whether all gears are printed, and shrink alike."""
    return {each.process for each in makings} == {"print"} and len({_scales(each) for each in makings}) == 1


def _scales(making: Making) -> tuple[float, float]:
    return making.radial_scale, making.axial_scale


def _precut(design: ToothedDesign) -> dict[str, Gear | Rack]:
    """Return the parts of a design as they are before their flanks are finished, those that are cut before."""
    toothed = {name: part for name, part in design.described.items() if isinstance(part, Rack)} | design.gears
    return {name: part.precut for name, part in toothed.items() if part.premachining.present}


def _formats(given: object) -> tuple[Format, ...]:
    """Formats by themselves or by their names. Raises ParameterError."""
    if isinstance(given, str) or not isinstance(given, Iterable):
        raise ParameterError("formats", given, 'must be a list of formats, such as ["step"]')
    return tuple(as_choice("format", each, Format) for each in given)


def _train_writers(kind: Format, train: TrainProduct) -> dict[str, Writer]:
    """Return the writers, by file name, of the carrier (if one is made) and of the whole train, in a format that has them."""
    found: dict[str, Writer] = {}
    if train.carrier is not None and kind.entry.write_body is not None:
        found[f"{train.train.carrier.name}.{kind.value}"] = partial(kind.entry.write_body, train.carrier)
    if kind.entry.write_train is not None:
        found[f"assembly.{kind.value}"] = partial(kind.entry.write_train, train)
    return found


def build(
    subject: Subject,
    folder: Path | str,
    formats: Iterable[Format | str] = _DEFAULT,
    *,
    chord_error: float = FileOptions.chord_error,
    bracket: bool = False,
    circles: bool = False,
    carrier: bool = False,
    exploded: bool = False,
    turning: bool = False,
    ap242: bool = False,
    as_made: bool = False,
    progress: Progress | None = None,
) -> list[Path]:
    """Write the files of gears, racks, pairs and trains into `folder`, all or none, and return their paths as they were made.

    `formats` are of "step", "stl", "3mf", "glb", "png", "dxf" and "csv". `chord_error` (mm) bounds the facets; `bracket` puts a
    pair on two shafts with a bracket (STEP); `circles` draws the tip, reference, base and root circles (DXF), of a rack the
    lines. Of a planetary train, `carrier` adds pins and plates, `exploded` moves members apart, `turning` animates (GLB).
    `ap242` writes STEP in AP242 in place of AP214.
    `as_made` adds the files of gears as they are made (see `Making`).

    >>> import tempfile
    >>> from gearcad import Gear
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     [file.name for file in build(Gear(teeth=20, normal_module=2, face_width=20), folder, ["dxf", "csv"])]
    ['data.json', 'gear.csv', 'gear.dxf']

    Raises ParameterError or GeometryError for wrong input, a folder that cannot be written too, SolverError where the CAD
    kernel fails.
    """
    options = FileOptions(
        chord_error=chord_error,
        bracket=bracket,
        circles=circles,
        carrier=carrier,
        exploded=exploded,
        turning=turning,
        ap242=ap242,
    )
    job = Build(formats=_formats(formats), options=options, as_made=as_made)
    design = as_design(subject)
    suited = job_for(job, design)
    return suited.write(suited.run(design), folder, progress)
