"""`gearcad picture`: an image, or an image with the document that says what is on it, or one line."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result
from PIL import Image

import gearcad
from gearcad import ParameterError
from gearcad.cli import main

TEMPLATES = Path(__file__).parents[2] / "templates"
PAIR = str(TEMPLATES / "volvo-13-44.toml")
SMALL = ("--size", "64x48", "--quiet")


def run(*arguments: str) -> Result:
    return CliRunner().invoke(main, ["picture", *arguments], prog_name="gearcad")


def test_an_image_and_what_is_on_it_are_written(tmp_path: Path) -> None:
    result = run(PAIR, "--turning", "--view", "mesh", "--json", "-o", str(tmp_path), *SMALL)
    assert result.exit_code == 0, result.output
    document = json.loads(result.stdout)
    assert document == json.loads((tmp_path / "picture.json").read_text())
    assert (document["file"], document["view"], document["size"]) == ("picture.gif", "mesh", [64, 48])
    turning = document["turning"]
    assert (turning["frames"], turning["pitches"], turning["closes"]) == (24, 1.0, True)
    assert turning["turns"] == pytest.approx({"volvo-13-44 pinion": 1 / 13, "volvo-13-44 wheel": -1 / 44})
    with Image.open(tmp_path / "picture.gif") as image:
        assert (image.size, image.n_frames) == ((64, 48), 24)  # type: ignore[attr-defined]


def test_the_name_of_an_image_writes_that_alone_the_same_from_python(tmp_path: Path) -> None:
    path = tmp_path / "new" / "pair.png"
    result = run(PAIR, "-o", str(path), "--background", "transparent", "--cutaway", "quarter", *SMALL)
    assert (result.exit_code, result.stdout, result.stderr) == (0, f"{path}\n", "")
    assert [file.name for file in path.parent.iterdir()] == ["pair.png"]
    with Image.open(path) as image:
        assert (image.size, image.mode, image.getpixel((0, 0))) == ((64, 48), "RGBA", (0, 0, 0, 0))
    design = gearcad.read(PAIR)
    other = gearcad.picture(design, tmp_path / "b.png", size=(64, 48), background="transparent", cutaway="quarter")
    assert other.read_bytes() == path.read_bytes()


@pytest.mark.parametrize(
    ("arguments", "line"),
    [
        ((PAIR, "--view", "below"), "view = 'below': must be one of 'corner', 'front', 'side', 'top', 'mesh'"),
        ((PAIR, "--size", "1600"), "size = '1600': must be width and height in pixels, such as 1600x1200"),
        ((PAIR, "--size", "9x9"), "size.width = 9: must be a whole number from 16 to 8000"),
        ((PAIR, "--size", "8000x8000"), "size = '8000x8000': must be at most 16 million pixels"),
        ((PAIR, "--turning", "gif", "--size", "4000x4000"), "size = '4000x4000': must be at most 250 million pixels in all 24"),
        ((PAIR, "--turning", "avi"), "turning = 'avi': must be one of 'gif', 'apng', 'webp'"),
        ((PAIR, "--turning", "gif", "-o", "x.png"), "output = 'x.png': must end in .gif"),
        ((PAIR, "-o", "x.jpg"), "output = 'x.jpg': must end in .png, .gif, .apng or .webp, or be a folder"),
        ((str(TEMPLATES / "spur.toml"), "--view", "mesh"), "view = 'mesh': needs a pair or a train"),
        ((str(TEMPLATES / "spur.toml"), "--explode"), "explode = True: needs a pair or a train"),
        ((str(TEMPLATES / "train-1-stage.toml"),), "kind = 'train': must be a gear, a pair, a rack"),
    ],
)
def test_what_cannot_be_shown_is_refused_in_one_line(arguments: tuple[str, ...], line: str) -> None:
    result = run(*arguments)
    assert result.exit_code == 2
    assert result.stderr.startswith("Error: ") and line in result.stderr and result.stderr.count("\n") == 1


def test_a_ring_without_a_rim_and_a_rack_by_itself_say_why(tmp_path: Path) -> None:
    with pytest.raises(gearcad.GeometryError, match=r"gear\.body\.rim_diameter"):
        gearcad.picture(gearcad.Gear(teeth=-60, normal_module=2, face_width=10), tmp_path / "a.png")
    rack = gearcad.Rack(teeth=10, normal_module=2, face_width=10, height=8)
    with pytest.raises(gearcad.GeometryError, match="a rack by itself does not"):
        gearcad.picture(rack, tmp_path / "a.gif", turning="gif")
    with pytest.raises(ParameterError, match=r"output.*must end in \.png"):
        gearcad.picture(rack, tmp_path / "a.jpg")
    assert not list(tmp_path.iterdir())
