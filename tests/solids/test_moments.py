"""Volume and second moment of boundaries against the CAD kernel's own integrals, and against formulas."""

from __future__ import annotations

import json
import math
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import pytest

from gearcad import Body, FlankModification, Gear, Rack
from gearcad.geometry import DoubleHelix
from gearcad.solids.exact.boundary import Boundary, Recorder, level_plane
from gearcad.solids.exact.inertia import moments
from gearcad.solids.exact.kernel import kernel_solid
from gearcad.solids.exact.rack_solid import rack_boundary
from gearcad.solids.exact.solid import gear_boundary
from gearcad.solids.exact.teeth import tube
from gearcad.solids.files.train_products import carrier_boundary
from gearcad.solids.train_plan import CarrierPlan

SAME = 1e-10
"""Relative: faces may miss their common edges by 1 nm, and the kernel integrates curved faces to 3e-11."""

EXACT = 1e-13
"""Relative: rounding, for cylinders and planes."""


def _bodied(teeth: int = 8, **given: Any) -> Gear:
    body = Body(bore=5, keyway_width=2, keyway_depth=1, hub_diameter=9, hub_length=2, end_chamfer=0.4)
    return Gear(teeth=teeth, normal_module=2, **{"face_width": 6, "body": body, **given})


def _ring(**given: Any) -> Gear:
    body = Body(rim_diameter=90, bolt_circle=82, bolt_holes=3, bolt_diameter=4, end_chamfer=0.3)
    return Gear(teeth=-30, normal_module=2, face_width=6, body=body, **given)


_RELIEVED = FlankModification(tip_relief=0.02, tip_relief_length=1.0, lead_crowning=0.01, helix_angle_modification=0.005)
_PINS = ((20.0, 0.0), (-10.0, 17.0), (-10.0, -17.0))

SOLIDS: dict[str, Callable[[], Boundary]] = {
    "spur": lambda: gear_boundary(_bodied(20)),
    "helical": lambda: gear_boundary(_bodied(helix_angle=15)),
    "chamfers below the root": lambda: gear_boundary(_bodied(12, face_width=12, body=Body(bore=5, end_chamfer=5.2))),
    "apex": lambda: gear_boundary(_bodied(helix_angle=25, double_helix=DoubleHelix(gap_width=0))),
    "gap": lambda: gear_boundary(_bodied(helix_angle=25, double_helix=DoubleHelix(gap_width=2, offset=0.3))),
    "modified": lambda: gear_boundary(_bodied(20, helix_angle=-10, modification=_RELIEVED)),
    "ring": lambda: gear_boundary(_ring(helix_angle=-18)),
    "rack": lambda: rack_boundary(Rack(teeth=2, normal_module=2, face_width=8, height=6, helix_angle=17)),
    "straight rack": lambda: rack_boundary(Rack(teeth=3, normal_module=2, face_width=8, height=6)),
    "carrier": lambda: carrier_boundary(CarrierPlan(_PINS, 6.0, 12.0, 28.0, (-2.0, 11.0), ((-2.0, 0.0), (9.0, 11.0)))),
}


@pytest.mark.parametrize("name", SOLIDS)
def test_moments_are_the_kernels(name: str) -> None:
    from OCP.BRepGProp import BRepGProp
    from OCP.gp import gp
    from OCP.GProp import GProp_GProps

    boundary, witness = SOLIDS[name](), GProp_GProps()
    BRepGProp.VolumeProperties_s(kernel_solid(boundary), witness)
    assert moments(boundary) == pytest.approx((witness.Mass(), witness.MomentOfInertia(gp.OZ_s())), rel=SAME)


@pytest.mark.parametrize("axis", [(0.0, 0.0), (40.0, -30.0)])
def test_a_pipe(axis: tuple[float, float]) -> None:
    recorder, ends = Recorder(1e-7), (3.0, 8.0)
    outer, inner = tube(recorder, 10.0, ends, axis, outward=True), tube(recorder, 4.0, ends, axis, outward=False)
    for which, z in enumerate(ends):
        loops = [outer[which].loop(along=True), inner[which].loop(along=False)]
        recorder.face(level_plane(z), loops, outward=which == 1)
    volume = math.pi * (10.0**2 - 4.0**2) * 5.0
    polar = volume * ((10.0**2 + 4.0**2) / 2 + math.hypot(*axis) ** 2)
    assert moments(recorder.boundary()) == pytest.approx((volume, polar), rel=EXACT)


def test_a_lift_and_a_turn_change_neither() -> None:
    def walls(recorder: Recorder) -> None:
        contours = tube(recorder, 3.0, (0.0, 5.0), (20.0, 0.0), outward=True)
        for which, z in enumerate((0.0, 5.0)):
            recorder.face(level_plane(z), [contours[which].loop(along=True)], outward=which == 1)

    here, there = Recorder(1e-7), Recorder(1e-7)
    walls(here)
    walls(there.moved(7.0, 0.3))
    assert moments(here.boundary()) == pytest.approx(moments(there.boundary()), rel=EXACT)


def test_a_carrier_is_its_plates_and_pins() -> None:
    plates = 2 * 2.0 * math.pi * (28.0**2 - 12.0**2)
    pins = [9.0 * math.pi * 9.0] * 3
    apart = [9.0 / 2 + x * x + y * y for x, y in _PINS]
    polar = plates * (28.0**2 + 12.0**2) / 2 + sum(pin * square for pin, square in zip(pins, apart, strict=True))
    assert moments(SOLIDS["carrier"]()) == pytest.approx((plates + sum(pins), polar), rel=EXACT)


_CODE = """
import json, sys
from gearcad import Body, Gear
from gearcad.solids.exact.inertia import mass_properties
mass_properties(Gear(teeth=20, normal_module=2, face_width=6, body=Body(bore=5)), 7850.0)
print(json.dumps([name for name in ("OCP", "cadquery", "scipy") if name in sys.modules]))
"""


def test_mass_and_inertia_need_no_cad_kernel() -> None:
    done = subprocess.run([sys.executable, "-c", _CODE], check=True, capture_output=True, text=True)
    assert json.loads(done.stdout) == []
