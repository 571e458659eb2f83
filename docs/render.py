"""Makes the pictures of the README, by what its own commands do: `python docs/render.py`."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from PIL import Image

import gearcad
from gearcad import Body, Gear, Load, Material, picture
from gearcad.batch import run_table
from gearcad.batch.study import plan_study, write_study
from gearcad.core.records import PerGear
from gearcad.designs import read_spec
from gearcad.jobs.draw import Draw
from gearcad.jobs.job import Data
from gearcad.planetary.train_data import speeds
from gearcad.plots import plot_contours, save_plot
from gearcad.plots.gears import plot_body_mesh, plot_section_mesh
from gearcad.plots.planetary import plot_front
from gearcad.plots.planetary_scheme import plot_scheme
from gearcad.plots.ratings import save_front
from gearcad.plots.table_data import read_points
from gearcad.rating import RatingOptions
from gearcad.sizing import SizeTask, search_pairs

FOLDER = Path(__file__).parent
SPEC = FOLDER.parent / "templates" / "volvo-13-44.toml"
"""What `gearcad new volvo` writes."""

_PATIENCE = 60_000
"""Milliseconds."""

FZG_C = SPEC.with_name("fzg-c.toml")


def plot_study(path: Path) -> None:
    """The study of the README."""
    varied = ["wheel.profile_shift=auto", "pinion.profile_shift=-0.2:0.6:33", "helix_angle=20:30:21"]
    with TemporaryDirectory() as folder:
        table, target = Path(folder, "study.csv"), Path(folder, "study")
        write_study(plan_study(SPEC, varied), table)
        run_table(table, target, [Data()])
        points = read_points(target / "results.csv", "pinion.profile_shift", "helix_angle", contour="usable_contact_ratio")
        save_plot(plot_contours, points, path)


def plot_elements(path: Path) -> None:
    """A section of a pair where it touches, teeth of hexahedra, and a whole part of tetrahedra."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(14, 4.8), layout="constrained")
    left, middle, right = figure.subplots(1, 3)
    spur, helical = read_spec(FZG_C), read_spec(SPEC)
    pitch_point = spur.pair.working_pitch_diameters.pinion / 2
    plot_section_mesh(gearcad.mesh(spur).mesh, left, window=(pitch_point, 0, 6.5))
    plot_body_mesh(gearcad.mesh(helical, what="teeth:3", gear="pinion").mesh, middle, yaw=105, pitch=30)
    body = Body(bore=18, keyway_width=6, keyway_depth=2.8, hub_diameter=32, hub_length=8, end_chamfer=1)
    gear = Gear(teeth=24, normal_module=2.5, face_width=16, helix_angle=20, body=body)
    plot_body_mesh(gearcad.mesh(gear, what="part", size=1.6).mesh, right, yaw=20, pitch=35)
    figure.savefig(path, dpi=110)
    Image.open(path).convert("RGB").quantize(48).save(path, optimize=True)


def picture_kinds(path: Path) -> None:
    """A pinion in its ring, one on a rack, and double helical gears: the starters, side by side."""
    with TemporaryDirectory() as folder:
        taken = []
        for name in ("ring-22-70", "rack", "double-23-81"):
            picture(read_spec(SPEC.with_name(f"{name}.toml")), Path(folder, f"{name}.png"), size=(640, 560))
            taken.append(np.array(Image.open(Path(folder, f"{name}.png"))))
    Image.fromarray(np.hstack(taken)).quantize(128).save(path, optimize=True)


def plot_train(path: Path) -> None:
    """The train of the Alm thesis: its scheme, and both rings with the planets in mesh."""
    from matplotlib.figure import Figure

    train = read_spec(SPEC.with_name("planetary-alm.toml")).train
    figure = Figure(figsize=(14, 4.5), layout="constrained")
    left, right = figure.subfigures(1, 2, width_ratios=(1, 1.35))
    plot_scheme(train, left.subplots())
    turning = speeds(train, {train.input: 1.0})
    plot_front(train, train.pose(), {**turning.members, "planet": turning.planet}, right)
    figure.savefig(path, dpi=110)
    Image.open(path).convert("RGB").quantize(64).save(path, optimize=True)


def plot_sizes(path: Path) -> None:
    """The pairs of the task in the README."""
    materials = PerGear(Material(name="Eh MQ"), Material(name="Eh MQ"))
    task = SizeTask(load=Load(torque=302, speed=1500), ratio=1.5, materials=materials, rating=RatingOptions(life=20000))
    save_front(search_pairs(task, errors=0), path)
    Image.open(path).convert("RGB").quantize(32).save(path, optimize=True)


def draw_sheet(path: Path) -> None:
    """The sheet of the wheel of the pair."""
    with TemporaryDirectory() as folder:
        job = Draw(formats=("svg",))
        job.write(job.run(read_spec(SPEC)), folder)
        path.write_bytes(Path(folder, "drawing-wheel.svg").read_bytes())


def show_page(path: Path) -> None:
    """The page of `gearcad open`, as Chromium shows it on a small screen."""
    from playwright.sync_api import sync_playwright

    server = subprocess.Popen(
        [sys.executable, "-m", "gearcad", "open", str(SPEC), "--no-browser"], stdout=subprocess.PIPE, text=True
    )
    assert server.stdout is not None  # Popen was asked for a pipe
    address = server.stdout.readline().strip()
    try:
        with sync_playwright() as playwright:
            options = ["--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
            browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=options)
            page = browser.new_page(viewport={"width": 1280, "height": 800}, color_scheme="light", locale="en-GB")
            page.goto(address)
            page.wait_for_function("() => document.querySelector('.scene')?.dataset.geometries > 0", timeout=_PATIENCE)
            page.get_by_text("strength passed").or_(page.get_by_text("strength not judged")).first.wait_for()
            page.wait_for_timeout(1000)  # until what has come is drawn
            page.screenshot(path=path, timeout=_PATIENCE)
            browser.close()
    finally:
        server.terminate()
        server.wait()
    Image.open(path).convert("RGB").quantize(256, method=Image.Quantize.MAXCOVERAGE).save(path, optimize=True)


def main() -> None:
    picture(read_spec(SPEC.with_name("reducer-21-43.toml")), FOLDER / "pair.png", size=(1400, 700))
    picture(read_spec(SPEC), FOLDER / "mesh.png", view="mesh", size=(1400, 700))
    draw_sheet(FOLDER / "sheet.svg")
    plot_study(FOLDER / "study.png")
    plot_elements(FOLDER / "elements.png")
    picture_kinds(FOLDER / "kinds.png")
    plot_train(FOLDER / "train.png")
    plot_sizes(FOLDER / "size.png")
    show_page(FOLDER / "page.png")


if __name__ == "__main__":
    main()
