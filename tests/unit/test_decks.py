"""What decks refuse, and what stands in them: without any solver."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from gearcad import Gear, GearPair, Load, Material
from gearcad.check.options import CheckOptions
from gearcad.check.task import check_task
from gearcad.core.errors import InputError
from gearcad.core.records import Role
from gearcad.decks.plane import PlaneDecks, plane_tooth_deck
from gearcad.geometry import FlankModification
from gearcad.mounting import Mounting


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
