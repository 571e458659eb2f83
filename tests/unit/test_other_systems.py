"""What Windows and macOS ask for, as far as it can be read from the source or simulated on this system."""

import ast
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

import gearcad
from gearcad.batch.row import Manifest, publish
from gearcad.core.errors import ParameterError
from gearcad.designs.design import require_plain_name

PACKAGE = Path(gearcad.__file__).parent
UNIX_MODULES = {"fcntl", "resource", "pwd", "grp", "termios", "pty"}
UNIX_SIGNALS = {"SIGHUP", "SIGKILL", "SIGCHLD", "SIGALRM", "SIGUSR1", "SIGUSR2", "SIGQUIT", "SIGPIPE"}
UNIX_FUNCTIONS = {"fork", "killpg", "getuid", "geteuid", "setsid", "sched_getaffinity", "waitpid", "mkfifo", "getloadavg"}
FORKED_ONLY = PACKAGE / "core" / "guard.py"
"""The module whose signals are used after `os.fork` only, which Windows has not; `CAN_GUARD` asks for it."""


def _asks(node: ast.AST) -> bool:
    """Return whether a statement has a way out for other systems: try, with, and an if that asks for the system."""
    asked = ("sys.platform", "hasattr(")
    return isinstance(node, ast.Try | ast.With) or (
        isinstance(node, ast.If) and any(each in ast.unparse(node.test) for each in asked)
    )


TOLD = re.compile(
    rf"(read|write)_text\(|open\(|text=|universal_newlines|import ({'|'.join(UNIX_MODULES)})\b|signal\.SIG|\bos\."
)
"""What a module has that is to be read at all."""


def _parsed() -> Iterator[tuple[Path, ast.Module]]:
    for file in sorted(PACKAGE.rglob("*.py")):
        text = file.read_text(encoding="utf-8")
        if TOLD.search(text):
            yield file, ast.parse(text)


def _wrong_in(file: Path, tree: ast.Module) -> Iterator[str]:
    """Yield the places in a module that depend on the system without asking for it."""
    text = file.read_text(encoding="utf-8")
    guarded = set(_inside_of_tries(tree, False))
    for node in ast.walk(tree):
        where = f"{file.relative_to(PACKAGE)}:{getattr(node, 'lineno', 0)}"
        if isinstance(node, ast.Call):
            yield from (f"{where}: {why}" for why in _wrong_call(node))
        if isinstance(node, ast.Import | ast.ImportFrom):
            names = {each.name for each in node.names} | {getattr(node, "module", None)}
            if names & UNIX_MODULES and node not in guarded:
                yield f"{where}: import without a way out"
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and file != FORKED_ONLY:
            owner = node.value.id
            if owner == "signal" and node.attr in UNIX_SIGNALS and not _asked_for(node.attr, text):
                yield f"{where}: signal.{node.attr}"
            if owner == "os" and node.attr in UNIX_FUNCTIONS and not _asked_for(node.attr, text) and node not in guarded:
                yield f"{where}: os.{node.attr}"


def _inside_of_tries(node: ast.AST, inside: bool) -> Iterator[ast.AST]:
    """Yield the nodes inside of statements with a way out."""
    if inside:
        yield node
    for child in ast.iter_child_nodes(node):
        yield from _inside_of_tries(child, inside or _asks(node))


def _asked_for(name: str, text: str) -> bool:
    """Return whether a module asks for a name by hasattr; SIGKILL is used with killpg only."""
    return f'"{name}")' in text or (name == "SIGKILL" and 'hasattr(os, "killpg")' in text)


def _wrong_call(call: ast.Call) -> Iterator[str]:
    """Yield what a call leaves to the system: the encoding and the ends of lines of texts, and renames onto files."""
    name = call.func.attr if isinstance(call.func, ast.Attribute) else getattr(call.func, "id", "")
    given = {each.arg for each in call.keywords}
    values = {each.arg: each.value for each in call.keywords}
    if name == "read_text" and "encoding" not in given and not call.args:
        yield "read_text without an encoding"
    if name == "write_text" and not {"encoding", "newline"} <= given:
        yield "write_text without encoding and newline"
    if name == "open" and isinstance(call.func, ast.Attribute | ast.Name):
        mode = next(
            (each.value for each in call.args if isinstance(each, ast.Constant) and each.value in ("w", "a", "x")), None
        )
        if mode is not None and not {"encoding", "newline"} <= given:
            yield "a text is opened without encoding and newline"
    if "text" in given or "universal_newlines" in given:
        if name in ("run", "Popen", "check_output") and "encoding" not in given:
            yield "the output of a program is read in the encoding of the system"
    if name == "rename" and isinstance(values.get("target"), ast.AST):
        yield "rename onto a file"


def test_texts_and_signals_do_not_depend_on_the_system():
    wrong = [each for file, tree in _parsed() for each in _wrong_in(file, tree)]
    assert wrong == []


@pytest.mark.parametrize(
    ("source", "count"),
    [
        ('path.write_text(text, encoding="utf-8")', 1),
        ("path.read_text()", 1),
        ('path.open("w", encoding="utf-8")', 1),
        ("import fcntl", 1),
        ('if sys.platform == "linux":\n    import resource', 0),
        ("if wanted:\n    import resource", 1),
        ("try:\n    import fcntl\nexcept ImportError:\n    fcntl = None", 0),
        ("os.kill(child, signal.SIGKILL)", 1),
        ("subprocess.run([program], text=True)", 1),
        ('path.write_text(text, encoding="utf-8", newline="\\n")', 0),
    ],
)
def test_the_reader_finds_what_depends_on_the_system(tmp_path, monkeypatch, source, count):
    monkeypatch.setattr(sys.modules[__name__], "PACKAGE", tmp_path)
    file = tmp_path / "module.py"
    file.write_text(source, encoding="utf-8")
    assert len(list(_wrong_in(file, ast.parse(source)))) == count


@pytest.mark.parametrize("name", ["nul", "Com1.5", "COM0", "lpt²", "conin$", "aux.toml", "a:b", "a.", "a "])
def test_names_that_windows_keeps_for_itself(name):
    with pytest.raises(ParameterError, match="must be a plain file name"):
        require_plain_name(name)


def test_a_row_moves_into_a_folder_that_appeared_meanwhile(tmp_path, monkeypatch):
    """On POSIX a rename onto a folder that is not empty is ENOTEMPTY, on Windows EEXIST: the files move one by one."""
    staging, folder = tmp_path / "staging", tmp_path / "row"
    staging.mkdir()
    (staging / "part.step").write_text("new", encoding="utf-8")
    folder.mkdir()
    (folder / "note.txt").write_text("of the user", encoding="utf-8")
    seen = Path.exists
    monkeypatch.setattr(Path, "exists", lambda path: False if path == folder else seen(path))
    publish(staging, folder, Manifest("inputs", {}, ()), None)
    monkeypatch.undo()
    assert (folder / "part.step").read_text(encoding="utf-8") == "new"
    assert (folder / "note.txt").read_text(encoding="utf-8") == "of the user"


MISSING = """
import os, signal, sys
if os.environ.get("SIMULATED") == "windows":
    for name in ("fcntl", "resource", "pwd", "grp", "termios"):
        sys.modules[name] = None
    for name in ("fork", "killpg", "getuid", "sched_getaffinity", "mkfifo", "O_NOFOLLOW", "O_DIRECTORY", "O_NONBLOCK"):
        if hasattr(os, name):
            delattr(os, name)
    for name in ("SIGHUP", "SIGCHLD", "SIGALRM"):
        delattr(signal, name)
    signal.signal = lambda number, handler, plain=signal.signal: plain(number, handler)
    sys.platform = "neither"
"""
"""What a process does at its start, and each of its children: it loses what Windows has not, as far as Python runs without."""

TABLE = "name,teeth,normal_module,face_width\na,20,2.0,10.0\nb,21,2.0,10.0\nc,22,2.0,10.0\n"


@pytest.mark.long
def test_batch_without_what_windows_has_not(tmp_path):
    """Processes are started by their command line everywhere, never by a fork: their files are the same."""
    (tmp_path / "sitecustomize.py").write_text(MISSING, encoding="utf-8")
    (tmp_path / "table.csv").write_text(TABLE, encoding="utf-8")
    results = {}
    for system in ("linux", "windows"):
        environment = os.environ | {"PYTHONPATH": os.pathsep.join([str(tmp_path), str(PACKAGE.parent)])}
        environment |= {"SIMULATED": system, "SOURCE_DATE_EPOCH": "1"}
        command = [sys.executable, "-m", "gearcad", "batch", "table.csv", "--jobs", "2", "-o", system]
        run = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, encoding="utf-8", check=False)
        assert run.returncode == 0, run.stderr
        folder = tmp_path / system
        results[system] = {
            str(file.relative_to(folder)): file.read_bytes()
            for file in folder.rglob("*")
            if file.is_file() and file.name not in ("results.csv", "results.parquet", "manifest.json")
        }
        assert all((folder / name).is_dir() for name in "abc")
    assert results["linux"] == results["windows"]
    assert any(name.endswith(".step") for name in results["linux"])
