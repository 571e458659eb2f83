"""Images of pixels: PNG, and those that move - APNG, GIF, WebP. Equal pixels give equal bytes."""

from __future__ import annotations

from collections.abc import Iterable
from enum import Enum
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from gearcad.solids.files.pictures.studio import Pixels

if TYPE_CHECKING:
    from PIL.Image import Image

__all__ = ["Animation", "write_animation", "write_png"]


class Animation(Enum):
    """What images that move are written as; the value is the suffix of the file."""

    GIF = "gif"
    APNG = "apng"
    WEBP = "webp"


_COLOURS = 255
"""Of a GIF; one more is for what is transparent."""

_SAMPLES = 6
"""Frames from which a GIF takes its colours."""

_QUALITY = 90
"""Of WebP, which blurs a little."""


def write_png(pixels: Pixels, path: Path) -> None:
    """Write pixels, without opacity where all of them are opaque."""
    _image(pixels).save(path, "PNG")


def write_animation(frames: Iterable[Pixels], path: Path, kind: Animation, milliseconds: int) -> None:
    """Write frames that follow each other for ever, each for so long; a GIF is either opaque or not at a pixel."""
    images = list(map(_image, frames))
    first, *others = _of_few_colours(images) if kind is Animation.GIF else images
    shared = {"save_all": True, "append_images": others, "duration": milliseconds, "loop": 0}
    if kind is Animation.GIF:
        clear = {"transparency": _COLOURS, "disposal": 2} if "transparency" in first.info else {}
        first.save(path, "GIF", optimize=False, **shared, **clear)
    elif kind is Animation.APNG:
        first.save(path, "PNG", **shared)
    else:
        first.save(path, "WEBP", quality=_QUALITY, method=4, **shared)


def _image(pixels: Pixels) -> Image:
    from PIL import Image

    opaque = bool((pixels[..., 3] == 255).all())
    return Image.fromarray(np.ascontiguousarray(pixels[..., :3] if opaque else pixels))


def _of_few_colours(images: list[Image]) -> list[Image]:
    """The images in the colours that some of them have most; what is more clear than not is transparent."""
    from PIL import Image

    step = max(1, len(images) // _SAMPLES)
    some = [np.asarray(image.convert("RGB")) for image in images[::step]]
    palette = Image.fromarray(np.concatenate(some)).quantize(_COLOURS, Image.Quantize.MEDIANCUT)
    return [_in_colours(image, palette) for image in images]


def _in_colours(image: Image, palette: Image) -> Image:
    """An image in the colours of another one, with one more that is clear."""
    from PIL import Image

    found = image.convert("RGB").quantize(palette=palette, dither=Image.Dither.NONE)
    if image.mode != "RGBA":
        return found
    numbers = np.asarray(found).copy()
    numbers[np.asarray(image)[..., 3] < 128] = _COLOURS
    clear = Image.fromarray(numbers)
    clear.putpalette(found.getpalette() or [])
    clear.info["transparency"] = _COLOURS
    return clear
