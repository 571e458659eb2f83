"""Designs of the gallery: a picture, the spec and the STEP file of each.

A design is one of the starters, or the text of a spec. `python docs/figures/gallery.py FOLDER` writes all specs into a folder,
for `gearcad verify`, and the page gallery.md.
"""

import shutil
import sys
import tempfile
from functools import partial
from pathlib import Path

from gearcad import build, picture, read
from gearcad.designs.reader import starter_text

SIZE = (400, 300)

STARTERS = {
    "reducer-21-43": "Spur pair of a small reducer, with profile shift, tip relief and keyways",
    "volvo-13-44": "Helical pair, z = 13 / 44 at 28°",
    "fzg-c": "Test pair FZG C",
    "double-23-81": "Double helical pair",
    "ground-25-41": "Pair cut with a protuberance, hardened and ground",
    "alm-18-161": "Spur pair with a ratio of 8.9",
    "ring-22-70": "Pinion in a ring that a shaper cutter makes",
    "rack": "Helical pinion and rack",
    "planetary-24-21-66": "Planetary set: sun, three planets, ring",
    "planetary-alm": "Planetary train with stepped planets between two rings",
    "planetary-differential": "Helical differential with four planets",
    "printed-planetary": "Planetary set that is printed assembled",
    "two-stage": "Two-stage reducer on three shafts",
    "wire-cut": "Gear that is cut by a wire",
    "spur": "Spur gear with keyway and chamfers",
}

_GEAR = "[gear]\nteeth = {}\nnormal_module = {}\nface_width = {}\n"
_PAIR = "[pair]\nnormal_module = {}\nface_width = {}\n"

OWN = {
    "helical-35": (
        "Helical gear at 35° with crowned flanks",
        _GEAR.format(27, 3.0, 40.0) + "helix_angle = 35.0\nbody.bore = 30.0\nmodification.lead_crowning = 12.0\n",
    ),
    "undercut-8": (
        "Pinion of 8 teeth, cut so deep that its roots are undercut",
        _GEAR.format(8, 4.0, 20.0) + "profile_shift = 0.2\nbody.bore = 6.0\n",
    ),
    "shifted-9": (
        "Pinion of 9 teeth, shifted until nothing is undercut",
        _GEAR.format(9, 4.0, 20.0) + "profile_shift = 0.5\ntip_alteration = -0.1\nbody.bore = 8.0\n",
    ),
    "hub": (
        "Gear with hubs on both sides and a keyway",
        _GEAR.format(32, 2.5, 16.0)
        + 'body.bore = 20.0\nbody.keyway = true\nbody.hub_diameter = 36.0\nbody.hub_length = 12.0\nbody.hub_side = "both"\n',
    ),
    "chamfered": (
        "Gear with chamfers at its ends and along its tips",
        _GEAR.format(24, 5.0, 30.0) + "helix_angle = -18.0\nbody.bore = 40.0\nbody.end_chamfer = 1.5\nbody.tip_chamfer = 0.3\n",
    ),
    "bolted-ring": (
        "Ring with twelve bolt holes",
        _GEAR.format(-72, 2.0, 18.0)
        + "cutter.teeth = 25\nbody.rim_diameter = 190.0\n"
        + "body.bolt_circle = 172.0\nbody.bolt_holes = 12\nbody.bolt_diameter = 6.6\n",
    ),
    "helical-ring": (
        "Helical ring",
        _GEAR.format(-63, 3.0, 45.0) + "helix_angle = 20.0\ncutter.teeth = 30\nbody.rim_diameter = 240.0\n",
    ),
    "fine-pitch": (
        "Fine pitch: module 0.3, 120 teeth",
        _GEAR.format(120, 0.3, 3.0) + "tooth_thinning = 0.01\nbody.bore = 5.0\n",
    ),
    "large-module": (
        "Large module: 16 mm, 22 teeth",
        _GEAR.format(22, 16.0, 160.0) + "helix_angle = 10.0\nbody.bore = 120.0\nbody.keyway = true\n",
    ),
    "diametral-pitch": (
        "Diametral pitch 10, pressure angle 14.5°",
        "[gear]\nteeth = 40\nnormal_diametral_pitch = 10.0\nface_width = 12.7\nbody.bore = 19.05\n"
        "rack.pressure_angle = 14.5\nrack.addendum = 1.0\nrack.dedendum = 1.157\nrack.root_radius = 0.2\n",
    ),
    "tall-teeth": (
        "Pair with tall teeth: a transverse contact ratio above 2",
        _PAIR.format(2.0, 20.0)
        + "tooth_thinning = 0.03\nrack.addendum = 1.25\nrack.dedendum = 1.5\nrack.root_radius = 0.3\n\n"
        + "[pinion]\nteeth = 37\nbody.bore = 25.0\n\n[wheel]\nteeth = 61\nbody.bore = 40.0\n",
    ),
    "pump-10-10": (
        "Two gears of a pump, z = 10 / 10, with little clearance",
        _PAIR.format(4.0, 30.0)
        + "centre_distance = 43.0\ntooth_thinning = 0.03\nrack.dedendum = 1.2\nrack.root_radius = 0.3\n\n"
        + '[pinion]\nteeth = 10\nprofile_shift = "auto"\nbody.bore = 14.0\n\n'
        + '[wheel]\nteeth = 10\nprofile_shift = "auto"\nbody.bore = 14.0\n',
    ),
    "crowned-pair": (
        "Helical pair with tip relief and crowned flanks",
        _PAIR.format(3.0, 32.0)
        + "helix_angle = 16.0\ntooth_thinning = 0.06\nmodification.tip_relief = 25.0\nmodification.tip_relief_length = 1.5\n"
        + "modification.lead_crowning = 10.0\n\n"
        + "[pinion]\nteeth = 23\nbody.bore = 25.0\n\n[wheel]\nteeth = 57\nbody.bore = 50.0\n",
    ),
    "full-radius": (
        "Gear with full root radii",
        _GEAR.format(30, 3.0, 24.0) + 'rack.dedendum = 1.3\nrack.root_radius = "full"\nbody.bore = 25.0\n',
    ),
    "rack-alone": (
        "Helical rack of twenty pitches",
        "[rack]\nteeth = 20\nnormal_module = 3.0\nface_width = 30.0\nheight = 26.0\n"
        "helix_angle = 19.52808\ntip_chamfer = 0.2\n",
    ),
}


def words_of(name: str) -> str:
    """Return the words about a design."""
    return STARTERS[name] if name in STARTERS else OWN[name][0]


def spec_of(name: str) -> str:
    """Return the spec of a design."""
    if name in STARTERS:
        return starter_text(name)[1]
    return f"# {words_of(name)}.\n{OWN[name][1]}"


NAMES = (*STARTERS, *OWN)


def write_specs(folder: Path) -> list[Path]:
    """Write the specs of all designs, and return their paths."""
    folder.mkdir(parents=True, exist_ok=True)
    files = [folder / f"{name}.toml" for name in NAMES]
    for file, name in zip(files, NAMES, strict=True):
        file.write_text(spec_of(name), encoding="utf-8")
    return files


def write_spec(name: str, path: Path) -> None:
    """Write the spec of a design."""
    path.write_text(spec_of(name), encoding="utf-8")


def draw(name: str, path: Path) -> None:
    """Write the picture of a design."""
    with tempfile.TemporaryDirectory() as folder:
        spec = Path(folder) / f"{name}.toml"
        write_spec(name, spec)
        picture(read(spec), path, size=SIZE)


def write_step(name: str, path: Path) -> None:
    """Write the STEP file of a design: that of its assembly, or of its only part."""
    with tempfile.TemporaryDirectory() as folder:
        spec = Path(folder) / f"{name}.toml"
        write_spec(name, spec)
        steps = {file.stem: file for file in build(read(spec), Path(folder) / "built", ["step"]) if file.suffix == ".step"}
        shutil.copyfile(steps.get("assembly") or next(iter(steps.values())), path)


FIGURES = {
    f"gallery-{name}.{kind}": partial(write, name)
    for name in NAMES
    for kind, write in (("png", draw), ("toml", write_spec), ("step", write_step))
}

COLUMNS = 3

HEAD = """# Gallery

Thirty designs, each with its spec and its STEP file. Pictures and STEP files are made from the specs when this manual is built.
Every design passed `gearcad verify` at level `files` on {measured}: solids, facets, outlines and sizes, each judged by another
program.
To make all files of one of them, take its spec and run `gearcad build SPEC`.

"""
MEASURED = "28 November 2026"
"""Day on which `gearcad verify` passed for all designs."""


def page() -> str:
    """Return the text of the page gallery.md: a table of pictures, with words and links below each."""
    rows = [NAMES[start : start + COLUMNS] for start in range(0, len(NAMES), COLUMNS)]
    lines = [f"|{' |' * COLUMNS}", f"|{'---|' * COLUMNS}"]
    for row in rows:
        lines.append("".join(f"| ![{words_of(name)}](/figures/made/gallery-{name}.png) " for name in row) + "|")
        lines.append("".join(f"| {words_of(name)}: {_links(name)} " for name in row) + "|")
    return HEAD.format(measured=MEASURED) + "\n".join(lines) + "\n"


def _links(name: str) -> str:
    return ", ".join(
        f"{{download}}`{words} </figures/made/gallery-{name}.{kind}>`" for words, kind in (("spec", "toml"), ("STEP", "step"))
    )


if __name__ == "__main__":
    write_specs(Path(sys.argv[1]))
    Path(__file__).parents[1].joinpath("gallery.md").write_text(page(), encoding="utf-8")
