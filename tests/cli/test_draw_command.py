"""`gearcad draw` and `gearcad picture`: sheets and images as files, with what the screen and documents say of them."""

import json
from pathlib import Path

import pytest
from click.testing import Result
from PIL import Image
from support.commands import invoke, read_json
from support.specs import TEMPLATES
from support.written_sheet import read_sheet

import gearcad
from gearcad import Gear, ParameterError
from gearcad.designs import read_spec
from gearcad.designs.reader import starter_text
from gearcad.jobs.draw import Draw

STARTERS = (
    *("volvo-13-44", "alm-18-161", "double-23-81", "fzg-c", "planetary-24-21-66", "planetary-alm", "planetary-differential"),
    *("rack", "reducer-21-43", "ring-22-70", "spur", "uhlir-19-23"),
)


def _spec(name: str, folder: Path) -> Path:
    file, text = starter_text(name)
    (folder / file).write_text(text, encoding="utf-8")
    return folder / file


def _draw(spec: Path, *options: str) -> Result:
    return invoke("draw", str(spec), "-o", str(spec.parent / "out"), *options)


def test_a_gear_is_drawn(tmp_path: Path) -> None:
    """Files, a line a sheet, and numbers that are those of the data sheet."""
    spec = _spec("spur", tmp_path)
    spec.write_text(
        spec.read_text(encoding="utf-8") + '\n[drawing]\nnumber = "GC-7"\nlanguage = "sv"\nsheet = "A2"\n', encoding="utf-8"
    )
    result = _draw(spec, "--language", "de", "--sheet", "a3")
    assert result.exit_code == 0, result.output
    names = ["drawing.dxf", "drawing.svg", "drawing.pdf", "draw.json"]
    lines = result.stdout.splitlines()
    assert lines[0].split()[:3] == ["gear", "A3", "2:1"]
    assert [Path(line).name for line in lines[-4:]] == names
    document = read_json(tmp_path / "out" / "draw.json")
    (of_gear,) = document["sheets"]
    assert (document["kind"], of_gear["number"], of_gear["size"], of_gear["files"]) == ("draw", "GC-7", "A3", names[:3])
    sheet = read_sheet(tmp_path / "out" / "drawing.dxf")
    assert sheet.faults == []
    assert {"GC-7", "A3", "Normalmodul"} <= set(sheet.words)
    assert read_spec(spec).gears["gear"].tip_diameter in of_gear["numbers"].values()


def test_wrong_options_are_told(tmp_path: Path) -> None:
    spec = _spec("spur", tmp_path)
    for options, told in (
        (("--scale", "1:3"), "Error: scale = '1:3': must be \"auto\" or a scale of ISO 5455"),
        (("--sheet", "B4"), "Error: sheet = 'B4': must be one of"),
        (("--language", "fi"), "Error: language = 'fi': must be one of 'en', 'de', 'sv'"),
        (("--format", "dwg"), "Error: format = 'dwg': must be one of 'dxf', 'svg', 'pdf'"),
        (("--sheet", "A4", "--scale", "5:1"), "Error: "),
    ):
        result = _draw(spec, *options)
        assert result.exit_code == 2 and result.stderr.startswith(told) and result.stderr.count("\n") == 1, result.stderr
    assert not (tmp_path / "out").exists()
    with pytest.raises(ParameterError, match="colour = 'red': is not an option of drawings"):
        Draw(given={"colour": "red"})
    with pytest.raises(ParameterError, match=r"formats = \[\]: must be a list of formats"):
        Draw(formats=[])  # type: ignore[arg-type]


def test_a_train_of_pairs_has_an_arrangement_and_a_folder_a_mesh(tmp_path: Path) -> None:
    """The numbers of the arrangement are those of the pairs and of the train; sheets of pairs are those of the pairs alone."""
    result = _draw(_spec("two-stage", tmp_path), "--format", "svg", "--language", "de")
    assert result.exit_code == 0, result.stderr
    document = read_json(tmp_path / "out" / "draw.json")
    (sheet,) = document["sheets"]
    assert sheet["name"] == "arrangement" and sheet["files"] == ["drawing.svg"]
    assert sheet["numbers"]["train.ratio"] == pytest.approx(61 / 20 * 84 / 25, rel=1e-12)
    assert sheet["numbers"]["meshes.stage 2.pair.centre_distance"] == pytest.approx(163.5, rel=1e-12)
    written = (tmp_path / "out" / "drawing.svg").read_text(encoding="utf-8")
    assert "163,500" in written and "Zähnezahlverhältnis" in written
    for mesh in ("stage 1", "stage 2"):
        own = read_json(tmp_path / "out" / mesh / "draw.json")
        assert own["sheets"] == document["meshes"][mesh]["sheets"]
        names = [f"drawing-{each['name']}.svg" for each in own["sheets"]]
        assert {"drawing-pinion.svg", "drawing-wheel.svg", "drawing-assembly.svg"} <= set(names)
        assert all((tmp_path / "out" / mesh / name).is_file() for name in names)


def test_a_train_without_pairs_is_told_all_that_can_be_drawn(tmp_path: Path) -> None:
    result = _draw(_spec("train-1-stage", tmp_path))
    assert result.exit_code == 2 and "must be a gear, a pair" in result.stderr and result.stderr.count("\n") == 1


def test_a_pair_has_a_sheet_for_each_gear_and_one_for_both(tmp_path: Path) -> None:
    job = Draw(formats=["dxf", "pdf"])  # type: ignore[arg-type]
    drawing = job.run(read_spec(_spec("fzg-c", tmp_path)))
    names = [file.name for file in job.write(drawing, tmp_path / "out")]
    parts = ("assembly", "pinion", "wheel")
    assert names == [*(f"drawing-{part}.{end}" for part in parts for end in ("dxf", "pdf")), "drawing.pdf", "draw.json"]
    assert (tmp_path / "out" / "drawing.pdf").read_bytes().count(b"/Type /Page\n") == 3
    assert read_sheet(tmp_path / "out" / "drawing-assembly.dxf").faults == []
    assert {job.part_of(name) for name in names} == {"draw"}


def test_a_train_has_a_sheet_for_each_gear_that_differs(tmp_path: Path) -> None:
    from gearcad.jobs.draw import drawn_gears

    assert [gear.role for gear in drawn_gears(read_spec(_spec("planetary-24-21-66", tmp_path)))] == ["sun", "ring", "planet"]
    found = {gear.role: gear for gear in drawn_gears(read_spec(_spec("planetary-alm", tmp_path)))}
    assert list(found) == ["ring_4", "ring_5", "rim_3", "rim_3p", "pinion_1", "gear_2"]
    assert [mate.name for mate in found["rim_3"].mates] == ["ring_4"]


@pytest.mark.long
def test_rows_of_tables_are_drawn(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("table.csv").write_text("name,teeth,normal_module,face_width,drawing.number\none,20,2,20,GC-9\n", encoding="utf-8")
    result = invoke("batch", "table.csv", "--do", "draw", "-j", "1")
    assert result.exit_code == 0, result.output
    folder = tmp_path / "output" / "table" / "one"
    assert {"drawing.dxf", "drawing.svg", "drawing.pdf", "draw.json"} <= {file.name for file in folder.iterdir()}
    assert "GC-9" in read_sheet(folder / "drawing.dxf").words


@pytest.mark.long
@pytest.mark.parametrize("language", ["en", "de", "sv"])
@pytest.mark.parametrize("name", STARTERS)
def test_nothing_overlaps_on_the_sheets_of_starters(name: str, language: str, tmp_path: Path) -> None:
    job = Draw(given={"language": language})
    drawing = job.run(read_spec(_spec(name, tmp_path)))
    files = job.write(drawing, tmp_path / "out")
    assert {file.name: read_sheet(file).faults for file in files if file.suffix == ".dxf" and read_sheet(file).faults} == {}


def test_python_draws_too() -> None:
    drawing = gearcad.draw(Gear(teeth=20, normal_module=2, face_width=20), language="de", scale="1:1")
    (sheet,) = drawing.sheets
    assert (sheet.name, sheet.scale) == ("gear", 1.0)


PAIR = str(TEMPLATES / "volvo-13-44.toml")
SMALL = ("--size", "64x48", "--quiet")


def run(*arguments: str) -> Result:
    return invoke("picture", *arguments)


def test_an_image_and_what_is_on_it_are_written(tmp_path: Path) -> None:
    result = run(PAIR, "--turning", "--view", "mesh", "--json", "-o", str(tmp_path), *SMALL)
    assert result.exit_code == 0, result.output
    document = json.loads(result.stdout)
    assert document == read_json(tmp_path / "picture.json")
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
