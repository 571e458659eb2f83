"""Jobs work on one thread, and leave everything as it was: the libraries that they load too."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest
from threadpoolctl import ThreadpoolController

from gearcad.core.runtime import one_thread

LOADED_MEANWHILE = """
from gearcad.core.runtime import one_thread
from threadpoolctl import ThreadpoolController
def threads():
    return sorted(each.num_threads for each in ThreadpoolController().select(user_api="blas").lib_controllers)
import numpy
before = threads()
with one_thread():
    import scipy.linalg
    print(threads() == [1] * len(threads()) and len(threads()) > len(before))
print(set(threads()) == set(before))
"""


def test_libraries_that_are_loaded_meanwhile() -> None:
    environment = os.environ | {"OPENBLAS_NUM_THREADS": "2"}
    said = subprocess.run([sys.executable, "-c", LOADED_MEANWHILE], env=environment, capture_output=True, text=True, check=True)
    assert said.stdout.split() == ["True", "True"]


def test_the_environment_is_as_before(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "2")
    monkeypatch.delenv("OMP_NUM_THREADS", raising=False)
    before = [each.num_threads for each in ThreadpoolController().lib_controllers]
    with pytest.raises(KeyError), one_thread():
        assert os.environ["OMP_NUM_THREADS"] == os.environ["OPENBLAS_NUM_THREADS"] == "1"
        raise KeyError
    assert os.environ["OPENBLAS_NUM_THREADS"] == "2" and "OMP_NUM_THREADS" not in os.environ
    assert [each.num_threads for each in ThreadpoolController().lib_controllers] == before
