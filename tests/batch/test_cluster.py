"""On a Dask cluster the same rows give the same files, and what goes wrong there is told in one line."""

import http.client
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import psutil
import pytest
from support import jobs
from support.batches import GEARS, MIXED, lies, read_results, snapshot, write_table
from support.processes import PATIENCE, below, run_batch, start_batch, wait_for_end, wait_until

from gearcad.batch import BatchSummary, run_table
from gearcad.batch import pool as pool_module
from gearcad.batch import run as run_module
from gearcad.batch.row import Status, Task, make_row
from gearcad.core.errors import ParameterError
from gearcad.designs.table import open_table
from gearcad.jobs.build import Build
from gearcad.jobs.job import Data
from gearcad.solids import Format

distributed = pytest.importorskip("distributed")

DATA = (Data(),)
OPTIONS, FILES = ("--format", "csv,stl", "--quiet"), (Build(formats=(Format.CSV, Format.STL)),)
ROWS = 100
MANY = (GEARS[0], *(f"row {number:03d},{12 + number % 50},1,2,{number % 3}" for number in range(ROWS)))

_SCHEDULER = """
import sys
from distributed import LocalCluster
if __name__ == "__main__":
    cluster = LocalCluster(n_workers=2, threads_per_worker=1, memory_limit=None, dashboard_address=None, silence_logs=60)
    print(cluster.scheduler_address, flush=True)
    sys.stdin.read()
    cluster.close()
"""


@contextmanager
def running_cluster(folder: Path) -> Iterator[tuple[str, psutil.Process]]:
    """A scheduler with two workers, as processes of their own: their address, and the scheduler."""
    script = folder / "scheduler.py"
    script.write_text(_SCHEDULER)
    command = [sys.executable, str(script)]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL}
    path = {"PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    with subprocess.Popen(command, text=True, cwd=folder, env=os.environ | path, **pipes) as process:
        assert process.stdin is not None and process.stdout is not None
        yield process.stdout.readline().strip(), psutil.Process(process.pid)
        below = psutil.Process(process.pid).children(recursive=True) if process.poll() is None else []
        process.stdin.close()
        process.wait(PATIENCE)
    for each in wait_for_end(below, PATIENCE):
        each.kill()


def open_ports(processes: list[psutil.Process]) -> set[tuple[str, int]]:
    """Address and number of every port at which one of the processes listens."""
    found = set()
    for each in processes:
        with suppress(psutil.Error):
            found |= {(of.laddr.ip, of.laddr.port) for of in each.net_connections("tcp") if of.status == psutil.CONN_LISTEN}
    return found


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[str, psutil.Process]]:
    with running_cluster(tmp_path_factory.mktemp("cluster")) as found:
        yield found


@pytest.fixture
def address(cluster: tuple[str, psutil.Process]) -> str:
    return cluster[0]


@pytest.fixture(scope="module")
def expected(tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """The tree that a run without a cluster makes."""
    folder = tmp_path_factory.mktemp("plain")
    assert run_table(write_table(folder / "table.csv", MIXED), folder / "out", FILES, jobs=1).ok == 3
    return snapshot(folder / "out")


def test_local_cluster_makes_the_same_files(tmp_path: Path, expected: dict[str, str]) -> None:
    """Its ports are of this machine only, and none is that of Dask's dashboard."""
    table = write_table(tmp_path / "table.csv", MIXED)
    ports: set[tuple[str, int]] = set()
    with start_batch(table, "-o", tmp_path / "out", *OPTIONS, "--cluster", "local", "-j", "2") as process:
        while process.poll() is None:
            ports |= open_ports([psutil.Process(process.pid), *below(process)])
            time.sleep(0.5)
        assert (process.returncode, process.communicate()[1]) == (0, "")
    assert snapshot(tmp_path / "out") == expected
    assert len(ports) > 3 and {address for address, _ in ports} == {"127.0.0.1"}
    assert 8787 not in {port for _, port in ports}


def test_local_cluster_has_no_page_to_look_at() -> None:
    with pool_module._local_cluster(0) as cluster:
        for path in ("/", "/status", "/info/main/workers.html", "/json/counts.json", "/metrics"):
            connection = http.client.HTTPConnection("127.0.0.1", cluster.scheduler.http_server.port, timeout=PATIENCE)
            connection.request("GET", path)
            assert connection.getresponse().status == 404, path


def test_cluster_at_an_address_makes_the_same_files_and_leaves_no_process(
    address: str, tmp_path: Path, expected: dict[str, str]
) -> None:
    table = write_table(tmp_path / "table.csv", MIXED)
    done = run_batch(table, "-o", tmp_path / "out", *OPTIONS, "--cluster", address)
    assert (done.returncode, done.stderr) == (0, "")
    assert snapshot(tmp_path / "out") == expected
    with distributed.Client(address) as client:
        assert set(client.run(lambda: len(psutil.Process().children())).values()) == {0}

    assert run_table(table, tmp_path / "out", FILES, jobs=1).ok == 3
    assert snapshot(tmp_path / "out") == expected
    assert [line["seconds"] for line in read_results(tmp_path / "out")] == [""] * 3


def test_relative_folder_is_that_of_the_caller(address: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Workers of a cluster stand elsewhere."""
    monkeypatch.chdir(tmp_path)
    write_table(Path("table.csv"), GEARS)
    summary = run_table("table.csv", Path("out"), DATA, cluster=address)
    assert (summary.ok, summary.results[0]) == (3, Path("out/results.csv"))
    assert (tmp_path / "out" / "left" / "data.json").is_file()


def test_row_that_takes_its_worker_with_it_costs_that_row_only(
    address: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(run_module, "make_row", jobs.make_row_or_die)
    names = ["a", "segfault-1", "b", "kill-1", "exit-1", "c"]
    lines = ("name,teeth,normal_module,face_width", *(f"{name},{20 + n},1,5" for n, name in enumerate(names)))
    summary = run_table(write_table(tmp_path / "t.csv", lines), tmp_path / "out", DATA, cluster=address)
    assert (summary.ok, summary.failed) == (3, 3)
    deaths = (
        "killed its process (SIGSEGV)",
        "killed its process (SIGKILL, perhaps for want of memory)",
        "ended its process (exit status 3)",
    )
    assert [error.endswith(f"-1): {death}") for error, death in zip(summary.errors, deaths, strict=True)] == [True] * 3
    assert [line["status"] for line in read_results(tmp_path / "out") if "-" not in line["name"]] == ["ok"] * 3


@pytest.fixture
def many(tmp_path: Path) -> Path:
    return write_table(tmp_path / "many.csv", MANY)


@pytest.mark.long
def test_ctrl_c_ends_the_run_on_the_cluster_too(address: str, many: Path, tmp_path: Path) -> None:
    folder = tmp_path / "out"
    with start_batch(many, "-o", folder, "--format", "stl", "--cluster", address, "--quiet") as process:
        wait_until(lambda: len(list(folder.glob("row*"))) > 10, "rows that are finished")
        process.send_signal(signal.SIGINT)
        _, errors = process.communicate(timeout=PATIENCE)
    assert (process.returncode, errors.strip()) == (130, "Aborted!")
    assert {line["status"] for line in read_results(folder)} == {"ok", "not run"}
    assert run_table(many, folder, (Build(formats=(Format.STL,)),), cluster=address).ok == ROWS
    assert lies(folder) == [] and not list(folder.glob(".*"))


def run_here(table: Path, folder: Path, address: str) -> tuple[list[BatchSummary], threading.Thread]:
    """A run in a thread, so that something can happen to the cluster meanwhile."""
    found: list[BatchSummary] = []
    formats = (Build(formats=(Format.STL,)),)
    thread = threading.Thread(target=lambda: found.append(run_table(table, folder, formats, cluster=address)))
    thread.start()
    wait_until(lambda: len(list(folder.glob("row*"))) > 10, "rows that are finished")
    return found, thread


@pytest.mark.long
def test_worker_of_the_cluster_that_dies_costs_nothing(cluster: tuple[str, psutil.Process], many: Path, tmp_path: Path) -> None:
    """Dask gives its rows to another, and starts one in its place."""
    address, scheduler = cluster
    found, thread = run_here(many, tmp_path / "out", address)
    workers = [process for process in scheduler.children() if process.children()]
    workers[0].kill()
    thread.join(PATIENCE)
    assert [(summary.ok, summary.failed) for summary in found] == [(ROWS, 0)]
    assert lies(tmp_path / "out") == []


@pytest.mark.long
def test_scheduler_that_dies_ends_the_run_with_what_there_is(
    many: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(pool_module, "_CONNECT_SECONDS", 2)
    with running_cluster(tmp_path) as (address, scheduler):
        found, thread = run_here(many, tmp_path / "out", address)
        below = scheduler.children(recursive=True)
        scheduler.kill()
        thread.join(PATIENCE)
        for process in wait_for_end(below, PATIENCE):
            process.kill()
    (summary,) = found
    assert summary.stopped == "the cluster is gone: its scheduler does not answer any more"
    assert summary.ok >= 1 and summary.failed == 0 and summary.ok + summary.not_run == ROWS
    assert {line["status"] for line in read_results(tmp_path / "out")} == {"ok", "not run"}
    assert "Traceback" not in capfd.readouterr().err
    assert run_table(many, tmp_path / "out", (Build(formats=(Format.STL,)),), jobs=2).ok == ROWS


# ---------------------------------------------------------------------- clusters that cannot be used


def refused(tmp_path: Path, address: str) -> str:
    with pytest.raises(ParameterError) as caught:
        run_table(write_table(tmp_path / "table.csv", GEARS), tmp_path / "out", DATA, cluster=address)
    assert not (tmp_path / "out").exists()
    text = str(caught.value)
    assert text.startswith(f"cluster = {address!r}: ") and "\n" not in text
    return text.removeprefix(f"cluster = {address!r}: ")


@contextmanager
def server(answer: Callable[[socket.socket], Any]) -> Iterator[str]:
    """Something at an address that is no scheduler."""
    with socket.create_server(("127.0.0.1", 0)) as listener:

        def serve() -> None:
            connections = []
            while True:
                try:
                    connections.append(listener.accept()[0])
                    answer(connections[-1])
                except OSError:
                    return

        threading.Thread(target=serve, daemon=True).start()
        yield f"tcp://127.0.0.1:{listener.getsockname()[1]}"
        listener.shutdown(socket.SHUT_RDWR)


@pytest.fixture
def hurried(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pool_module, "_CONNECT_SECONDS", 1)


def test_address_where_nobody_listens(tmp_path: Path, hurried: None) -> None:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        address = f"tcp://127.0.0.1:{listener.getsockname()[1]}"
    began = time.monotonic()
    assert refused(tmp_path, address).endswith("; give tcp://HOST:PORT or local")
    assert time.monotonic() - began < 30


def test_address_where_somebody_listens_and_says_nothing(tmp_path: Path, hurried: None) -> None:
    with server(lambda connection: None) as address:
        assert refused(tmp_path, address) == "cannot be reached (no answer in 1 s); give tcp://HOST:PORT or local"


@pytest.mark.parametrize("answer", [b"HTTP/1.1 400 Bad Request\r\n\r\n", b"SSH-2.0-OpenSSH_9.2p1\r\n"])
def test_address_of_another_service(answer: bytes, tmp_path: Path, hurried: None) -> None:
    with server(lambda connection: connection.sendall(answer)) as address:
        assert refused(tmp_path, address) == "answers, but not as a Dask scheduler does; give its tcp://HOST:PORT or local"


@pytest.mark.parametrize("address", ["nonsense", "", "tcp://", "ftp://127.0.0.1:8786", "tcp://127.0.0.1:port"])
def test_text_that_is_no_address(address: str, tmp_path: Path, hurried: None) -> None:
    assert refused(tmp_path, address).endswith("; give tcp://HOST:PORT or local")


def test_cluster_without_workers(tmp_path: Path) -> None:
    options = {"n_workers": 0, "dashboard_address": ":0", "processes": False, "protocol": "tcp"}
    with distributed.LocalCluster(**options) as cluster:
        assert refused(tmp_path, cluster.scheduler_address) == "has no workers"


def test_cluster_with_another_gearcad(address: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from gearcad import __version__

    monkeypatch.setattr(pool_module, "__version__", "99.0")
    text = refused(tmp_path, address)
    assert text.startswith("its worker tcp://") and text.endswith(f" has gearcad {__version__}, this is 99.0")


def test_without_dask_it_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    for address in ("local", "tcp://127.0.0.1:8786"):
        assert refused(tmp_path, address) == 'needs Dask: pip install "gearcad[cluster]"'


def test_folder_that_the_worker_cannot_see_ends_the_run(tmp_path: Path) -> None:
    """A worker on another machine, without the file system of this one."""
    row = next(open_table(write_table(tmp_path / "table.csv", GEARS)).rows())
    record = make_row(Task(row, DATA, tmp_path / "out", tmp_path / "out" / ".work", False))
    start = f"output = '{tmp_path / 'out'}': is not there for the worker on {socket.gethostname()}; give a folder that "
    assert (record.status, record.stop, record.error) == (Status.FAILED, True, f"{start}all workers share")
    assert not (tmp_path / "out").exists()
