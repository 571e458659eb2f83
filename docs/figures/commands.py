"""Figures of the pages of commands."""

from pathlib import Path
from tempfile import TemporaryDirectory

from gearcad import picture, read
from gearcad.jobs.build import Build
from gearcad.jobs.draw import Draw
from gearcad.solids import Format

STARTERS = Path(__file__).parents[2] / "templates"


def show_build(path: Path) -> None:
    with TemporaryDirectory() as folder:
        Build(formats=(Format.PNG,)).write(read(STARTERS / "volvo-13-44.toml"), Path(folder))
        path.write_bytes(Path(folder, "assembly.png").read_bytes())


def show_sheet(path: Path) -> None:
    with TemporaryDirectory() as folder:
        job = Draw()
        job.write(job.run(read(STARTERS / "spur.toml")), Path(folder))
        path.write_bytes(Path(folder, "drawing.svg").read_bytes())


def show_set(path: Path) -> None:
    picture(read(STARTERS / "planetary-24-21-66.toml"), path, size=(900, 700))


FIGURES = {"build.png": show_build, "draw.svg": show_sheet, "picture.png": show_set}
