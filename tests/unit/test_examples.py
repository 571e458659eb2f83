"""The examples in docstrings give what they show."""

from __future__ import annotations

import doctest
import importlib
import re
from pathlib import Path

import pytest

import gearcad

PACKAGE = Path(gearcad.__file__).parent
ROOMS = [
    ".".join(path.relative_to(PACKAGE.parent).with_suffix("").parts).removesuffix(".__init__")
    for path in sorted(PACKAGE.rglob("*.py"))
    if re.search(rb"^ *>>> ", path.read_bytes(), re.MULTILINE)
]


@pytest.mark.parametrize("room", ROOMS)
def test_examples_give_what_they_show(room: str) -> None:
    found = doctest.testmod(importlib.import_module(room))
    assert found.attempted and not found.failed
