"""`gearcad.mesh`: what options ask for is what comes out, as objects of other libraries, as text, and as decks."""

import math
import sys
from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest
from skfem import Basis, FacetBasis, Functional
from support.boxes import AREAS, box, two_boxes

import gearcad
from gearcad import BasicRack, Body, FlankModification, Gear, GearPair, Load, Material, ParameterError
from gearcad.check.options import CheckOptions
from gearcad.check.task import check_task
from gearcad.core.errors import InputError
from gearcad.core.records import Role
from gearcad.decks.plane import PlaneDecks, plane_tooth_deck
from gearcad.meshing import Element, ElementMesh
from gearcad.meshing.bodies.quality import measure_side
from gearcad.meshing.fem import shape_slopes
from gearcad.meshing.files import decimals, decimals_width, element_type, lines, wholes, write_inp
from gearcad.meshing.options import MeshOptions
from gearcad.mounting import Mounting

GEAR = Gear(teeth=20, normal_module=2, face_width=8, body=Body(bore=12))

PAIR = GearPair(
    pinion=Gear(teeth=17, normal_module=2, face_width=8, body=Body(bore=12)),
    wheel=Gear(teeth=23, normal_module=2, face_width=6, body=Body(bore=20)),
)


def edge_turns(mesh: ElementMesh, side: str) -> np.ndarray:
    """By how much (deg) each edge of a side turns."""
    end, other, middle = np.moveaxis(mesh.points[mesh.face_cells(side)], 1, 0)
    first, last = 4 * middle - 3 * end - other, 3 * other + end - 4 * middle
    angles = [np.arctan2(each[:, 1], each[:, 0]) for each in (first, last)]
    return np.degrees(np.abs((angles[1] - angles[0] + math.pi) % (2 * math.pi) - math.pi))


@pytest.mark.parametrize("count", [4, 9])
def test_fillets_have_as_many_elements_as_are_asked_for(count: int) -> None:
    mesh = gearcad.mesh(GEAR, what="sector", fillet_elements=count).mesh
    for side in ("left_fillet_0", "right_fillet_0"):
        assert 30 / edge_turns(mesh, side).max() == pytest.approx(count, rel=0.15)


def test_edges_on_flanks_are_as_long_as_asked_for() -> None:
    for size in (0.2, 0.5):
        mesh = gearcad.mesh(GEAR, what="sector", size=size).mesh
        ends = mesh.points[mesh.face_cells("left_flank_0")[:, :2]]
        longest = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).max()
        assert 0.7 * size < longest < 1.1 * size


@pytest.mark.parametrize(
    ("element", "roll"),
    [
        *((Element.QUAD8, 0.0), (Element.HEX8, 5.0)),
        *(pytest.param(*each, marks=pytest.mark.long) for each in ((Element.QUAD8, 5.0), (Element.HEX8, 0.0))),
    ],
)
def test_flanks_of_a_pair_touch_at_the_roll_angle(element: Element, roll: float) -> None:
    """The distance of a flank's nodes from the mate's: none overlaps, and some are near."""
    mesh = gearcad.mesh(
        PAIR, what="pair:3", element=element.value, size=0.25 if element is Element.HEX8 else 0.1, roll=roll
    ).mesh
    pinion, wheel = (mesh.points[mesh.nodes(f"{gear}_left_flank_0")] for gear in ("pinion", "wheel"))
    gap = min(np.hypot(*(wheel[:, :2] - place[:2]).T).min() for place in pinion)
    assert gap < 0.2
    angle = math.radians(PAIR.working_transverse_pressure_angle)
    tangent = np.array([math.sin(angle), math.cos(angle)])
    rolled = PAIR.path_of_contact.C + math.radians(roll) * PAIR.pinion.base_diameter / 2
    contact = PAIR.pinion.base_diameter / 2 * np.array([math.cos(angle), -math.sin(angle)]) + rolled * tangent
    assert np.hypot(*(pinion[:, :2] - contact).T).min() < 0.15


def test_a_negative_torque_makes_right_flanks_touch() -> None:
    result = gearcad.mesh(PAIR, Load(torque=-40), what="pair:3", size=0.4)
    faces = {side: len(result.mesh.sides[f"pinion_{side}_flank_0"]) for side in ("left", "right")}
    assert faces["right"] >= faces["left"]
    ahead = result.mesh.points[result.mesh.nodes("pinion_right_flank_0")]
    behind = result.mesh.points[result.mesh.nodes("wheel_right_flank_0")]
    assert min(np.hypot(*(behind - place)[:, :2].T).min() for place in ahead) < 0.02
    assert not result.plan.left


def test_the_whole_part_has_keyway_and_hub() -> None:
    body = Body(bore=6, keyway_width=2, keyway_depth=1, hub_diameter=11, hub_length=2, end_chamfer=0.5)
    gear = Gear(teeth=9, normal_module=2, face_width=4, profile_shift=0.5, rack=BasicRack(root_radius="full"), body=body)
    result = gearcad.mesh(gear, what="part", elements=20_000)
    judged = result.judged["gear"]
    assert {"keyway", "hub", "hub_front", "end_chamfers", "bore", "tip_8"} <= set(result.mesh.sides)
    assert result.mesh.element is Element.TET10 and result.passed
    assert judged.whole == pytest.approx(judged.exact, rel=1e-4)


def test_modified_flanks_are_meshed_as_modified() -> None:
    gear = Gear(
        teeth=20,
        normal_module=2,
        face_width=8,
        helix_angle=15,
        body=Body(bore=12),
        modification=FlankModification(tip_relief=20, tip_relief_length=2, lead_crowning=10),
    )
    result = gearcad.mesh(gear, what="sector", model="3d")
    plain = gearcad.mesh(Gear(teeth=20, normal_module=2, face_width=8, helix_angle=15, body=Body(bore=12)), what="sector")
    assert result.passed and result.judged["gear"].deviations.nodes < 1e-12
    assert plain.judged["gear"].whole - result.judged["gear"].whole == pytest.approx(
        plain.judged["gear"].exact - result.judged["gear"].exact, rel=2e-3
    )


def test_options_are_those_of_a_design_unless_they_are_given() -> None:
    options = MeshOptions(what="teeth:3", element="tri6")
    assert gearcad.mesh(GEAR, mesh=options).plan.options == options
    assert gearcad.mesh(GEAR, mesh=options, what="sector").plan.options == MeshOptions(what="sector", element="tri6")
    with pytest.raises(ParameterError, match=r"^mesh = 5: must be a MeshOptions$"):
        gearcad.mesh(GEAR, mesh=5)
    with pytest.raises(ParameterError, match=r"^what = 3: must be"):
        gearcad.mesh(GEAR, what=3)
    with pytest.raises(LookupError, match="there are several meshes: pinion, wheel"):
        gearcad.mesh(PAIR, what="sector").mesh  # noqa: B018


@Functional
def size(w):  # type: ignore[no-untyped-def]
    return 1.0 + 0.0 * w.x[0]


def bent(element: Element) -> ElementMesh:
    """A box bent about the z axis, 5 mm below it, and twisted: edges and faces are curved."""
    mesh = box(element)
    x, y, z = mesh.points.T
    turn = y / 4 + z / 8
    return replace(mesh, points=np.stack([(5 + x) * np.cos(turn), (5 + x) * np.sin(turn), z], axis=1))


def gauss(dimension: int) -> tuple[np.ndarray, np.ndarray]:
    """Places (p, dimension) in 0 ... 1 and weights (p,) that are exact to the ninth power."""
    places, weights = np.polynomial.legendre.leggauss(5)
    places, weights = (1 + places) / 2, weights / 2
    grid = np.stack(np.meshgrid(*[places] * dimension, indexing="ij"), -1).reshape(-1, dimension)
    return grid, np.prod(np.stack(np.meshgrid(*[weights] * dimension, indexing="ij"), -1).reshape(-1, dimension), axis=1)


def area(mesh: ElementMesh, name: str) -> float:
    """mm², or mm, of a side of quadrangles or edges, by our own shape functions."""
    dimension = mesh.element.shape.dimension - 1
    places, weights = gauss(dimension)
    tangents = np.einsum("pdn,mnc->mpdc", shape_slopes(mesh.element.shape.face, places), mesh.points[mesh.face_cells(name)])
    lengths = np.linalg.norm(np.cross(tangents[:, :, 0], tangents[:, :, 1] if dimension == 2 else [0.0, 0.0, 1.0]), axis=-1)
    return float(lengths.sum(axis=0) @ weights)


@pytest.mark.parametrize("element", Element)
def test_scikit_fem_has_parts_and_sides(element: Element) -> None:
    mesh = two_boxes(element)
    theirs = mesh.to_skfem()
    own = theirs.elem()
    for part in mesh.parts:
        assert size.assemble(Basis(theirs, own, elements=part)) == pytest.approx(6.0)
        assert theirs.p[0, theirs.t[:, theirs.subdomains[part]]].min() == (5.0 if part == "wheel" else 0.0)
    assert set(theirs.boundaries) == set(mesh.sides)
    for name in mesh.sides:
        basis = FacetBasis(theirs, own, facets=name)
        assert size.assemble(basis) == pytest.approx(AREAS[name.partition("_")[2]])


@pytest.mark.parametrize("element", [Element.QUAD8, Element.HEX20])
def test_nodes_that_scikit_fem_wants_do_not_change_curved_elements(element: Element) -> None:
    mesh = bent(element)
    theirs = mesh.to_skfem()
    own = theirs.elem()
    for name in mesh.sides:
        assert size.assemble(FacetBasis(theirs, own, facets=name, intorder=8)) == pytest.approx(area(mesh, name), rel=1e-7)
    places, weights = gauss(element.shape.dimension)
    slopes = np.einsum("pdn,mnc->mpdc", shape_slopes(element.value, places), mesh.points[mesh.cells])
    dimension = element.shape.dimension
    volume = float((np.linalg.det(slopes[..., :dimension]) @ weights).sum())
    assert size.assemble(Basis(theirs, own, intorder=8)) == pytest.approx(volume, rel=1e-12)


def test_scikit_fem_finds_its_places_on_small_faces_far_from_the_origin() -> None:
    gear = Gear(teeth=23, normal_module=2, face_width=12, helix_angle=-18, body=Body(bore=20))
    mesh = gearcad.mesh(gear, what="sector", element="hex20", size=1.0).mesh
    theirs = mesh.to_skfem()
    for name in ("left_flank_0", "end_front"):
        area = size.assemble(FacetBasis(theirs, theirs.elem(), facets=name))
        assert area == pytest.approx(measure_side(mesh, name).size, rel=1e-10)


@pytest.mark.parametrize("element", Element)
def test_meshio_has_parts_and_sides_as_sets(element: Element) -> None:
    mesh = two_boxes(element)
    theirs = mesh.to_meshio()
    solid, faces = theirs.cells
    assert np.array_equal(solid.data, mesh.cells)
    for name, part in mesh.parts.items():
        assert np.array_equal(theirs.cell_sets[name][0], np.arange(part.start, part.stop))
        assert len(theirs.cell_sets[name][1]) == 0
    for name in mesh.sides:
        assert len(theirs.cell_sets[name][0]) == 0
        assert np.array_equal(faces.data[theirs.cell_sets[name][1]], mesh.face_cells(name))
        assert np.array_equal(theirs.point_sets[name], mesh.nodes(name))


def test_a_mesh_without_sides_is_one_too() -> None:
    mesh = replace(box(Element.HEX20), sides={}, matched={})
    assert [block.type for block in mesh.to_meshio().cells] == ["hexahedron20"]
    theirs = mesh.to_skfem()
    assert size.assemble(Basis(theirs, theirs.elem())) == pytest.approx(6.0)


def test_without_pyvista_its_name_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyvista", None)
    with pytest.raises(ImportError, match="needs PyVista: pip install pyvista"):
        box(Element.TRI6).to_pyvista()


def test_pyvista_shares_nodes_and_fields() -> None:
    pytest.importorskip("pyvista")
    mesh = box(Element.HEX20)
    theirs = mesh.to_pyvista()
    assert np.array_equal(theirs.points, mesh.points)
    assert np.array_equal(theirs.cells.reshape(-1, 21)[:, 1:], mesh.cells)
    assert np.array_equal(np.flatnonzero(theirs.point_data["left_flank"] == 0), mesh.nodes("left_flank_0"))


CALCULIX_READS = 20
"""Characters of a number; a longer one is an error there."""

CALCULIX_TAKES = 16
"""Numbers of a line."""


def test_whole_numbers_are_written_as_python_writes_them() -> None:
    numbers = np.array([0, 1, 9, 10, 9999, 10_000, 10_001, 99_999_999, 100_000_000, 2**31 - 1])
    assert lines(wholes(numbers, 10)).splitlines() == [f"{number:10d}" for number in numbers]
    assert lines(wholes(numbers[:4], 2)).splitlines() == [f"{number:2d}" for number in numbers[:4]]


@pytest.mark.parametrize("largest", [0.5, 9.9999999999996, 10.0, 99.75, 12345.0, 999_999.5])
def test_decimals_are_the_nearest(largest: float) -> None:
    numbers = np.r_[np.array([0.0, -0.0, 1e-13, -1e-13, 4e-13, -2.5, 0.1, -largest, largest]), np.geomspace(1e-9, largest, 99)]
    numbers = numbers[np.abs(numbers) <= largest]
    text = lines(decimals(numbers, decimals_width(largest))).splitlines()
    assert max(len(number) for number in text) <= CALCULIX_READS
    # Scaling by 1e12 rounds once, writing a second time.
    assert np.abs(np.array(text, float) - numbers).max() <= 0.5e-12 + 2 * np.spacing(largest)
    assert text[0].strip() == text[3].strip() == "0.000000000000"


def test_a_mesh_a_kilometre_away_is_refused() -> None:
    with pytest.raises(ParameterError, match=r"mesh = 1000000 mm: must lie within 1000000 mm"):
        decimals_width(1e6)


@pytest.mark.parametrize("element", Element)
def test_a_deck_comes_back(element: Element, tmp_path: Path) -> None:
    mesh = two_boxes(element)
    write_inp(mesh, tmp_path / "mesh.inp")
    text = (tmp_path / "mesh.inp").read_text()
    rows = text.splitlines()
    data = [row.rstrip(",").split(",") for row in rows if not row.startswith("*")]
    assert max(len(row) for row in data) <= CALCULIX_TAKES
    (tmp_path / "mesh.inp").write_text(text.replace("CPE8", "S8R"))  # the one name of these elements that meshio knows
    read = meshio.read(tmp_path / "mesh.inp")
    assert np.abs(read.points - mesh.points).max() < 1e-12
    assert np.array_equal(np.concatenate([block.data for block in read.cells]), mesh.cells)
    for name in mesh.sides:
        assert np.array_equal(np.sort(read.point_sets[name]), mesh.nodes(name))


@pytest.mark.parametrize(
    ("element", "names"),
    [(Element.TRI6, ("CPE6", "CPS6")), (Element.QUAD8, ("CPE8", "CPS8")), (Element.HEX20, ("C3D20", "C3D20"))],
)
def test_sections_say_the_plane_state(element: Element, names: tuple[str, str], tmp_path: Path) -> None:
    assert tuple(element_type(element, plane_strain=strain) for strain in (True, False)) == names
    write_inp(box(element), tmp_path / "mesh.inp", plane_strain=False)
    assert _keywords(tmp_path / "mesh.inp")[1:3] == ["*NODE, NSET=nodes", f"*ELEMENT, TYPE={names[1]}, ELSET=gear"]


def test_parts_are_element_sets_and_sides_are_sets_and_surfaces(tmp_path: Path) -> None:
    mesh = two_boxes(Element.TET10)
    write_inp(mesh, tmp_path / "mesh.inp")
    assert _keywords(tmp_path / "mesh.inp") == [
        "*HEADING",
        "*NODE, NSET=nodes",
        *(f"*ELEMENT, TYPE=C3D10, ELSET={part}" for part in ("pinion", "wheel")),
        *(f"*NSET, NSET={name}" for name in mesh.sides),
        *(f"*SURFACE, NAME={name}, TYPE=ELEMENT" for name in mesh.sides),
    ]
    assert _numbers(tmp_path / "mesh.inp", "*ELEMENT, TYPE=C3D10, ELSET=wheel")[0][0] == mesh.parts["wheel"].start + 1


def test_surfaces_are_the_sides(tmp_path: Path) -> None:
    mesh = two_boxes(Element.HEX20)
    write_inp(mesh, tmp_path / "mesh.inp")
    for name, faces in mesh.sides.items():
        found = np.array(_numbers(tmp_path / "mesh.inp", f"*SURFACE, NAME={name}, TYPE=ELEMENT"))
        assert np.array_equal(found, np.stack([faces.elements + 1, faces.sides + 1], axis=1))


def test_nodes_of_cuts_meet_in_order(tmp_path: Path) -> None:
    """They ascend in both sets, so that any program keeps their order."""
    mesh: ElementMesh = box(Element.HEX20)
    write_inp(mesh, tmp_path / "mesh.inp")
    sets = [_numbers(tmp_path / "mesh.inp", f"*NSET, NSET=cut_{end}") for end in ("behind", "ahead")]
    behind, ahead = (mesh.points[np.concatenate(numbers) - 1] for numbers in sets)
    assert np.abs(ahead - behind - [0.0, 2.0, 0.0]).max() < 1e-12


def _keywords(path: Path) -> list[str]:
    return [row for row in path.read_text().splitlines() if row.startswith("*")]


def _numbers(path: Path, keyword: str) -> list[list[int]]:
    """The whole numbers of the lines after a keyword."""
    rows = path.read_text().partition(f"{keyword}\n")[2].partition("\n*")[0].splitlines()
    return [[int(word) for word in row.replace("S", "").rstrip(",").split(",")] for row in rows]


def _pair(**changes: object) -> GearPair:
    pinion, wheel = (Gear(teeth=z, normal_module=2.0, face_width=20.0, tooth_thinning=0.03) for z in (20, 30))
    return GearPair(pinion=pinion, wheel=wheel, **changes)  # type: ignore[arg-type]


def _decks(
    torque: float = 80.0, mounting: Mounting | None = None, pair: GearPair | None = None, **options: object
) -> PlaneDecks:
    options = {"pinion_support": "rigid", "wheel_support": "rigid", **options}
    return PlaneDecks(check_task(pair or _pair(), Material(), Load(torque=torque), CheckOptions(**options), mounting))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("parameter", "inputs"),
    [
        ("check.wheel_support", {"wheel_support": "free"}),
        ("check.cuts", {"body_teeth": 5, "cuts": "sliding"}),
        ("check.plane", {"plane": "stress"}),
        ("mounting.misalignment", {"mounting": Mounting(misalignment=10.0)}),
        ("mounting.misalignment_across", {"mounting": Mounting(misalignment_across=-3.0)}),
        ("mounting.pinion_pitch_error", {"mounting": Mounting(pinion_pitch_error=5.0)}),
    ],
)
def test_what_decks_do_not_treat_is_refused(parameter: str, inputs: dict[str, object]) -> None:
    with pytest.raises(InputError, match="deck") as found:
        _decks(**inputs)  # type: ignore[arg-type]
    assert found.value.parameter == parameter


def test_flanks_modified_along_the_face_must_have_their_middles_in_one_plane() -> None:
    crowned = Gear(teeth=20, normal_module=2.0, face_width=20.0, modification=FlankModification(lead_crowning=5.0))
    wheel = Gear(teeth=30, normal_module=2.0, face_width=20.0)
    _decks(pair=GearPair(pinion=crowned, wheel=wheel))
    with pytest.raises(InputError, match="axial_offset"):
        _decks(pair=GearPair(pinion=crowned, wheel=wheel, axial_offset=2.0))


def test_a_torque_too_small_for_any_mesh_is_refused_with_the_least_one() -> None:
    with pytest.raises(InputError, match="must be at least") as found:
        _decks(torque=0.01).at(0.0)
    assert found.value.parameter == "load.torque"
    least = float(found.value.permitted.split()[4])
    # The contact is as wide as so many cells.
    assert _decks(torque=1.02 * least).at(0.0).deck.torque == 1.02 * least


@pytest.mark.parametrize("torque", [80.0, -80.0])
def test_a_deck_loads_the_flanks_that_its_torque_presses(torque: float, tmp_path: Path) -> None:
    made = _decks(torque=torque).at(-6.0)
    pairs = made.expected["pairs"]
    side = "left" if torque > 0 else "right"
    assert {pair["pinion"]: pair["wheel"] for pair in pairs} == {
        f"pinion_{side}_flank_0": f"wheel_{side}_flank_0",
        f"pinion_{side}_flank_{1 if torque > 0 else 19}": f"wheel_{side}_flank_{29 if torque > 0 else 1}",
    }
    made.deck.write(tmp_path / "pair.inp")
    text = (tmp_path / "pair.inp").read_text()
    assert f"*CLOAD\nreference, 1, {torque * 1000:.12e}\n" in text
    assert max(map(len, text.splitlines())) <= 132
    # Each degree of freedom of the bore of the pinion once, in equations of two terms.
    equations = text.split("*EQUATION\n")[1].split("*SURFACE")[0].splitlines()
    assert len(equations) == 4 * len(made.deck.held.pinion)


@pytest.mark.parametrize(
    ("role", "torque"),
    [
        *((Role.PINION, 80.0), (Role.WHEEL, -80.0)),
        *(pytest.param(*each, marks=pytest.mark.long) for each in ((Role.PINION, -80.0), (Role.WHEEL, 80.0))),
    ],
)
def test_pressures_on_a_tooth_come_to_the_force_and_the_torque_of_the_check(role: Role, torque: float) -> None:
    decks = _decks(torque=torque)
    deck = plane_tooth_deck(decks, -6.0, role)
    local = np.array(deck.mesh.element.shape.faces)[deck.faces.sides]
    ends = deck.mesh.points[deck.mesh.cells[deck.faces.elements[:, None], local[:, :2]], :2]
    along = ends[:, 1] - ends[:, 0]
    force = decks.pair.common_width.width * deck.pressures[:, None] * np.stack([-along[:, 1], along[:, 0]], -1)
    x, y = ends.mean(axis=1).T
    moment = (x * force[:, 1] - y * force[:, 0]).sum() / 1000
    # Chords of elements of a quarter of the half width; on the wheel the teeth push the other way round than they turn.
    expected = -torque * (1 if role is Role.PINION else decks.pair.gear_ratio)
    assert moment == pytest.approx(expected, rel=1e-4)
    assert np.hypot(*force.sum(axis=0)) == pytest.approx(sum(deck.expected["forces"].values()), rel=2e-4)
