"""200 random changes to the files of a pair, each small and of one of many kinds: the judges notice every one of them."""

import json
import random
import re
import struct
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import gearcad
from gearcad import Body, FlankModification, Gear, GearPair
from gearcad.designs import PairDesign
from gearcad.jobs.build import products_of
from gearcad.solids import FileOptions
from gearcad.verification.assemblies import PlacedMesh
from gearcad.verification.claims import Claim
from gearcad.verification.drawings import judge_section
from gearcad.verification.exact_parts import ExactPart
from gearcad.verification.facets import judge_facets
from gearcad.verification.step import judge_step
from gearcad.verification.step_entities import JudgedSolids

PINION = Gear(
    teeth=11,
    normal_module=2,
    face_width=8,
    helix_angle=12,
    profile_shift=0.3,
    tooth_thinning=0.03,
    body=Body(bore=8),
    modification=FlankModification(tip_relief=12, tip_relief_length=0.8),
)
WHEEL = Gear(teeth=14, normal_module=2, face_width=7, helix_angle=-12, tooth_thinning=0.03, body=Body(bore=9))
PAIR = GearPair(pinion=PINION, wheel=WHEEL, name="judged")
DESIGN = PairDesign(name="judged", pair=PAIR)
PARTS = ("pinion", "wheel")
TRIANGLE = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
MOVED = 0.005
"""Way (mm) of a vertex along its normal, and of a vertex of a contour square to it."""
POLE = 1e-4
DISPLACED = 1e-3
COUNT, SEED = 200, 20261128

Random = random.Random
Vectors = NDArray[np.float64]


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("made")
    gearcad.build(DESIGN, folder, ("step", "stl", "3mf", "glb", "dxf"))
    return folder


def claims(path: Path, made: Path) -> list[Claim]:
    """Judge one file; of a STEP assembly beside its parts as they were made."""
    options = FileOptions()
    parts, assembly = products_of(DESIGN, options)
    exact = {product.name: ExactPart(product.gear) for product in parts.values()}
    meshes = [PlacedMesh(PAIR, parts["pinion"].name, parts["wheel"].name)]
    if path.stem == "assembly":
        if path.suffix == ".step":
            judged = JudgedSolids()
            for name, part in parts.items():
                list(judge_step(made / f"{name}.step", part.solid(), exact, judged=judged))
            return list(judge_step(path, assembly.solid(), exact, meshes, judged))
        return list(judge_facets(path, exact, options.chord_error, meshes, product=assembly.solid()))
    product = parts[path.stem]
    if path.suffix == ".step":
        return list(judge_step(path, product.solid(), exact))
    if path.suffix == ".dxf":
        return list(judge_section(path, exact[product.name]))
    named = path.suffix != ".stl"
    looks: dict[str, Any] = {"product": product.solid(), "colour": product.colour} if named else {}
    return list(judge_facets(path, {product.name: exact[product.name]}, options.chord_error, names=named, **looks))


# ---------------------------------------------------------------------- STL


def triangles(path: Path) -> Any:
    return np.frombuffer(path.read_bytes(), TRIANGLE, offset=84).copy()


def write_triangles(path: Path, found: Any) -> None:
    path.write_bytes(path.read_bytes()[:80] + struct.pack("<I", len(found)) + found.tobytes())


def normals_of(vertices: Vectors, faces: NDArray[np.int64]) -> Vectors:
    """Normals of vertices, of the triangles around them by area."""
    across = np.cross(
        vertices[faces[:, 1]] - vertices[faces[:, 0]],
        vertices[faces[:, 2]] - vertices[faces[:, 0]],
    )
    normals = np.zeros_like(vertices)
    for corner in range(3):
        np.add.at(normals, faces[:, corner], across)
    result: Vectors = normals / np.linalg.norm(normals, axis=1)[:, None]
    return result


def move_stl_vertex(path: Path, rng: Random) -> None:
    found = triangles(path)
    vertices, faces = np.unique(found["corners"].reshape(-1, 3), axis=0, return_inverse=True)
    number = rng.randrange(len(vertices))
    normal = normals_of(vertices.astype(float), faces.reshape(-1, 3))[number]
    same = (found["corners"] == vertices[number]).all(axis=-1)
    found["corners"][same] = (vertices[number] + rng.choice((-1, 1)) * MOVED * normal).astype("f4")
    write_triangles(path, found)


def flip_triangle(path: Path, rng: Random) -> None:
    found = triangles(path)
    number = rng.randrange(len(found))
    found["corners"][number] = found["corners"][number][::-1].copy()
    write_triangles(path, found)


def drop_triangle(path: Path, rng: Random) -> None:
    found = triangles(path)
    write_triangles(path, np.delete(found, rng.randrange(len(found))))


def remove_tooth(path: Path, rng: Random) -> None:
    gear = PINION if path.stem == "pinion" else WHEEL
    found = triangles(path)
    middle = found["corners"].mean(axis=1)
    turn = np.arctan2(middle[:, 1], middle[:, 0]) - 2 * np.pi * rng.randrange(gear.tooth_count) / gear.tooth_count
    turn -= 2 * np.pi * np.rint(turn / (2 * np.pi))
    tooth = (np.abs(turn) < np.pi / gear.tooth_count) & (np.hypot(*middle[:, :2].T) > gear.root_diameter / 2 + 0.1)
    write_triangles(path, found[~tooth])


def scale_stl(path: Path, rng: Random) -> None:
    """Inches taken for millimetres, or a little shrinkage."""
    found = triangles(path)
    found["corners"] *= rng.choice((25.4, 1 / 25.4, 1.0005, 0.9995))
    write_triangles(path, found)


def mirror_stl(path: Path, rng: Random) -> None:
    """The other hand of helix, watertight and turned outwards."""
    found = triangles(path)
    axis = rng.choice(([1, -1, 1], [-1, 1, 1]))
    found["corners"] = (found["corners"] * np.array(axis, "f4"))[:, ::-1]
    write_triangles(path, found)


def turn_stl(path: Path, rng: Random) -> None:
    """By an angle that moves teeth 5 µm."""
    found, angle = triangles(path), MOVED / 12
    turn = np.array([[np.cos(angle), np.sin(angle), 0], [-np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
    found["corners"] = (found["corners"].astype(float) @ turn).astype("f4")
    write_triangles(path, found)


# ---------------------------------------------------------------------- STEP


def entities(text: str, name: str) -> list[re.Match[str]]:
    return list(re.finditer(rf"#(\d+)={name}\((.*?)\);\n", text, re.S))


def move_pole(path: Path, rng: Random) -> None:
    """By 0.1 µm square to the radius: a pole within the grid of a flank or fillet."""
    text = path.read_text()
    surface = rng.choice(entities(text, "B_SPLINE_SURFACE_WITH_KNOTS"))
    rows = [re.findall(r"#\d+", row) for row in re.findall(r"\(((?:#\d+,?)+)\)", surface[2])]
    row = rng.choice(rows)
    number = rng.choice(row[1:-1] if len(row) > 2 else row)
    point = re.search(rf"{number}=CARTESIAN_POINT\('',\(([^()]*)\)\)", text)
    assert point is not None
    place = np.array([float(value) for value in point[1].split(",")])
    corners = [
        re.search(rf"{each}=CARTESIAN_POINT\('',\(([^()]*)\)\)", text) for each in (rows[0][0], rows[-1][0], rows[0][-1])
    ]
    first, second, third = (np.array([float(value) for value in each[1].split(",")]) for each in corners if each is not None)
    normal = np.cross(second - first, third - first)
    moved = place + rng.choice((-1, 1)) * POLE * normal / np.linalg.norm(normal)
    path.write_text(text[: point.start(1)] + ",".join(map(repr, map(float, moved))) + text[point.end(1) :])


def change_radius(path: Path, rng: Random) -> None:
    text = path.read_text()
    found = rng.choice(list(re.finditer(r"CYLINDRICAL_SURFACE\('',#\d+,([\d.]+)\)", text)))
    path.write_text(f"{text[: found.start(1)]}{float(found[1]) + rng.choice((-1, 1)) * DISPLACED!r}{text[found.end(1) :]}")


def second_solid(path: Path, rng: Random) -> None:
    """A solid twice in one product: the eye sees one."""
    text = path.read_text()
    solid = rng.choice(entities(text, "MANIFOLD_SOLID_BREP"))
    number = max(map(int, re.findall(r"#(\d+)=", text))) + 1
    text = text.replace("ENDSEC;\nEND-ISO", f"#{number}=MANIFOLD_SOLID_BREP({solid[2]});\nENDSEC;\nEND-ISO")
    path.write_text(re.sub(rf"(ADVANCED_BREP_SHAPE_REPRESENTATION\('',\(#\d+,#{solid[1]})\)", rf"\g<1>,#{number})", text))


def to_inches(path: Path, rng: Random) -> None:
    text = path.read_text()
    metre = "(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))"
    if rng.random() < 0.5:
        path.write_text(text.replace(metre, metre.replace(".MILLI.", "$")))
        return
    number = max(map(int, re.findall(r"#(\d+)=", text))) + 1
    inch = f"(CONVERSION_BASED_UNIT('INCH',#{number + 1})LENGTH_UNIT()NAMED_UNIT(#{number + 2}))"
    more = (
        f"#{number + 1}=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#{number});",
        f"#{number + 2}=DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.);",
        f"#{number}={metre};",
    )
    path.write_text(text.replace(metre, inch, 1).replace("ENDSEC;\nEND-ISO", "\n".join(more) + "\nENDSEC;\nEND-ISO"))


def drop_face(path: Path, rng: Random) -> None:
    text = path.read_text()
    shell = rng.choice(entities(text, "CLOSED_SHELL"))
    face = rng.choice(re.findall(r"#\d+", shell[2])[1:])
    path.write_text(text[: shell.start(2)] + re.sub(rf",\s*{face}\b", "", shell[2], count=1) + text[shell.end(2) :])


def paint(path: Path, rng: Random) -> None:
    text = path.read_text()
    colour = rng.choice(list(re.finditer(r"COLOUR_RGB\('',([0-9.]+),", text)))
    path.write_text(f"{text[: colour.start(1)]}{(float(colour[1]) + 0.3) % 1!r}{text[colour.end(1) :]}")


def swap_names(path: Path, rng: Random) -> None:
    text = path.read_text()
    path.write_text(text.replace("judged pinion", "@").replace("judged wheel", "judged pinion").replace("@", "judged wheel"))


def displace_step(path: Path, rng: Random) -> None:
    """By 1 µm along an axis: of the wheel in the assembly."""
    text = path.read_text()
    place = next(each for each in entities(text, "CARTESIAN_POINT") if f"({PAIR.centre_distance!r}"[:8] in each[2])
    numbers = [float(value) for value in re.findall(r"-?[\d.]+(?:[eE][-+]?\d+)?", place[2])[-3:]]
    numbers[rng.randrange(3)] += rng.choice((-1, 1)) * DISPLACED
    path.write_text(text[: place.start(2)] + f"'',({','.join(map(repr, numbers))})" + text[place.end(2) :])


# ---------------------------------------------------------------------- 3MF


def in_model(path: Path, change: Callable[[str], str]) -> None:
    with zipfile.ZipFile(path) as archive:
        files = {name: archive.read(name) for name in archive.namelist()}
    model = next(name for name in files if name.endswith(".model"))
    files[model] = change(files[model].decode()).encode()
    with zipfile.ZipFile(path, "w") as archive:
        for name, inside in files.items():
            archive.writestr(name, inside)


def move_3mf_vertex(path: Path, rng: Random) -> None:
    def change(text: str) -> str:
        mesh = rng.choice(list(re.finditer(r"<mesh>.*?</mesh>", text, re.S)))
        found = list(re.finditer(r'<vertex x="([^"]*)" y="([^"]*)" z="([^"]*)"', mesh[0]))
        vertices = np.array([[float(each[i]) for i in (1, 2, 3)] for each in found])
        faces = np.array(
            [[int(each[i]) for i in (1, 2, 3)] for each in re.finditer(r'v1="(\d+)" v2="(\d+)" v3="(\d+)"', mesh[0])]
        )
        number = rng.randrange(len(vertices))
        x, y, z = vertices[number] + rng.choice((-1, 1)) * MOVED * normals_of(vertices, faces)[number]
        start, end = mesh.start() + found[number].start(), mesh.start() + found[number].end()
        return f'{text[:start]}<vertex x="{x:.7f}" y="{y:.7f}" z="{z:.7f}"{text[end:]}'

    in_model(path, change)


def inches_3mf(path: Path, rng: Random) -> None:
    unit = rng.choice(("inch", "centimeter", "micron"))
    in_model(path, lambda text: text.replace('unit="millimeter"', f'unit="{unit}"'))


def paint_3mf(path: Path, rng: Random) -> None:
    shade = f"#{rng.randrange(16**6):06X}FF"
    in_model(path, lambda text: re.sub(r'displaycolor="[^"]*"', f'displaycolor="{shade}"', text, count=1))


def swap_colours_3mf(path: Path, rng: Random) -> None:
    in_model(
        path, lambda text: text.replace('pindex="0"', 'pindex="@"').replace('pindex="1"', 'pindex="0"').replace('"@"', '"1"')
    )


def displace_3mf(path: Path, rng: Random) -> None:
    def change(text: str) -> str:
        item = list(re.finditer(r'transform="([^"]*)"', text))[1]
        numbers = [float(value) for value in item[1].split()]
        numbers[9 + rng.randrange(3)] += rng.choice((-1, 1)) * DISPLACED
        return text[: item.start(1)] + " ".join(map(repr, numbers)) + text[item.end(1) :]

    in_model(path, change)


def drop_3mf_triangle(path: Path, rng: Random) -> None:
    def change(text: str) -> str:
        found = rng.choice(list(re.finditer(r"<triangle [^>]*/>", text)))
        return text[: found.start()] + text[found.end() :]

    in_model(path, change)


# ---------------------------------------------------------------------- GLB


def in_glb(path: Path, change: Callable[[dict[str, Any], bytearray], None]) -> None:
    content = path.read_bytes()
    size = struct.unpack_from("<I", content, 12)[0]
    tree, data = json.loads(content[20 : 20 + size]), bytearray(content[28 + size :])
    change(tree, data)
    text = json.dumps(tree).encode()
    text += b" " * (-len(text) % 4)
    head = struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(data))
    path.write_bytes(head + struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data)


def move_glb_vertex(path: Path, rng: Random) -> None:
    def change(tree: dict[str, Any], data: bytearray) -> None:
        primitive = rng.choice(tree["meshes"])["primitives"][0]

        def array(accessor: int, kind: str, columns: int) -> Any:
            of = tree["accessors"][accessor]
            start = tree["bufferViews"][of["bufferView"]].get("byteOffset", 0)
            return np.frombuffer(data, kind, of["count"] * columns, start).reshape(-1, columns), start

        vertices, start = array(primitive["attributes"]["POSITION"], "<f4", 3)
        faces, _ = array(primitive["indices"], "<u4", 1)
        number = rng.randrange(len(vertices))
        normal = normals_of(vertices.astype(float), faces.reshape(-1, 3).astype(np.int64))[number]
        moved = (vertices[number] + rng.choice((-1, 1)) * MOVED * normal).astype("<f4")
        data[start + 12 * number : start + 12 * number + 12] = moved.tobytes()

    in_glb(path, change)


def paint_glb(path: Path, rng: Random) -> None:
    def change(tree: dict[str, Any], _data: bytearray) -> None:
        rng.choice(tree["materials"])["pbrMetallicRoughness"]["baseColorFactor"][rng.randrange(3)] = 0.9

    in_glb(path, change)


def displace_glb(path: Path, rng: Random) -> None:
    def change(tree: dict[str, Any], _data: bytearray) -> None:
        matrix = next(node["matrix"] for node in tree["nodes"] if "matrix" in node and "mesh" in node)
        matrix[12 + rng.randrange(3)] += rng.choice((-1, 1)) * DISPLACED

    in_glb(path, change)


# ---------------------------------------------------------------------- DXF


def move_contour(path: Path, rng: Random) -> None:
    """A vertex of the toothed contour by 5 µm square to it."""
    import ezdxf

    document = ezdxf.readfile(path)
    contour = next(each for each in document.modelspace().query("LWPOLYLINE") if each.dxf.layer == "PROFILE")
    points = contour.get_points("xyb")
    number = rng.randrange(len(points))
    (x, y, bulge), after, before = points[number], points[(number + 1) % len(points)], points[number - 1]
    way = np.array([after[0] - before[0], after[1] - before[1]])
    way = MOVED * rng.choice((-1, 1)) * way / np.hypot(*way)
    points[number] = (x - way[1], y + way[0], bulge)
    contour.set_points(points, format="xyb")
    document.saveas(path)


def bulge_contour(path: Path, rng: Random) -> None:
    import ezdxf

    document = ezdxf.readfile(path)
    contour = next(each for each in document.modelspace().query("LWPOLYLINE") if each.dxf.layer == "PROFILE")
    points = contour.get_points("xyb")
    lengths = [np.hypot(*(np.array(points[(i + 1) % len(points)][:2]) - each[:2])) for i, each in enumerate(points)]
    number = rng.choice([i for i, length in enumerate(lengths) if length > 0.3])
    x, y, bulge = points[number]
    points[number] = (x, y, bulge + 2 * MOVED / lengths[number])
    contour.set_points(points, format="xyb")
    document.saveas(path)


EITHER = PARTS
KINDS: list[tuple[Callable[[Path, Random], None], tuple[str, ...], str]] = [
    (move_stl_vertex, EITHER, "stl"),
    (move_stl_vertex, EITHER, "stl"),
    (flip_triangle, EITHER, "stl"),
    (drop_triangle, EITHER, "stl"),
    (remove_tooth, EITHER, "stl"),
    (scale_stl, EITHER, "stl"),
    (mirror_stl, EITHER, "stl"),
    (turn_stl, EITHER, "stl"),
    (move_pole, (*EITHER, "assembly"), "step"),
    (move_pole, (*EITHER, "assembly"), "step"),
    (move_pole, (*EITHER, "assembly"), "step"),
    (change_radius, (*EITHER, "assembly"), "step"),
    (second_solid, (*EITHER, "assembly"), "step"),
    (to_inches, (*EITHER, "assembly"), "step"),
    (drop_face, (*EITHER, "assembly"), "step"),
    (paint, (*EITHER, "assembly"), "step"),
    (swap_names, ("assembly",), "step"),
    (displace_step, ("assembly",), "step"),
    (move_3mf_vertex, (*EITHER, "assembly"), "3mf"),
    (inches_3mf, (*EITHER, "assembly"), "3mf"),
    (paint_3mf, (*EITHER, "assembly"), "3mf"),
    (swap_colours_3mf, ("assembly",), "3mf"),
    (displace_3mf, ("assembly",), "3mf"),
    (drop_3mf_triangle, (*EITHER, "assembly"), "3mf"),
    (move_glb_vertex, (*EITHER, "assembly"), "glb"),
    (paint_glb, (*EITHER, "assembly"), "glb"),
    (displace_glb, ("assembly",), "glb"),
    (move_contour, EITHER, "dxf"),
    (bulge_contour, EITHER, "dxf"),
]


def tampered(made: Path, folder: Path, number: int) -> tuple[str, list[Claim]]:
    """Return what was done to a file at random, and the claims that fail then."""
    rng = random.Random(SEED + number)
    act, names, ending = KINDS[number % len(KINDS)]
    path = folder / f"{rng.choice(names)}.{ending}"
    before = (made / path.name).read_bytes()
    path.write_bytes(before)
    act(path, rng)
    assert path.read_bytes() != before, f"{number}: {act.__name__} of {path.name} with nothing changed"
    return f"{number}: {act.__name__} of {path.name}", [claim for claim in claims(path, made) if claim.passed is False]


@pytest.mark.parametrize("number", range(len(KINDS)))
def test_each_kind_of_change_is_noticed(made: Path, tmp_path: Path, number: int) -> None:
    what, failed = tampered(made, tmp_path, number)
    assert failed, what


@pytest.mark.long
def test_200_changes_are_noticed(made: Path, tmp_path: Path) -> None:
    found = [tampered(made, tmp_path, number) for number in range(COUNT)]
    assert [what for what, failed in found if not failed] == []


def test_files_as_they_are_written_pass(made: Path) -> None:
    for path in sorted(made.iterdir()):
        if path.suffix != ".json" and path.name not in ("assembly.stl", "assembly.dxf"):
            assert [claim.text for claim in claims(path, made) if claim.passed is False] == []
