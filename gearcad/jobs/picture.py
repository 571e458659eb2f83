"""Picture: what a design looks like, as an image that may turn."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum
from functools import partial
from pathlib import Path
from typing import Any

from gearcad.designs import DesignKind, PlanetaryDesign, RackDesign, ToothedDesign
from gearcad.errors import GeometryError, ParameterError, as_choice, as_path, require_switch, require_whole
from gearcad.jobs.job import Job, Writer
from gearcad.jobs.products import products_of, require_bodies
from gearcad.jobs.subject import Subject, as_design
from gearcad.notice import Notice
from gearcad.output import staged_files
from gearcad.progress import Progress
from gearcad.solids import FileOptions
from gearcad.solids.files.pictures.cutaway import Cutaway
from gearcad.solids.files.pictures.images import Animation
from gearcad.solids.files.pictures.shot import Shot, loop_of
from gearcad.solids.files.pictures.views import View
from gearcad.version import __version__

__all__ = ["Background", "Picture", "Pictured", "picture"]

STILL_SIZE, TURNING_SIZE = (1600, 1200), (800, 600)
"""Width and height in pixels where none are given."""

_LEAST, _MOST = 16, 8000
"""Pixels of width and height."""

_MOST_PIXELS, _MOST_IN_ALL = 16_000_000, 250_000_000
"""Of a picture, which takes some 60 bytes each, and of all frames, which are held until the file is written."""

_FINE = 0.001
"""Largest error of the facets in normal modules: less than a pixel where a mesh fills the picture."""


class Background(Enum):
    """What a picture has where nothing is."""

    WHITE = "white"
    TRANSPARENT = "transparent"


@dataclass(frozen=True)
class Pictured:
    """A design, and how it is photographed."""

    design: ToothedDesign
    shot: Shot


@dataclass(frozen=True, kw_only=True)
class Picture(Job[ToothedDesign, Pictured]):
    """`picture.png` of a design, or `picture.gif` and so on of one that turns, and picture.json, which says what is on it.

    Raises ParameterError for a size that no picture can have.
    """

    verb = "picture"
    accepts = (DesignKind.GEAR, DesignKind.PAIR, DesignKind.RACK, DesignKind.RACK_PAIR, DesignKind.PLANETARY)
    why = "there are no teeth"
    solves = False
    writes_long = True

    view: View = View.CORNER
    size: tuple[int, int] | None = None
    cutaway: Cutaway | None = None
    explode: bool = False
    turning: Animation | None = None
    background: Background = Background.WHITE

    def __post_init__(self) -> None:
        require_switch("explode", self.explode)
        if self.size is not None:
            if not isinstance(self.size, tuple | list) or len(self.size) != 2:
                raise ParameterError("size", self.size, "must be width and height in pixels, such as (800, 600)")
            for name, value in zip(("width", "height"), self.size, strict=True):
                require_whole(f"size.{name}", value, at_least=_LEAST, at_most=_MOST)
            self._require_memory(1)

    def _run(self, design: ToothedDesign, _progress: Progress | None) -> Pictured:
        self._require_parts(design)
        module = min(each.normal_module for each in _toothed(design))
        options = FileOptions(chord_error=_FINE * module, exploded=self.explode and isinstance(design, PlanetaryDesign))
        require_bodies(design, options)
        parts, assembly = products_of(design, options)
        product = assembly or next(iter(parts.values()))
        loop = loop_of(product, self.view) if self.turning else None
        self._require_memory(loop.frames if loop else 1)
        shot = Shot(
            product=product,
            view=self.view,
            size=self.pixels,
            cutaway=self.cutaway,
            exploded=self.explode,
            transparent=self.background is Background.TRANSPARENT,
            loop=loop,
        )
        return Pictured(design, shot)

    @property
    def pixels(self) -> tuple[int, int]:
        """Width and height."""
        return self.size or (TURNING_SIZE if self.turning else STILL_SIZE)

    @property
    def file(self) -> str:
        """The name of the image."""
        return f"picture.{self.turning.value if self.turning else 'png'}"

    def _require_parts(self, design: ToothedDesign) -> None:
        """Raise GeometryError for what a single part cannot show."""
        if design.assembly is not None or isinstance(design, PlanetaryDesign):
            return
        if self.explode:
            raise GeometryError("explode", True, "needs a pair or a train: there is only one part")
        if self.view is View.MESH:
            raise GeometryError("view", self.view, "needs a pair or a train: one part has no mesh")

    def _require_memory(self, frames: int) -> None:
        width, height = self.pixels
        most, words = (_MOST_IN_ALL, f" in all {frames} frames") if frames > 1 else (_MOST_PIXELS, "")
        if width * height * frames > most:
            raise ParameterError("size", f"{width}x{height}", f"must be at most {most / 1e6:.0f} million pixels{words}")

    def document(self, result: Pictured) -> dict[str, Any]:
        """What picture.json holds."""
        loop = result.shot.loop
        turning = loop and {
            "frames": loop.frames,
            "seconds": loop.seconds,
            "pitches": float(loop.pitches),
            "closes": loop.closes,
            "turns": loop.turns,
        }
        return {
            "kind": self.verb,
            "name": result.design.name,
            "gearcad": __version__,
            "file": self.file,
            "view": self.view.value,
            "size": list(self.pixels),
            "background": self.background.value,
            "cutaway": self.cutaway and self.cutaway.value,
            "exploded": self.explode,
            "turning": turning,
            "notices": [notice.to_dict() for notice in self.notices(result)],
        }

    def notices(self, result: Pictured) -> Sequence[Notice]:
        return result.shot.loop.notices if result.shot.loop else ()

    def files(self, result: Pictured) -> dict[str, Writer]:
        """The image and the document."""
        return {self.file: self.writer(result), "picture.json": partial(self.write_document, result)}

    def writer(self, result: Pictured) -> Writer:
        """What writes the image."""
        return partial(result.shot.write_animation, self.turning) if self.turning else result.shot.write_png

    def write_image(self, result: Pictured, path: Path) -> None:
        """Write the image alone. Raises ParameterError for a suffix of another format, OutputError."""
        suffixes = {".png", ".apng"} if self.turning is Animation.APNG else {Path(self.file).suffix}
        if path.suffix.lower() not in suffixes:
            raise ParameterError("output", str(path), f"must end in {' or '.join(sorted(suffixes))}")
        with staged_files(path.parent) as staging:
            self.writer(result)(staging / path.name)

    def part_of(self, file: str) -> str:
        """Image and document."""
        return self.verb if file in (self.file, "picture.json") else ""


def _toothed(design: ToothedDesign) -> list[Any]:
    """Gears and racks of a design."""
    racks = [design.rack] if isinstance(design, RackDesign) else []
    return [*design.gears.values(), *racks]


def picture(
    subject: Subject,
    file: Path | str,
    *,
    view: View | str = View.CORNER,
    size: tuple[int, int] | None = None,
    cutaway: Cutaway | str | None = None,
    explode: bool = False,
    turning: Animation | str | None = None,
    background: Background | str = Background.WHITE,
) -> Path:
    """Write a picture of a gear, rack, pair or train as PNG, or turning as "gif", "apng" or "webp", and return its path.

    `view` is "corner", "front" (along the axes), "side" (from the right), "top" or "mesh" (close by, where teeth mesh).
    `size` is width and height in pixels. `cutaway` takes off a "quarter" or "half" of each part, `explode` moves parts apart.
    A picture that turns is a loop of whole tooth pitches, after which all looks as at first. `background`: "white" or
    "transparent". Raises ParameterError, GeometryError, OutputError where there is no OpenGL.
    """
    job = Picture(
        view=as_choice("view", view, View),
        size=size,
        cutaway=None if cutaway is None else as_choice("cutaway", cutaway, Cutaway),
        explode=explode,
        turning=None if turning is None else as_choice("turning", turning, Animation),
        background=as_choice("background", background, Background),
    )
    path = as_path("file", file)
    job.write_image(job.run(as_design(subject)), path)
    return path
