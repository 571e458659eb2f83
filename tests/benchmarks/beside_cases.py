"""What `beside.py` runs: commands from start to end, and series of which it tells how they grow. An entry of a table each."""

import random
from typing import NamedTuple

__all__ = ["CASES", "INPUTS", "SERIES", "Series"]

CASES: dict[str, str] = {
    "help": "gearcad --help",
    "version": "gearcad --version",
    "new": "gearcad new pair -o mine.toml",
    "data, gear": "gearcad data spur.toml",
    "data, pair": "gearcad data volvo-13-44.toml",
    "data, train": "gearcad data planetary-24-21-66.toml",
    "build, gear": "gearcad build spur.toml",
    "build, pair": "gearcad build volvo-13-44.toml",
    "build, ring": "gearcad build ring-22-70.toml",
    "build, rack": "gearcad build rack.toml",
    "build, train": "gearcad build planetary-24-21-66.toml",
    "build, z 300": "gearcad build z300.toml",
    "build, gear, STEP": "gearcad build spur.toml --format step",
    "build, gear, STL": "gearcad build spur.toml --format stl",
    "build, gear, 3MF": "gearcad build spur.toml --format 3mf",
    "build, gear, GLB": "gearcad build spur.toml --format glb",
    "build, gear, PNG": "gearcad build spur.toml --format png",
    "build, gear, DXF": "gearcad build spur.toml --format dxf",
    "build, gear, CSV": "gearcad build spur.toml --format csv",
    "build, train, turning GLB": "gearcad build planetary-24-21-66.toml --format glb --turning",
    "check, plane, Alm": "gearcad check alm-18-161.toml",
    "check, plane, FZG": "gearcad check fzg-c.toml",
    "check, plane, ring": "gearcad check ring-22-70.toml",
    "check, solid, Volvo": "gearcad check volvo-13-44.toml",
    "check, solid, 26 modules, base mesh": "gearcad check wide.toml",
    "rate, FZG": "gearcad rate fzg-c.toml",
    "rate, reducer": "gearcad rate reducer-21-43.toml",
    "draw, pair": "gearcad draw volvo-13-44.toml",
    "stiffness, FZG": "gearcad stiffness fzg-c.toml",
    "stiffness, FZG, closed forms": "gearcad stiffness fzg-c.toml --method potential-energy --method iso6336",
    "stiffness, Alm, all methods": "gearcad stiffness alm-18-161.toml",
    "dynamics, Alm": "gearcad dynamics alm-18-161.toml",
    "dynamics, 1 stage": "gearcad dynamics train-1-stage.toml",
    "dynamics, 2 stages": "gearcad dynamics train-2-stage.toml",
    "dynamics, Uhlir": "gearcad dynamics uhlir-19-23-simple.toml",
    "planetary": "gearcad planetary planetary-24-21-66.toml",
    "planetary, Alm": "gearcad planetary planetary-alm.toml",
    "batch, data, 1000 pairs": "gearcad batch thousand.csv --do data -j 1 --quiet",
    "batch, build, 20 pairs": "gearcad batch twenty.csv -j 1 --quiet",
    "import gearcad": "import gearcad",
}
"""Commands, each as one types it in a folder with INPUTS and all starters; what does not begin with gearcad is Python."""


class Series(NamedTuple):
    """`work` in Python, whose CPU time is measured for every one of `values`, which it calls `x`, after `prepare`.

    It runs as often as it takes to be measured, so it must not profit from having run before.
    """

    words: str
    values: tuple[float, ...]
    prepare: str
    work: str


_BUILD = """
import tempfile
from dataclasses import replace
import gearcad
from gearcad import Gear
spur = Gear(teeth=40, normal_module=2.0, face_width=20.0)
helical = replace(spur, helix_angle=20.0)
folder = tempfile.mkdtemp(dir=".")
def write(gear, kind, **options):
    gearcad.build(gear, folder, [kind], **options)
write(replace(spur, teeth=15), "step")
write(replace(spur, teeth=15), "stl")
"""

_CHECK = """
import gearcad
from gearcad import Gear, GearPair, Load
from gearcad.check import CheckOptions
def check(teeth=(18, 40), width=10.0, helix=0.0, **options):
    pinion, wheel = (
        Gear(teeth=z, normal_module=2.0, face_width=width, tooth_thinning=0.02, helix_angle=hand * helix)
        for z, hand in zip(teeth, (1, -1))
    )
    pair = GearPair(pinion=pinion, wheel=wheel)
    gearcad.check(pair, Load(torque=4.0 * width), check=CheckOptions(convergence="off", **options))
check(positions=12, refinement=0.5, body_teeth=3)
"""

_TEETH = (50, 100, 200, 300, 500)

SERIES: dict[str, Series] = {
    "data over z": Series("teeth", _TEETH, _BUILD, "gearcad.data(replace(helical, teeth=int(x)))"),
    "STL over z": Series("teeth", _TEETH, _BUILD, "write(replace(helical, teeth=int(x)), 'stl')"),
    "GLB over z": Series("teeth", _TEETH, _BUILD, "write(replace(helical, teeth=int(x)), 'glb')"),
    "STEP over z": Series("teeth", _TEETH, _BUILD, "write(replace(helical, teeth=int(x)), 'step')"),
    "STL over 1/tolerance": Series(
        "1/mm", (50, 100, 200, 500, 1000, 2000), _BUILD, "write(replace(helical), 'stl', chord_error=1 / x)"
    ),
    "plane check over z of the wheel": Series("teeth", _TEETH, _CHECK, "check((18, int(x)))"),
    "plane check over positions": Series("positions", (15, 30, 60, 120, 240), _CHECK, "check(positions=int(x))"),
    "plane check over refinement": Series("times as fine", (0.5, 0.7, 1.0, 1.4, 2.0), _CHECK, "check(refinement=x)"),
    "solid check over positions": Series("positions", (12, 24, 48), _CHECK, "check(helix=15.0, positions=int(x))"),
    "solid check over face width": Series(
        "modules", (4.0, 6.0, 9.0, 13.0, 18.0, 26.0), _CHECK, "check(width=2.0 * x, helix=15.0)"
    ),
}

_Z300 = """
[gear]
teeth = 300
normal_module = 2.0
face_width = 20.0
"""

_WIDE = """
[pair]
normal_module = 14.0
helix_angle = 15.0
face_width = 359.8
tooth_thinning = 0.1
[pinion]
teeth = 25
[wheel]
teeth = 95
[load]
torque = 60000.0
[check]
model = "3d"
convergence = "off"
"""


def _pairs(count: int) -> str:
    """A table of pairs, the same each time."""
    chance = random.Random(1)
    rows = ["name,normal_module,helix_angle,face_width,pinion.teeth,pinion.profile_shift,wheel.teeth"]
    for number in range(count):
        module, helix, teeth = chance.choice((1.5, 2.5, 4.0)), chance.choice((0, 10, 20)), chance.randint(20, 40)
        shift, mate = round(chance.uniform(0.0, 0.3), 2), teeth + chance.randint(0, 40)
        rows.append(f"v{number:04d},{module},{helix},20,{teeth},{shift},{mate}")
    return "\n".join(rows) + "\n"


INPUTS = {"z300.toml": _Z300, "wide.toml": _WIDE, "thousand.csv": _pairs(1000), "twenty.csv": _pairs(20)}
"""Files beside the starters."""
