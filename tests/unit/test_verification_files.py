"""Files that were tampered with: the judges notice each change, name the claim, and say where."""

import json
import re
import struct
import zipfile
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import gearcad
from gearcad import Body, FlankModification, Gear, GearPair
from gearcad.designs import PairDesign
from gearcad.jobs.build import products_of
from gearcad.solids import FileOptions
from gearcad.solids.exact.solid import SolidProduct
from gearcad.verification import step
from gearcad.verification.assemblies import PlacedMesh
from gearcad.verification.claims import Claim, Judge
from gearcad.verification.drawings import judge_section
from gearcad.verification.exact_parts import ExactPart
from gearcad.verification.facets import judge_facets
from gearcad.verification.step import judge_step
from gearcad.verification.step_entities import JudgedSolids

PINION = Gear(
    teeth=12,
    normal_module=2,
    face_width=12,
    helix_angle=15,
    profile_shift=0.3,
    tooth_thinning=0.03,
    body=Body(bore=8),
    modification=FlankModification(tip_relief=15, tip_relief_length=0.8, lead_crowning=6),
)
WHEEL = Gear(teeth=17, normal_module=2, face_width=10, helix_angle=-15, tooth_thinning=0.03, body=Body(bore=10))
PAIR = GearPair(pinion=PINION, wheel=WHEEL, name="judged")
DESIGN = PairDesign(name="judged", pair=PAIR)
FORMATS = ("step", "stl", "3mf", "glb", "dxf")
TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("made")
    gearcad.build(DESIGN, folder, FORMATS)
    return folder


def claims(path: Path) -> Iterator[Claim]:
    """Judge one file of the pair."""
    options = FileOptions()
    parts, assembly = products_of(DESIGN, options)
    exact = {product.name: ExactPart(product.gear) for product in parts.values()}
    meshes = [PlacedMesh(PAIR, parts["pinion"].name, parts["wheel"].name)]
    if path.stem == "assembly":
        if path.suffix == ".step":
            yield from judge_step(path, assembly.solid(), exact, meshes)
        else:
            yield from judge_facets(path, exact, options.chord_error, meshes)
        return
    product = parts[path.stem]
    if path.suffix == ".step":
        yield from judge_step(path, product.solid(), exact)
    elif path.suffix == ".dxf":
        yield from judge_section(path, exact[product.name])
    else:
        yield from judge_facets(path, {product.name: exact[product.name]}, options.chord_error, names=path.suffix != ".stl")


NAMES = [f"{stem}.{ending}" for stem in ("pinion", "wheel", "assembly") for ending in FORMATS]


@pytest.mark.parametrize("name", [name for name in NAMES if name not in ("assembly.stl", "assembly.dxf")])
def test_files_as_they_are_written_pass(made: Path, name: str) -> None:
    found = list(claims(made / name))
    assert [claim.text for claim in found if claim.passed is not True] == []
    assert len(found) >= 5


def triangles(path: Path) -> np.ndarray:
    return np.frombuffer(path.read_bytes(), TRIANGLE, offset=84).copy()


def write_triangles(path: Path, found: np.ndarray) -> None:
    path.write_bytes(path.read_bytes()[:80] + struct.pack("<I", len(found)) + found.tobytes())


def move_vertex(path: Path) -> None:
    """By 5 µm along the normal of a flank."""
    found = triangles(path)
    corners = found["corners"].astype(float)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1)[:, None]
    flank = int(np.argmin(np.abs(np.hypot(*corners[:, 0, :2].T) - PINION.reference_diameter / 2) + 9 * np.abs(normals[:, 2])))
    vertex = found["corners"][flank, 0].copy()
    same = (found["corners"] == vertex).all(axis=-1)
    found["corners"][same] = (vertex + 0.005 * normals[flank]).astype("f4")
    write_triangles(path, found)


def flip_triangle(path: Path) -> None:
    found = triangles(path)
    found["corners"][7] = found["corners"][7][::-1].copy()
    write_triangles(path, found)


def drop_triangle(path: Path) -> None:
    write_triangles(path, np.delete(triangles(path), 11))


def enlarge(path: Path) -> None:
    found = triangles(path)
    found["corners"] *= 1.0005
    write_triangles(path, found)


def remove_tooth(path: Path) -> None:
    """All triangles of tooth 0, off the root circle."""
    found = triangles(path)
    middle = found["corners"].mean(axis=1)
    turn = np.arctan2(middle[:, 1], middle[:, 0])
    tooth = (np.abs(turn) < np.pi / PINION.teeth) & (np.hypot(*middle[:, :2].T) > PINION.root_diameter / 2 + 0.1)
    write_triangles(path, found[~tooth])


def mirror(path: Path) -> None:
    """The other hand: a file of the right size, and watertight."""
    found = triangles(path)
    found["corners"] = (found["corners"] * np.array([1, -1, 1], "f4"))[:, ::-1]
    write_triangles(path, found)


def move_pole(path: Path) -> None:
    """By 0.1 µm, square to the radius, in the middle of a flank."""
    text = path.read_bytes()
    grid = re.search(rb"B_SPLINE_SURFACE_WITH_KNOTS\([^;]*?\(\(([^;]*?)\)\)", text)
    assert grid is not None
    rows = grid[1].split(b"),")
    number = re.findall(rb"#\d+", rows[len(rows) // 2])[2]
    point = re.search(number + rb"=CARTESIAN_POINT\('',\(([^()]*)\)\)", text)
    assert point is not None
    x, y, z = (float(value) for value in point[1].split(b","))
    radius = np.hypot(x, y)
    moved = (x - 1e-4 * y / radius, y + 1e-4 * x / radius, z)
    path.write_bytes(text[: point.start(1)] + ",".join(map(repr, map(float, moved))).encode() + text[point.end(1) :])


def widen_bore(path: Path) -> None:
    """By 1 µm: the face alone, its edges stay."""
    text = path.read_text()
    path.write_text(re.sub(r"(CYLINDRICAL_SURFACE\('',#\d+,)4\.0\)", r"\g<1>4.001)", text))


def rename(path: Path) -> None:
    path.write_text(path.read_text().replace("judged pinion", "judged onipin"))


def swap_names(path: Path) -> None:
    text = path.read_text().replace("judged pinion", "@").replace("judged wheel", "judged pinion").replace("@", "judged wheel")
    path.write_text(text)


def paint(path: Path) -> None:
    text = path.read_text()
    colour = re.search(r"COLOUR_RGB\('',([0-9.]+),", text)
    assert colour is not None
    path.write_text(text[: colour.start(1)] + "0.1" + text[colour.end(1) :])


def shift_wheel(path: Path) -> None:
    """By 20 µm: the axes are not where the pair has them."""
    text, distance = path.read_text(), PAIR.centre_distance
    old = f"({float(distance)!r}," if f"({float(distance)!r}," in text else f"({distance:.13g},"
    assert old in text
    path.write_text(text.replace(old, f"({distance + 0.02!r},"))


def cut_off(path: Path) -> None:
    content = path.read_bytes()
    path.write_bytes(content[: len(content) * 2 // 3])


def move_section(path: Path) -> None:
    lines = path.read_text().split("\n")
    start = next(i for i, line in enumerate(lines) if line.strip() == "LWPOLYLINE")
    place = next(i for i in range(start, len(lines)) if lines[i].strip() == "10")
    lines[place + 1] = repr(float(lines[place + 1]) + 0.005)
    path.write_text("\n".join(lines))


def open_section(path: Path) -> None:
    lines = path.read_text().split("\n")
    start = next(i for i, line in enumerate(lines) if line.strip() == "LWPOLYLINE")
    place = next(i for i in range(start, len(lines)) if lines[i].strip() == "70")
    lines[place + 1] = "0"
    path.write_text("\n".join(lines))


def change_unit(path: Path) -> None:
    path.write_text(re.sub(r"(\$INSUNITS\s+70\s+)4", r"\g<1>1", path.read_text()))


def move_in_glb(path: Path) -> None:
    content = bytearray(path.read_bytes())
    size = struct.unpack_from("<I", content, 12)[0]
    tree = json.loads(content[20 : 20 + size])
    accessor = tree["accessors"][tree["meshes"][0]["primitives"][0]["attributes"]["POSITION"]]
    start = 20 + size + 8 + tree["bufferViews"][accessor["bufferView"]].get("byteOffset", 0)
    struct.pack_into("<f", content, start, struct.unpack_from("<f", content, start)[0] + 0.02)
    path.write_bytes(bytes(content))


def move_in_3mf(path: Path) -> None:
    with zipfile.ZipFile(path) as archive:
        files = {name: archive.read(name) for name in archive.namelist()}
    model = next(name for name in files if name.endswith(".model"))
    text = files[model].decode()
    vertex = re.search(r'<vertex x="([^"]*)"', text)
    assert vertex is not None
    files[model] = (text[: vertex.start(1)] + f"{float(vertex[1]) + 0.02:.7f}" + text[vertex.end(1) :]).encode()
    with zipfile.ZipFile(path, "w") as archive:
        for name, inside in files.items():
            archive.writestr(name, inside)


TAMPERED: list[tuple[str, Callable[[Path], None], str]] = [
    ("pinion.stl", move_vertex, "distance of vertices"),
    ("pinion.stl", flip_triangle, "turned outwards"),
    ("wheel.stl", drop_triangle, "watertight"),
    ("pinion.stl", enlarge, "distance of vertices"),
    ("pinion.stl", remove_tooth, "watertight"),
    ("pinion.stl", mirror, "distance of vertices"),
    ("pinion.stl", cut_off, "facets|is read"),
    ("wheel.step", move_pole, "distance of tooth faces"),
    ("pinion.step", move_pole, "distance of tooth faces"),
    ("assembly.step", move_pole, "distance of tooth faces"),
    ("pinion.step", widen_bore, "plain faces"),
    ("pinion.step", rename, "names and places"),
    ("assembly.step", swap_names, "names and places"),
    ("wheel.step", paint, "colour"),
    ("assembly.step", shift_wheel, "gears in mesh"),
    ("wheel.step", cut_off, "is read|in the file"),
    ("wheel.dxf", move_section, "distance of the contour"),
    ("wheel.dxf", open_section, "closed"),
    ("pinion.dxf", change_unit, "unit"),
    ("wheel.glb", move_in_glb, "distance of vertices"),
    ("assembly.glb", move_in_glb, "distance of vertices"),
    ("pinion.3mf", move_in_3mf, "distance of vertices"),
    ("assembly.3mf", cut_off, "is read"),
]


@pytest.mark.parametrize(("name", "tamper", "claim"), TAMPERED, ids=[f"{name}-{act.__name__}" for name, act, _ in TAMPERED])
def test_a_file_that_was_tampered_with_fails(
    made: Path, tmp_path: Path, name: str, tamper: Callable[[Path], None], claim: str
) -> None:
    path = tmp_path / name
    path.write_bytes((made / name).read_bytes())
    tamper(path)
    assert path.read_bytes() != (made / name).read_bytes()
    failed = [each for each in claims(path) if each.passed is False]
    assert any(re.search(claim, each.quantity) for each in failed), [each.text for each in failed]


# ---------------------------------------------------------------------- solids of an assembly that its parts have too


def of_assembly(folder: Path) -> tuple[list[Claim], int]:
    """Judge both parts and the assembly together; return the claims about it, and how many of its solids were judged anew."""
    options = FileOptions()
    parts, assembly = products_of(DESIGN, options)
    exact, judged = {product.name: ExactPart(product.gear) for product in parts.values()}, JudgedSolids()
    for name, product in parts.items():
        assert all(claim.passed for claim in judge_step(folder / f"{name}.step", product.solid(), exact, judged=judged))
    solids: list[object] = []
    judge_solid = step._judge_solid

    def counted(judge: Judge, shape: object, made: SolidProduct, part: ExactPart | None) -> Iterator[Claim]:
        solids.append(shape)
        return judge_solid(judge, shape, made, part)

    meshes = [PlacedMesh(PAIR, parts["pinion"].name, parts["wheel"].name)]
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(step, "_judge_solid", counted)
        found = list(judge_step(folder / "assembly.step", assembly.solid(), exact, meshes, judged))
    return found, len(solids)


def test_an_assembly_has_the_claims_of_the_solids_of_its_parts(made: Path) -> None:
    """Equal to what the kernel finds in the assembly alone, without a second look at either solid."""
    found, anew = of_assembly(made)
    assert anew == 0
    assert found == list(claims(made / "assembly.step"))


def second_solid(path: Path) -> None:
    """A solid twice in one product: the eye sees one."""
    text = path.read_text()
    solid = re.search(r"#(\d+)=(MANIFOLD_SOLID_BREP\('',#\d+\));", text)
    assert solid is not None
    number = max(map(int, re.findall(r"#(\d+)=", text))) + 1
    text = text.replace("ENDSEC;\nEND-ISO", f"#{number}={solid[2]};\nENDSEC;\nEND-ISO")
    path.write_text(re.sub(rf"(ADVANCED_BREP_SHAPE_REPRESENTATION\('',\(#\d+,#{solid[1]})\)", rf"\g<1>,#{number})", text))


def to_inches(path: Path) -> None:
    """All lengths are inches by the header."""
    text = path.read_text()
    metre = "(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))"
    assert metre in text
    number = max(map(int, re.findall(r"#(\d+)=", text))) + 1
    inch = f"(CONVERSION_BASED_UNIT('INCH',#{number + 1})LENGTH_UNIT()NAMED_UNIT(#{number + 2}))"
    more = (
        f"#{number + 1}=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#{number});",
        f"#{number + 2}=DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);",
        f"#{number}={metre};",
    )
    text = text.replace(metre, inch, 1)
    path.write_text(text.replace("ENDSEC;\nEND-ISO", "\n".join(more) + "\nENDSEC;\nEND-ISO"))


@pytest.mark.parametrize("tamper", [move_pole, second_solid, to_inches, widen_bore, paint, shift_wheel, swap_names])
def test_an_assembly_that_was_tampered_with_fails_beside_its_parts(
    made: Path, tmp_path: Path, tamper: Callable[[Path], None]
) -> None:
    for name in ("pinion.step", "wheel.step", "assembly.step"):
        (tmp_path / name).write_bytes((made / name).read_bytes())
    tamper(tmp_path / "assembly.step")
    assert (tmp_path / "assembly.step").read_bytes() != (made / "assembly.step").read_bytes()
    found, _ = of_assembly(tmp_path)
    assert [each.text for each in found if each.passed is False]


def test_a_gear_of_other_modifications_is_not_this_gear(made: Path) -> None:
    """The judge holds the files against this design: a tip relief more by 5 µm is another one."""
    other = replace(PINION, modification=replace(PINION.modification, tip_relief=20))
    product = products_of(DESIGN, FileOptions())[0]["pinion"]
    found = [
        each for each in judge_step(made / "pinion.step", product.solid(), {product.name: ExactPart(other)}) if not each.passed
    ]
    (faces,) = [each for each in found if each.quantity.startswith("distance of tooth faces")]
    assert faces.deviation == pytest.approx(5.0, abs=0.7)
    assert re.match(r"at tooth \d+, x ", faces.reason)
