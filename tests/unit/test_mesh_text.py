"""Meshes as text: numbers in columns, and decks of Abaqus and CalculiX; what decks refuse."""

from __future__ import annotations

from pathlib import Path

import meshio
import numpy as np
import pytest
from support.boxes import box, two_boxes

from gearcad import Gear, GearPair, Load, Material
from gearcad.check.options import CheckOptions
from gearcad.check.task import check_task
from gearcad.core.errors import InputError, ParameterError
from gearcad.core.records import Role
from gearcad.decks.plane import PlaneDecks, plane_tooth_deck
from gearcad.geometry import FlankModification
from gearcad.meshing import Element, ElementMesh
from gearcad.meshing.files import decimals, decimals_width, element_type, lines, wholes, write_inp
from gearcad.mounting import Mounting

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
