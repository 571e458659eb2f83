"""The FreeCAD workbench in FreeCAD's window on a virtual display: panels, data sheet and drawings.

Skipped without FreeCAD or xvfb-run. Pictures of the screen stay in the folder of the test.
"""

import json
import math
import os
import shutil
import signal
import subprocess
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest
from support.freecad import freecad_environment, install_workbench

FREECAD = shutil.which("freecad") or shutil.which("FreeCAD")
XVFB = shutil.which("xvfb-run")
CHANGES = 20
SAME_VOLUME = 1e-9
LEAST_COLOURS = 50
"""Colours of a screen on which there is a shaded body: far more than those of an empty window."""

CONFIGURATION = """<?xml version="1.0" encoding="UTF-8" standalone="no" ?>
<FCParameters><FCParamGroup Name="Root"><FCParamGroup Name="BaseApp"><FCParamGroup Name="Preferences">
<FCParamGroup Name="General"><FCText Name="AutoloadModule">GearcadWorkbench</FCText></FCParamGroup>
<FCParamGroup Name="Mod"><FCParamGroup Name="Start"><FCBool Name="ShowOnStartup" Value="0"/></FCParamGroup></FCParamGroup>
</FCParamGroup></FCParamGroup></FCParamGroup></FCParameters>
"""
"""FreeCAD begins with the workbench, and without its start page, which needs a browser."""

FIELDS = {
    "Gear": "Teeth NormalModule FaceWidth HelixAngle ProfileShift ToothThinning RackPressureAngle BodyBore BodyKeyway",
    "Ring": "Teeth NormalModule FaceWidth HelixAngle ProfileShift ToothThinning RackPressureAngle CutterTeeth BodyRimDiameter",
    "Pair": "PinionTeeth WheelTeeth NormalModule FaceWidth HelixAngle CentreDistance PinionProfileShift PinionBodyBore Angle",
    "Rack": "Teeth Length NormalModule FaceWidth Height HelixAngle TipAlteration ToothThinning RackPressureAngle TipChamfer",
    "Planetary": "SunTeeth PlanetTeeth RingTeeth Planets NormalModule FaceWidth HelixAngle SunProfileShift PlanetProfileShift",
    "Spline": "Designation Standard NominalDiameter DesignModule Teeth PressureAngle Centring Length ShaftBore",
}
"""Some of the fields of each panel."""


@pytest.fixture(scope="module")
def window(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    """Return what window.py found in FreeCAD on a virtual display."""
    if FREECAD is None or XVFB is None:
        pytest.skip("FreeCAD or xvfb-run is not installed")
    folder = tmp_path_factory.mktemp("window")
    home = folder / "home"
    install_workbench(home)
    configuration = folder / "user.cfg"
    configuration.write_text(CONFIGURATION, encoding="utf-8")
    environment = freecad_environment(home, WORKBENCH_TEST=str(folder), LANG="C.UTF-8", QTWEBENGINE_DISABLE_SANDBOX="1")
    script = Path(__file__).with_name("window.py")
    command = [XVFB, "-a", "-s", "-screen 0 1400x1000x24", FREECAD, "-u", str(configuration), str(script)]
    with (folder / "freecad.log").open("w", encoding="utf-8") as log:
        running = subprocess.Popen(command, env=environment, cwd=folder, stdout=log, stderr=log, process_group=0)
        try:
            running.wait(timeout=3000)
        finally:
            if running.poll() is None:
                os.killpg(running.pid, signal.SIGKILL)
                running.wait()
    found: dict[str, Any] = json.loads((folder / "figures.json").read_text(encoding="utf-8"))
    assert "error" not in found, found["error"]
    return found


@pytest.mark.long
def test_each_kind_is_changed_twenty_times_in_its_panel(window):
    assert set(window["kinds"]) == set(FIELDS)
    for kind, found in window["kinds"].items():
        assert set(FIELDS[kind].split()) <= set(found["fields"]), kind
        volumes = [volume for valid, volume in found["volumes"] if valid]
        assert len(volumes) == len(set(volumes)) == CHANGES, kind
        assert found["reopened"][:2] == [True, pytest.approx(volumes[-1], rel=SAME_VOLUME)], kind
        assert found["icon"] == f"{kind.lower()}.svg"
        assert found["colours"] > LEAST_COLOURS, kind
    _require_equal_steps(window["kinds"])
    last = {kind: found["reopened"][2] for kind, found in window["kinds"].items()}
    assert last == {"Gear": 40, "Ring": -40, "Pair": 61, "Rack": 40.0, "Planetary": "0.400", "Spline": 45.0}


def _require_equal_steps(kinds: dict[str, Any]) -> None:
    """Compare volumes with what does not come from a kernel: the same section at each face width, and the teeth of a gear.

    A gear of 2 mm module has within 4 % the volume of its reference cylinder without the bore of 12 mm.
    """
    for kind in ("Rack", "Spline"):
        volumes = [volume for _, volume in kinds[kind]["volumes"]]
        steps = [after - before for before, after in pairwise(volumes)]
        assert steps == pytest.approx([steps[0]] * len(steps), rel=1e-6), kind
    for teeth, (_, volume) in enumerate(kinds["Gear"]["volumes"], 21):
        assert volume == pytest.approx(math.pi * 20 * (teeth**2 - 6**2), rel=0.04), teeth


@pytest.mark.long
def test_cancel_restores_and_ok_keeps(window):
    found, gears = window["ok and cancel"], window["kinds"]["Gear"]["volumes"]
    assert found["new and cancelled"] == []
    assert found["kept"] == [25, pytest.approx(gears[4][1], rel=SAME_VOLUME)]
    assert found["line"] == [True, "Gear: gear.teeth = 2: must be a whole number from 3 to 2000"]
    assert not found["line after"]
    assert found["cancelled"] == [25, pytest.approx(gears[4][1], rel=SAME_VOLUME), True, False]
    assert found["undone"] == []  # making the gear was one step


@pytest.mark.long
def test_data_sheet_and_drawings_are_shown_and_made_again(window):
    found = window["documents"]
    kinds = [kind for kind, _ in found["once"]]
    assert (kinds.count("Spreadsheet::Sheet"), kinds.count("TechDraw::DrawPage")) == (1, 3)
    assert found["once"] == found["twice"]
    for picture in ("data_sheet once", "drawing once", "data_sheet twice", "drawing twice"):
        assert found[picture] > LEAST_COLOURS, picture
