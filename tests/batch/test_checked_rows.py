"""A row's design is made by its check and goes on to its worker, unless what the row names has changed meanwhile."""

from __future__ import annotations

import pickle
import shutil
from pathlib import Path

import pytest
from support.batches import PAIRS, write_table
from support.designs import starter_specs

from gearcad.batch.row import Checked, Status, Task, check_rows, inputs_hash, make_row, stages
from gearcad.designs import read_spec
from gearcad.designs.table import DesignRow, open_table
from gearcad.jobs.job import Data

SPECS = starter_specs()


@pytest.mark.parametrize("spec", SPECS, ids=lambda path: path.stem)
def test_design_of_any_kind_arrives_as_it_was_sent(spec: Path) -> None:
    design = read_spec(spec)
    assert pickle.loads(pickle.dumps(design)).to_dict() == design.to_dict()


def task(row: DesignRow, checked: Checked, folder: Path) -> Task:
    workspace = folder / ".work"
    workspace.mkdir(parents=True, exist_ok=True)
    return Task(row, stages([Data()]), folder, workspace, True, checked)


def test_row_is_made_of_the_design_that_its_check_has_made(tmp_path: Path) -> None:
    first, second = open_table(write_table(tmp_path / "t.csv", PAIRS)).rows()
    one, other = check_rows([first, second])
    assert (one.faults, one.inputs) == ((), inputs_hash(first.inputs))
    swapped = task(first, Checked(inputs=one.inputs, design=other.design), tmp_path)
    assert swapped.design(one.inputs).name == second.name
    assert swapped.design("of other inputs").name == first.name
    made = make_row(task(first, one, tmp_path))
    content = (tmp_path / first.name / "data.json").read_bytes()
    shutil.rmtree(tmp_path / first.name)
    again = make_row(task(first, Checked(), tmp_path))
    assert (made.status, made.values, made.files) == (Status.OK, again.values, again.files)
    assert (tmp_path / first.name / "data.json").read_bytes() == content


def test_row_at_fault_has_no_design(tmp_path: Path) -> None:
    (row,) = open_table(write_table(tmp_path / "t.csv", (PAIRS[0], "bad,1,,2,23,0.4,2,2"))).rows()
    (checked,) = check_rows([row])
    assert (len(checked.faults), checked.design) == (1, b"")
    with pytest.raises(ValueError, match="teeth"):
        task(row, checked, tmp_path).design(inputs_hash(row.inputs))
