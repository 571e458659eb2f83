"""Sheets of tools: the drawn profiles against the teeth of tools that are made from the inputs by themselves."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from gearcad import BasicRack, Gear, Rack
from gearcad.cli import main
from gearcad.drawing.drawing_subjects import DrawnGear
from gearcad.drawing.options import DrawingOptions
from gearcad.drawing.shapes import Polyline
from gearcad.drawing.tool_sheet import draw_tool
from gearcad.drawing.views.tool_views import StraightTool, cutter_view
from gearcad.drawing.words import Draughting, Language, SheetWords
from gearcad.geometry.premachining import Finishing, Premachining, RackFinishing, RackPremachining, SemiTopping
from gearcad.verification.tool_sweep import counterpart_of, finishing_rack, tool_of
from gearcad.verification.tool_teeth import JoinedTeeth

HOB = {"tool_addendum": 1.4, "tool_tip_radius": 0.25, "protuberance": 0.14, "protuberance_angle": 8.0, "stock": 0.1}
WORDS = SheetWords.of(Language.ENGLISH)


def outline_of(tool: StraightTool) -> np.ndarray:
    """Points of the right half of a drawn tool, on arcs too, above its root."""
    points = np.array(Polyline(tuple(tool.right)).points)
    return points[points[:, 1] > -tool.root + 1e-9]


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"semi_topping": SemiTopping(angle=45.0, height=2.2)},
        {"topping": 3.0},
        {"tool_pressure_angle": 17.5},
        {"stock": 0.14},
    ],
    ids=str,
)
@pytest.mark.parametrize("helix_angle", [0.0, 18.0])
def test_the_drawn_hob_is_the_one_of_the_inputs(changes: dict[str, object], helix_angle: float) -> None:
    pre = Premachining(**HOB | changes)  # type: ignore[arg-type]
    gear = Gear(teeth=25, normal_module=3.0, profile_shift=0.2, helix_angle=helix_angle, face_width=20.0, premachining=pre)
    drawn, tool = StraightTool.of(gear), tool_of(gear)
    cosine = math.cos(tool.helix)  # type: ignore[union-attr]
    points = outline_of(drawn)
    # Heights of the sweep are from the circle on which the hob rolls, downwards to its tip.
    line = tool.tip_circle - tool.reference + drawn.addendum  # type: ignore[union-attr]
    off = tool.tooth.distance(points[:, 0] / cosine + 1j * (line - points[:, 1]))
    assert np.abs(off).max() < 1e-9


def test_the_drawn_tools_of_a_plain_gear_and_of_racks_are_those_of_the_inputs() -> None:
    gear = Gear(
        teeth=17, normal_module=2.0, face_width=10.0, rack=BasicRack(dedendum=1.3, root_radius=0.3), tooth_thinning=0.03
    )
    points = outline_of(StraightTool.of(gear))
    assert np.abs(tool_of(gear).tooth.distance(points[:, 0] - 1j * points[:, 1])).max() < 1e-9
    rack = Rack(teeth=8, normal_module=3.0, face_width=20.0, height=20.0, premachining=RackPremachining(**HOB))
    plain = replace(rack, premachining=RackPremachining())
    points, both = outline_of(StraightTool.of(rack)), counterpart_of(rack)
    assert isinstance(both, JoinedTeeth)
    assert np.abs(JoinedTeeth(both.teeth[:-1]).distance(points[:, 0] - 1j * points[:, 1])).max() < 1e-9  # the last is the wheel
    points = outline_of(StraightTool.of(plain))
    assert np.abs(counterpart_of(plain).distance(points[:, 0] - 1j * points[:, 1])).max() < 1e-9


def test_the_drawn_wheel_ends_on_its_circle() -> None:
    pre = Premachining(tool_addendum=1.4, tool_tip_radius=0.3, stock=0.1)
    end = Finishing(end_diameter=71.6, wheel_tip_radius=0.4)
    gear = Gear(teeth=25, normal_module=3.0, profile_shift=0.2, face_width=20.0, premachining=pre, finishing=end)
    drawn = StraightTool.finishing(gear)
    assert drawn is not None
    points = outline_of(drawn)
    off = finishing_rack(gear, 71.6 / 2, 0.4).tooth.distance(points[:, 0] + 1j * (0.2 * 3.0 - points[:, 1]))
    assert np.abs(off).max() < 1e-9
    rack = Rack(
        teeth=8,
        normal_module=3.0,
        face_width=20.0,
        height=20.0,
        premachining=RackPremachining(tool_addendum=1.4, tool_tip_radius=0.3, stock=0.1),
        finishing=RackFinishing(end_depth=3.1, wheel_tip_radius=0.4),
    )
    wheel = StraightTool.finishing(rack)
    assert wheel is not None
    assert wheel.joint[1] == pytest.approx(3.1, abs=1e-12)
    assert StraightTool.finishing(replace(rack, premachining=RackPremachining(**HOB), finishing=RackFinishing())) is None


@pytest.mark.parametrize("teeth", [30, -90])
def test_the_drawn_cutter_is_the_one_of_the_inputs(teeth: int, monkeypatch: pytest.MonkeyPatch) -> None:
    from gearcad.verification import tool_teeth

    monkeypatch.setattr(tool_teeth, "_CUTTER_POINTS", 4000)
    pre = Premachining(**HOB | {"tool_tip_radius": 0.1, "protuberance_angle": 6.0, "cutter_teeth": 25})  # type: ignore[arg-type]
    gear = Gear(teeth=teeth, normal_module=3.0, face_width=20.0, premachining=pre)
    view = cutter_view(gear, Draughting(WORDS, 1.0), "")
    outline = np.array([(x, y) for x, y, _ in view.figure.shapes[0].vertices])  # type: ignore[attr-defined]
    reference = 25 * 3.0 / 2
    off = tool_of(gear).tooth.distance(outline[1:-1, 1] + reference + 1j * outline[1:-1, 0])
    assert np.abs(off).max() < 2e-6  # chords of the judge


def test_a_sheet_tells_the_numbers_of_the_tool() -> None:
    pre = Premachining(**HOB | {"stock_tolerance": 0.02})  # type: ignore[arg-type]
    gear = Gear(teeth=25, normal_module=3.0, profile_shift=0.2, face_width=20.0, premachining=pre)
    sheet = draw_tool(DrawnGear(role="gear", gear=gear), DrawingOptions())
    assert sheet.name == "gear-tool"
    assert sheet.shown["tool.thickness"] == pytest.approx(math.pi * 3 / 2 - 0.2 / math.cos(math.radians(20)))
    assert sheet.shown["tool.addendum"] == pytest.approx(4.2)
    texts = " ".join(text.words for text in sheet.figure.texts)
    assert "0.1 ± 0.02" in texts and "0.14 / 8°" in texts


def test_the_command_draws_tools_in_german(tmp_path: Path) -> None:
    spec = tmp_path / "rack.toml"
    spec.write_text("[rack]\nteeth = 6\nnormal_module = 2.0\nface_width = 10.0\nheight = 12.0\n", encoding="utf-8")
    found = CliRunner().invoke(
        main,
        ["draw", str(spec), "--what", "tool", "--language", "de", "--format", "svg", "-o", str(tmp_path / "out"), "--quiet"],
    )
    assert found.exit_code == 0, found.output
    assert {path.name for path in (tmp_path / "out").iterdir()} == {"draw.json", "drawing-rack-tool.svg"}
    refused = CliRunner().invoke(main, ["draw", str(spec), "--what", "wheel", "-o", str(tmp_path / "no")])
    assert refused.exit_code != 0
    assert "what" in refused.output and "Traceback" not in refused.output
