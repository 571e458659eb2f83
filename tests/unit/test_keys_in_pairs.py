"""Keys inside the pairs of a train's meshes: in tables, studies and `dynamics --vary`, for pairs in tables and in files."""

from pathlib import Path

import pytest

from gearcad.batch.study import plan_study, write_study
from gearcad.core.errors import ParameterError, SpecError
from gearcad.core.records import Role
from gearcad.designs import TrainDesign, open_table, read_spec
from gearcad.designs.reader import design_from_values, starter_text
from gearcad.designs.train_keys import COUNTS, TrainKey, general_key
from gearcad.designs.variations import column_symbol, read_values, read_variants, read_variation
from gearcad.dynamics import MeshPair
from gearcad.geometry import GearPair

STAGE = "mesh.stage 1.pair"


def spec_of(folder: Path) -> Path:
    """The starter train-pairs, its second pair in a file of its own."""
    text = starter_text("train-pairs")[1]
    before, _, second = text.rpartition("[train.mesh.pair]")
    tables, _, rest = second.partition("\n[dynamics]")
    path, pair = folder / "train.toml", folder / "second.toml"
    pair.write_text("[pair]" + tables.replace("[train.mesh.pair.", "["), encoding="utf-8")
    path.write_text(f'{before}pair = "second.toml"\n\n[dynamics]{rest}', encoding="utf-8")
    return path


def pairs(design: object) -> list[GearPair]:
    assert isinstance(design, TrainDesign)
    return [mesh.pair.pair for mesh in design.train.meshes if isinstance(mesh.pair, MeshPair)]


def varied(folder: Path, *texts: str) -> list[list[GearPair]]:
    return [pairs(design) for design in read_variants(spec_of(folder), texts).designs]


def test_a_key_in_a_pair_of_tables_varies_and_nothing_else_does(tmp_path: Path) -> None:
    base = pairs(read_spec(spec_of(tmp_path)))
    found = varied(tmp_path, f"{STAGE}.pinion.profile_shift=0.1,0.4")
    assert [each[0].pinion.profile_shift for each in found] == [0.1, 0.4]
    for each in found:
        assert each[1] == base[1]
        assert each[0].wheel == base[0].wheel or each[0].wheel.tip_alteration != base[0].wheel.tip_alteration
        assert each[0].pinion.teeth == base[0].pinion.teeth


def test_a_key_in_a_pair_of_a_file_varies_and_the_file_does_not(tmp_path: Path) -> None:
    path = spec_of(tmp_path)
    before = (tmp_path / "second.toml").read_bytes()
    found = [pairs(design) for design in read_variants(path, ["mesh.stage 2.pair.face_width=21,33"]).designs]
    assert [each[1].pinion.face_width for each in found] == [21.0, 33.0]
    assert (tmp_path / "second.toml").read_bytes() == before


def test_all_pairs_vary_together_and_own_values_count_before(tmp_path: Path) -> None:
    found = varied(tmp_path, "mesh.*.pair.face_width=20,30", f"{STAGE}.face_width=26")
    assert [[pair.pinion.face_width for pair in each] for each in found] == [[26.0, 20.0], [26.0, 30.0]]


def test_teeth_must_be_whole_and_the_loads_must_fit(tmp_path: Path) -> None:
    """Other tooth numbers change the ratio: torques must follow, as in any train."""
    found = varied(tmp_path, f"{STAGE}.pinion.teeth=18", f"{STAGE}.wheel.teeth=54")
    assert [pair.pinion.teeth for pair in found[0]] == [pair.pinion.teeth for pair in pairs(read_spec(spec_of(tmp_path)))]
    with pytest.raises(SpecError, match="must be 0 on a train that no shaft holds"):
        varied(tmp_path, f"{STAGE}.wheel.teeth=55")
    found = varied(tmp_path, f"{STAGE}.wheel.teeth=36", f"train.torques.machine={-40 * 36 / 18 * 48 / 18}")
    assert found[0][0].wheel.teeth == 36
    with pytest.raises(ParameterError, match="must make whole numbers"):
        varied(tmp_path, f"{STAGE}.wheel.teeth=54.5")


def test_shafts_and_parts_of_gears_in_a_pair() -> None:
    """Lists of tables by their numbers, as in a pair by itself; parts of gears by their dots."""
    key = f"{STAGE}.pinion.shaft[1].outer_diameter"
    found = TrainKey.of(key)
    assert found is not None and (found.name, found.in_pair) == ("stage 1", "pinion.shaft[1].outer_diameter")
    assert general_key(key) == "mesh.*.pair.pinion.shaft[].outer_diameter" and str(found) == key
    assert general_key(f"{STAGE}.wheel.teeth") in COUNTS
    owner, symbol = column_symbol(f"{STAGE}.{Role.WHEEL.value}.profile_shift") or ("", None)
    assert owner == "stage 1 wheel" and symbol is not None and symbol.symbol == "x"
    named = TrainKey.of("mesh.a.pair.b.pair.normal_module")
    assert named is not None and (named.name, named.in_pair) == ("a.pair.b", "normal_module")


def test_values_of_a_table_go_where_they_belong(tmp_path: Path) -> None:
    """A shaft that is not there yet, a part with dots, a diametral pitch in the place of a module."""
    base = read_values(spec_of(tmp_path))
    values = {key: given.value for key, given in base.values.items()}
    more = {f"{STAGE}.pinion.rack.root_radius": 0.3, f"{STAGE}.normal_diametral_pitch": 12.7}
    design = design_from_values(values | more, base.kind, where=str, default_name="x")
    first = pairs(design)[0]
    assert first.pinion.rack.root_radius == 0.3 and first.pinion.normal_module == pytest.approx(2.0)
    with pytest.raises(SpecError, match="the list has 0 tables before it"):
        design_from_values(values | {f"{STAGE}.pinion.shaft[1].length": 5.0}, base.kind, where=str, default_name="x")


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (f"{STAGE}.pinion.teth=1", "unknown key; did you mean mesh.stage 1.pair.pinion.teeth?"),
        (f"{STAGE}.qqqqqq=1", "unknown key; must be one of a pair, such as mesh.stage 1.pair.pinion.teeth"),
        ("mesh.stage 3.pair.pinion.teeth=1", "the train has no mesh stage 3; did you mean mesh.stage 2.pair.pinion.teeth?"),
    ],
)
def test_wrong_keys(text: str, message: str, tmp_path: Path) -> None:
    base = read_values(spec_of(tmp_path))
    with pytest.raises(ParameterError) as caught:
        read_variation(text, base.kind, base.values, sampled=False)
    assert message in str(caught.value)


def test_a_mesh_without_a_pair_has_no_such_key(tmp_path: Path) -> None:
    path = tmp_path / "train.toml"
    path.write_text(starter_text("train-1-stage")[1], encoding="utf-8")
    with pytest.raises(SpecError, match="the mesh has no pair"):
        read_variants(path, ["mesh.mesh.pair.pinion.teeth=18"])


def test_a_table_of_trains_has_columns_of_keys_in_pairs(tmp_path: Path) -> None:
    """By way of a study's file; a row tells each wrong value in its column."""
    table = tmp_path / "t.csv"
    write_study(plan_study(spec_of(tmp_path), [f"{STAGE}.pinion.profile_shift=0.1,0.4"]), table)
    rows = list(open_table(table).rows())
    assert [pairs(row.design())[0].pinion.profile_shift for row in rows] == [0.1, 0.4]
    text = table.read_text(encoding="utf-8")
    table.write_text(text.replace(",0.1\n", ",77\n").replace(",2950.0,", ",fast,", 1), encoding="utf-8")
    first = next(iter(open_table(table).rows()))
    faults = first.all_faults()
    assert len(faults) == 2
    assert "train.speed = 'fast'" in faults[0] and "pinion.profile_shift = 77" in faults[1]
