"""Commands `export` and `import`: files, lines, and one clear line for each file that cannot be read."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from gearcad.cli import main
from gearcad.designs import read_spec

OWN = Path("output/reducer-21-43/reducer-21-43.rexs")


def run(*arguments: str, status: int = 0) -> Result:
    result = CliRunner().invoke(main, arguments)
    assert result.exit_code == status, result.output
    return result


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    run("new", "reducer")


def test_a_pair_goes_there_and_back() -> None:
    there = run("export", "reducer-21-43.toml")
    assert there.stdout == f"{OWN}\n"
    assert "material.group: REXS has no attribute for it; kept as custom_gearcad_group, for gearcad alone\n" in there.stderr
    assert OWN.read_bytes().startswith(b"\xef\xbb\xbf<?xml")
    back = run("import", str(OWN), "-o", "back")
    assert (back.stdout, back.stderr) == ("back/reducer-21-43.toml\n", "Next: gearcad data back/reducer-21-43.toml\n")
    assert read_spec("back/reducer-21-43.toml").to_dict() == read_spec("reducer-21-43.toml").to_dict()


def test_a_spec_that_is_there_is_kept() -> None:
    run("export", "reducer-21-43.toml", "--quiet")
    refused = run("import", str(OWN), status=2)
    expected = "Error: output = 'reducer-21-43.toml': exists; give another folder, or --force to replace it\n"
    assert refused.stderr == expected
    assert run("import", str(OWN), "--force", "--quiet").stderr == ""


def test_documents() -> None:
    there = json.loads(run("export", "reducer-21-43.toml", "--json", "--quiet").stdout)
    assert (there["kind"], there["format"], there["version"], there["passed"]) == ("export", "rexs", "1.6", None)
    assert len(there["kept"]) == 15
    unit = Path(__file__).parents[1] / "data" / "rexs_gear_unit.rexs"
    back = json.loads(run("import", str(unit), "--json", "--quiet").stdout)
    assert [each["name"] for each in back["specs"]] == ["First-stage", "Second-stage"]
    assert back["warnings"][0] == "load cases: the first of 2 is taken" and len(back["warnings"]) == 11


def test_lines_in_german() -> None:
    told = run("--language", "de", "export", "reducer-21-43.toml").stderr
    assert "material.group: REXS hat kein Attribut dafür; aufbewahrt als custom_gearcad_group, nur für gearcad\n" in told


def test_a_wrong_format_and_a_wrong_kind_of_design() -> None:
    assert "'step' is not 'rexs'" in run("export", "reducer-21-43.toml", "--format", "step", status=2).stderr
    run("new", "planetary-24-21-66")
    told = run("export", "planetary-24-21-66.toml", status=2).stderr
    assert told.startswith("Error: kind = 'planetary': must be a gear or a pair: planetary sets,") and told.count("\n") == 1


# ---------------------------------------------------------------- files that are none

MODEL = '<model version="1.6" applicationId="x" applicationVersion="1" date="2024-01-01T00:00:00+00:00">{}</model>'
GEAR = '<component id="1" type="cylindrical_gear" name="g">{}</component>'
TEETH = '<attribute id="number_of_teeth" unit="none">20</attribute>'
SIZES = '<attribute id="normal_module" unit="mm">2</attribute><attribute id="face_width" unit="mm">20</attribute>'
LAUGHS = "".join(f'<!ENTITY l{n} "{f"&l{n - 1};" * 10}">' for n in range(1, 9))
RELATED = '<relation id="1" type="stage"><ref id="{}" role="gear_1"/><ref id="1" role="gear_2"/></relation>'


def gear(attributes: str) -> str:
    return MODEL.format(f"<components>{GEAR.format(attributes)}</components>")


def mesh(first: str) -> str:
    stage = '<component id="3" type="cylindrical_stage" name="s"/>'
    related = f"<relations>{RELATED.format(first)}</relations>"
    return MODEL.format(f"{related}<components>{GEAR.format(TEETH + SIZES)}{stage}</components>")


BAD = {
    "entities": (
        f'<!DOCTYPE model [<!ENTITY l0 "ha">{LAUGHS}]>{gear("&l8;")}',
        r"has a document type or entities, which files of REXS do not have: take them out",
    ),
    "a file beside": (f'<!DOCTYPE model [<!ENTITY x SYSTEM "/etc/passwd">]>{gear("&x;")}', r"has a document type or entities"),
    "a definition elsewhere": (f'<!DOCTYPE model SYSTEM "http://localhost/x.dtd">{gear(TEETH)}', r"has a document type"),
    "deep": (
        "<model>" * 10000 + "</model>" * 10000,
        r"is too large or too deep: at most 400,000 elements, 12 of them inside each other, are read",
    ),
    "many": (MODEL.format("<b/>" * 400_001), r"is too large or too deep"),
    "huge": (MODEL.format(" " * 11_000_000), r"cannot be read \(.*MB.*\); give a file of REXS"),
    "empty": ("", r", line 1: is no XML that can be read \(no element found\)"),
    "cut": (gear(TEETH)[:-20], r", line 1: is no XML"),
    "text": ("teeth = 20", r", line 1: is no XML that can be read \(syntax error\)"),
    "JSON": ('{"model": {}}', r"is REXS in JSON, which is not read: save it as XML"),
    "ZIP": ("PK\x03\x04", r"is a ZIP archive: unpack it"),
    "other XML": ("<svg/>", r"its outermost element is svg, that of REXS is model"),
    "no version": ("<model/>", r"model: version = missing: must be from 1.0 to 1.7"),
    "later": (MODEL.replace("1.6", "9.9").format(""), r"model: version = 9.9: must be from 1.0 to 1.7"),
    "nothing": (MODEL.format(""), r"has no cylindrical gears, and gearcad has no others"),
    "no teeth": (gear(SIZES), r"component 1 \(cylindrical_gear, g\): number_of_teeth is missing: it must be given"),
    "no module": (gear(TEETH), r"component 1 \(cylindrical_gear, g\): normal_module is missing: it must be given, in mm"),
    "half a tooth": (
        gear(SIZES + TEETH.replace("20", "20.5")),
        r"number_of_teeth = 20.5: must be a whole number",
    ),
    "a comma": (gear(TEETH + SIZES.replace(">2<", ">2,5<")), r"normal_module = 2,5: must be a number with a decimal point"),
    "not a number": (gear(TEETH + SIZES.replace(">2<", ">nan<")), r"normal_module = nan: must be a number"),
    "beyond any": (gear(TEETH + SIZES.replace(">2<", ">1e999<")), r"normal_module = 1e999: must be a number"),
    "very long": (gear(TEETH + SIZES.replace(">2<", f">{'9' * 100000}<")), r"normal_module = 9+\.\.\.: must be a number"),
    "inches": (gear(TEETH + SIZES.replace("mm", "in", 1)), r"normal_module: its unit is in, must be mm"),
    "a cutter without teeth": (
        MODEL.format(
            '<relations><relation id="1" type="reference"><ref id="1" role="origin"/><ref id="2" role="referenced"/></relation>'
            f'</relations><components>{GEAR.format(TEETH + SIZES)}<component id="2" type="cutter_wheel_tool"/></components>'
        ),
        r"component 2 \(cutter_wheel_tool\): number_of_teeth is missing: it must be given",
    ),
    "impossible": (gear(TEETH + SIZES.replace(">2<", ">-2<")), r"g: gear.normal_module = -2 mm: must be a number at least"),
    "no id": (gear("<attribute>2</attribute>"), r"component 1: an attribute has no id"),
    "a word for an id": (MODEL.format('<components><component id="x"/></components>'), r"component: id = x: must be a whole"),
    "an id without": (MODEL.format("<components><component/></components>"), r"component: id = missing: must be a whole"),
    "twice": (MODEL.format(f"<components>{GEAR.format('') * 2}</components>"), r"its id is there twice"),
    "dangling": (mesh("7"), r"relation stage: there is no component 7"),
    "a stage of stages": (mesh("3"), r"component 3 \(cylindrical_stage, s\): gears are missing: a relation stage must name"),
    "a wrong load case": (
        MODEL.format('<components/><load_spectrum id="1"><load_case id="1"><component id="4"/></load_case></load_spectrum>'),
        r"load case: component 4 \(\): there is no component of this id",
    ),
    "our own, no JSON": (
        gear(TEETH + SIZES + '<attribute id="custom_gearcad_tip_diameter" unit="none">[[</attribute>'),
        r"custom_gearcad_tip_diameter = \[\[: must be a value in JSON",
    ),
    "our own, nested": (
        gear(f'{TEETH}{SIZES}<attribute id="custom_gearcad_tip_diameter">{"[" * 100000}</attribute>'),
        r"custom_gearcad_tip_diameter = \[+\.\.\.: must be a value in JSON",
    ),
    **{
        f"our own, {value}": (
            gear(f'{TEETH}{SIZES}<attribute id="custom_gearcad_tip_diameter">{value}</attribute>'),
            rf"custom_gearcad_tip_diameter = {re.escape(value)}: must be a value in JSON",
        )
        for value in ("null", '{"a": 1}', "[null]", '"\\ud800"')
    },
    "our own, a word": (
        gear(f'{TEETH}{SIZES}<attribute id="custom_gearcad_tip_diameter">"x"</attribute>'),
        r"g: gear.tip_diameter = 'x': must be",
    ),
    "control characters": (gear(TEETH).replace('name="g"', 'name="&#x9b;[2J"'), r"normal_module is missing"),
    "an encoding": ('<?xml version="1.0" encoding="x-nothing"?><model/>', r"is no XML that can be read|its encoding"),
}


@pytest.mark.parametrize("case", BAD)
def test_a_bad_file_is_one_line(case: str) -> None:
    text, expected = BAD[case]
    Path("bad.rexs").write_text(text, encoding="utf-8")
    told = run("import", "bad.rexs", status=2).stderr
    assert re.search(f"^Error: bad.rexs(:|, line).*{expected}|^Error: bad.rexs{expected}", told), told
    assert told.count("\n") == 1 and told.rstrip("\n").isprintable() and len(told) < 400
    assert not list(Path().glob("*.toml.*")) and [*Path().glob("*.toml")] == [Path("reducer-21-43.toml")]


def test_other_encodings_and_bytes() -> None:
    text = gear(TEETH + SIZES)
    for encoding in ("utf-16", "utf-8-sig", "iso-8859-1"):
        head = '<?xml version="1.0" encoding="iso-8859-1"?>' if encoding.startswith("iso") else ""
        Path("it.rexs").write_bytes((head + text).encode(encoding))
        assert run("import", "it.rexs", "-o", "out", "--force").stdout == "out/g.toml\n"
    Path("it.rexs").write_bytes(b"\xff\xfe\x00\xd8" * 50)
    assert run("import", "it.rexs", status=2).stderr.startswith("Error: it.rexs")
    assert run("import", "none.rexs", status=2).stderr.startswith("Error: none.rexs: cannot be read (No such file")
    assert run("import", ".", status=2).stderr.startswith("Error: .: cannot be read (Is a directory")


def test_names_make_no_paths() -> None:
    Path("it.rexs").write_text(gear(TEETH + SIZES).replace('name="g"', 'name="../../../etc/x"'), encoding="utf-8")
    (written,) = run("import", "it.rexs", "-o", "out").stdout.splitlines()
    assert Path(written).parent == Path("out") and [each.name for each in Path("out").iterdir()] == [Path(written).name]


def test_a_file_has_no_more_gears_than_a_person_would_look_at() -> None:
    gears = "".join(GEAR.replace('id="1"', f'id="{n}"').format(TEETH + SIZES) for n in range(1, 202))
    Path("many.rexs").write_text(MODEL.format(f"<components>{gears}</components>"), encoding="utf-8")
    told = run("import", "many.rexs", status=2).stderr
    assert told == "Error: many.rexs: has 201 stages or gears: at most 200 are read\n"
