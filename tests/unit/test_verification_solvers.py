"""Meshes in other readers and CalculiX: figures of our own pass, and files or figures that were changed do not."""

import re
import sys
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace

import pytest
from support.calculix import needs_ccx
from support.specs import TEMPLATES

import gearcad
from gearcad import Body, Gear, GearPair
from gearcad.designs import GearDesign, PairDesign, read_spec
from gearcad.jobs.verification_solvers import MESH_FORMATS, _decks, _middles, _positions, judge_by_calculix, judge_meshes
from gearcad.meshing.bodies.quality import LEAST_SCALED_JACOBIAN
from gearcad.meshing.options import MeshOptions
from gearcad.verification import calculix
from gearcad.verification.calculix import PLANE_PERMITTED, compare
from gearcad.verification.claims import Claim, ClaimSubject, Judge, VerificationLevel
from gearcad.verification.exact_parts import ExactPart
from gearcad.verification.mesh_files import StatedMesh, judge_mesh

GEAR = Gear(teeth=17, normal_module=2, face_width=6, helix_angle=12, profile_shift=0.2, body=Body(bore=14))


def template(name: str) -> PairDesign:
    design = read_spec(TEMPLATES / f"{name}.toml")
    assert isinstance(design, PairDesign)
    return design


def wrong(claims: list[Claim]) -> list[str]:
    return [claim.text for claim in claims if claim.passed is not True]


@pytest.fixture(scope="module", params=["hex20", "tri6"])
def meshed(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, StatedMesh]:
    """A folder with the mesh of a gear, of three teeth or of a section, and what is said of it."""
    folder = tmp_path_factory.mktemp(request.param)
    what = {"hex20": "teeth:3", "tri6": "ring"}[request.param]
    options = MeshOptions(what=what, element=request.param, format=",".join(MESH_FORMATS), size=0.6)
    result = gearcad.mesh(GearDesign(name="gear", gear=GEAR, mesh=options))
    for kind in result.plan.options.formats:
        kind.entry.write(result.mesh, folder / f"gear.{kind.value}")
    (judged,), (plan,) = result.judged.values(), result.plan.gears.values()
    document = {**judged.to_dict(), "end_radius": plan.end_radius}
    least = LEAST_SCALED_JACOBIAN[result.plan.element]
    return folder, StatedMesh(ExactPart(GEAR), document, result.plan.solid, least)


def test_a_mesh_as_it_is_written_passes(meshed: tuple[Path, StatedMesh]) -> None:
    claims = list(judge_mesh(meshed[0], "gear", meshed[1]))
    assert wrong(claims) == []
    assert len(claims) == 13
    assert {claim.judge for claim in claims} == {"meshio", "gmsh"}


def changed(meshed: tuple[Path, StatedMesh], name: str, change: Callable[[str], str]) -> set[str]:
    """Return the quantities that fail after a change to the text of a file, which is then restored."""
    path = meshed[0] / name
    before = path.read_bytes()
    path.write_bytes(change(before.decode("latin-1")).encode("latin-1"))
    try:
        claims = list(judge_mesh(meshed[0], "gear", meshed[1]))
    finally:
        path.write_bytes(before)
    failed = [claim for claim in claims if claim.passed is False]
    assert {claim.where for claim in failed} == {name}
    return {claim.quantity for claim in failed}


def moved(text: str) -> str:
    """Move the first node of the first flank in a .inp by 5 µm along x."""
    nodes = re.search(r"\*NSET, NSET=left_flank_0\n\s*(\d+)", text)
    assert nodes is not None
    row = re.search(rf"\n\s*{nodes[1]}\s*,\s*(-?[\d.]+),", text)
    assert row is not None
    return text.replace(row[0], row[0].replace(row[1], f"{float(row[1]) + 0.005:.12f}"), 1)


def test_a_node_moved_off_the_flank_is_noticed(meshed: tuple[Path, StatedMesh]) -> None:
    assert changed(meshed, "gear.inp", moved) == {"distance of nodes of flanks and fillets from the exact surface"}


def test_a_side_that_was_renamed_is_noticed(meshed: tuple[Path, StatedMesh]) -> None:
    assert "sides" in changed(meshed, "gear.inp", lambda text: text.replace("left_flank_1", "left_flunk_1"))
    assert "sides with all their faces" in changed(
        meshed, "gear.msh", lambda text: text.replace("left_flank_1", "left_flunk_1")
    )


@pytest.mark.parametrize("ending", MESH_FORMATS)
def test_half_a_file_is_noticed(meshed: tuple[Path, StatedMesh], ending: str) -> None:
    assert changed(meshed, f"gear.{ending}", lambda text: text[: len(text) // 2])


def test_figures_that_are_too_good_are_noticed(meshed: tuple[Path, StatedMesh]) -> None:
    folder, stated = meshed
    document = {**stated.document, "nodes": stated.document["nodes"] + 1, "end_radius": stated.document["end_radius"] + 0.01}
    claims = list(judge_mesh(folder, "gear", StatedMesh(stated.part, document, stated.solid, 1.0)))
    failed = {claim.quantity for claim in claims if claim.passed is False}
    assert failed == {"nodes", "least scaled Jacobian is at least 1", "volume" if stated.solid else "area"}


# ---------------------------------------------------------------------- CalculiX

JUDGE = Judge(ClaimSubject.CALCULIX, VerificationLevel.FULL, "pair", "CalculiX")


def figures(**changes: float) -> dict[str, object]:
    """Figures of a position as a deck has them."""
    share = changes.get("load_share", 0.6)
    pairs = [
        {"pinion": "a", "wheel": "c", "load_share": share, "contact_pressure": changes.get("pressure", 900.0)},
        {"pinion": "b", "wheel": "d", "load_share": 1 - share, "contact_pressure": None},
    ]
    root = {"pinion": changes.get("root", 200.0), "wheel": 210.0}
    return {"transmission_error": changes.get("error", 12.0), "pairs": pairs, "root_stress": root}


@pytest.mark.parametrize(
    ("changes", "quantity"),
    [
        ({"error": 12.03}, "transmission error (µm)"),
        ({"root": 201.1}, "root stress of the pinion (MPa)"),
        ({"load_share": 0.603}, "load share"),
        ({"pressure": 921.0}, "contact pressure (MPa)"),
    ],
)
def test_a_figure_that_is_off_fails(changes: dict[str, float], quantity: str) -> None:
    assert wrong(list(compare(figures(), figures(), JUDGE, PLANE_PERMITTED, "at 0°"))) == []
    claims = compare(figures(**changes), figures(), JUDGE, PLANE_PERMITTED, "at 0°")
    assert [claim.quantity for claim in claims if claim.passed is False] == [f"{quantity}, at 0°"]


def test_without_calculix_and_for_other_kinds_nothing_is_judged(monkeypatch: pytest.MonkeyPatch) -> None:
    (gear,) = judge_by_calculix(GearDesign(name="gear", gear=GEAR))
    assert gear.passed is None
    assert gear.reason == "decks are of pairs, this is a gear"
    monkeypatch.setattr(calculix, "_PROGRAM", "no-such-program")
    (pair,) = judge_by_calculix(template("fzg-c"))
    assert pair.passed is None
    assert "not installed" in pair.reason


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux limits CPU time")
@pytest.mark.parametrize(
    ("command", "told"),
    [("while :; do :; done", "CalculiX did not come to an end in 1 s of CPU time"), ("sleep 1.5", "")],
    ids=["busy", "waiting"],
)
def test_calculix_may_take_so_much_cpu_time(command: str, told: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What other work the machine has does not count."""
    program = tmp_path / "ccx"
    program.write_text(f"#!/bin/sh\n{command}\n", encoding="ascii")
    program.chmod(0o755)
    monkeypatch.setattr(calculix, "_PROGRAM", str(program))
    assert calculix._run(tmp_path / "pair", 1.0) == told


@dataclass(frozen=True)
class Shared:
    """Decks of a pair whose load share between two pairs of teeth changes at once at two places, elsewhere slowly."""

    pair: GearPair
    left: bool = True
    solid: bool = False

    @property
    def cycle(self) -> "Shared":
        return self

    def solve(self, roll_angle: float) -> SimpleNamespace:
        pitch = 360 / self.pair.pinion.tooth_count
        place = roll_angle / pitch % 1.0
        share = 0.02 * place + 0.5 * (0.2 < place < 0.7)
        return SimpleNamespace(contacts=[SimpleNamespace(tooth=0, share=share), SimpleNamespace(tooth=1, share=1 - share)])


def test_calculix_is_asked_all_over_the_mesh_cycle_and_where_the_load_passes_quickly() -> None:
    decks = Shared(template("fzg-c").pair)
    pitch = 360 / decks.pair.pinion.tooth_count
    positions = _positions(decks)  # type: ignore[arg-type]
    shares = sorted(position / pitch % 1.0 for position in positions)
    assert len(positions) >= 5
    for quick in (0.2, 0.7):
        assert min(abs(share - quick) for share in shares) <= 0.5 / 48 + 1e-9
    gaps = [after - before for before, after in pairwise([*shares, shares[0] + 1])]
    assert max(gaps) <= 0.34 and min(gaps) > 1e-3
    assert len(among(positions, _middles(decks), pitch)) == 2  # type: ignore[arg-type]


def among(positions: Sequence[float], wanted: Sequence[float], pitch: float) -> list[float]:
    """Return the positions that are wanted, whole pitches aside."""
    return [each for each in positions if any(abs((each - other + pitch / 2) % pitch - pitch / 2) < 1e-9 for other in wanted)]


@needs_ccx
@pytest.mark.long
@pytest.mark.parametrize("name", ["fzg-c", "ring-22-70"])
def test_meshes_and_calculix_judge_a_spur_and_a_ring_pair(name: str, tmp_path: Path) -> None:
    design = template(name)
    exact = {gear.name: ExactPart(gear) for gear in design.pair.gears}
    assert wrong(list(judge_meshes(design, tmp_path, exact, made=True))) == []
    claims = list(judge_by_calculix(design))
    decks = _decks(design)
    pitch = 360 / decks.pair.pinion.tooth_count
    middles = [f"at {angle:.4g}°" for angle in among(_positions(decks), _middles(decks), pitch)]
    of_middles = [claim for claim in claims if any(claim.quantity.endswith(place) for place in middles)]
    assert wrong([claim for claim in of_middles if "pressure" not in claim.quantity or claim.passed is not None]) == []
    assert len(of_middles) == 10
    # Where a loaded tip touches before it should, a difference is told with its position.
    assert len({claim.quantity.rpartition(", ")[2] for claim in claims}) >= 5
