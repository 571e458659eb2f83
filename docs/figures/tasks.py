"""Figures of the tasks, of the specs that their pages show."""

from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from manual.blocks import blocks_of

import gearcad
from gearcad import FlankModification, picture, read
from gearcad.check.options import CheckOptions
from gearcad.plots import save_plot
from gearcad.plots.check import plot_root_stress
from gearcad.plots.paper import new_figure, prepared
from gearcad.plots.speeds import plot_factors

DOCS = Path(__file__).parents[1]
TEMPLATES = DOCS.parent / "templates"


def _design(page: str, file: str) -> object:
    """The design of a spec that a page shows."""
    (block,) = [block for block in blocks_of((DOCS / "tasks" / page).read_text(encoding="utf-8")) if block.file == file]
    with TemporaryDirectory() as folder:
        spec = Path(folder, file)
        spec.write_text(block.text, encoding="utf-8")
        return read(spec)


def draw_printed(path: Path) -> None:
    picture(_design("printed-planetary.md", "printed.toml"), path, explode=True, size=(900, 640))


def draw_root_stress(path: Path) -> None:
    design = read(TEMPLATES / "fzg-c.toml")
    save_plot(plot_root_stress, gearcad.check(design, check=CheckOptions(model="2d", convergence="off")), path)


def draw_quiet(path: Path) -> None:
    """Transmission error before and after the modification that the page shows."""
    design = read(TEMPLATES / "fzg-c.toml")
    relief = ((41.0, 6.9), (42.0, 5.55))
    pinion, wheel = (
        replace(gear, modification=FlankModification(tip_relief=depth, tip_relief_length=length, tip_relief_shape="parabolic"))
        for gear, (depth, length) in zip(design.pair.gears, relief, strict=True)
    )
    figure = new_figure()
    axes = prepared(figure.add_subplot(), "roll angle of the pinion in °, 0 at C", "transmission error less its mean, in µm")
    for words, pair in (("before", design.pair), ("after", replace(design.pair, pinion=pinion, wheel=wheel))):
        result = gearcad.check(pair, design.load, check=CheckOptions(model="2d", convergence="off"))
        error = result.cycle.course("transmission_error")
        axes.plot(result.cycle.course("roll_angle"), error - error.mean(), label=f"{words}: {error.max() - error.min():.1f} µm")
    axes.legend(frameon=False)
    figure.savefig(path)


def draw_resonances(path: Path) -> None:
    save_plot(plot_factors, gearcad.dynamics(read(TEMPLATES / "train-pairs.toml")), path)


def draw_two_stage(path: Path) -> None:
    picture(read(TEMPLATES / "two-stage.toml"), path, size=(900, 640))


FIGURES = {
    "printed-planetary.png": draw_printed,
    "root-stress.png": draw_root_stress,
    "quiet-pair.png": draw_quiet,
    "resonances.png": draw_resonances,
    "two-stage.png": draw_two_stage,
}
