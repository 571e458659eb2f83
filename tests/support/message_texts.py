"""Texts of the package that can reach a person, read from its code: f-strings as templates, with {} for each value."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

from gearcad.core.messages import is_english
from gearcad.core.runtime import PACKAGE


class MessageText(NamedTuple):
    """A template and the place of its code."""

    template: str
    module: str
    line: int


FILES_ONLY = (
    *("plots", "report", "drawing", "decks", "verification", "solids/files", "designs/spec_writers.py", "jobs/draw.py"),
    *("batch/study.py",),
)
"""Rooms and modules whose texts stand in files, not on the page or a terminal: of these, errors and notices only."""

_ERRORS = re.compile(r"\w*(Error|Notice)$")

_NOT_SAID = {
    *(
        "Symbol",
        "Words",
        "WordTable",
        "TypeVar",
        "cast",
        "ContextVar",
        "NamedTuple",
    ),  # tables that have words of their own; types
    *("click.option", "click.command", "click.argument", "click.version_option", "click.group"),  # texts of --help
    *("re.compile", "re.sub", "re.search", "re.fullmatch", "re.match", "re.split", "re.findall", "subprocess.Popen"),
    *("self._database.execute", "database.execute", "file.write", "path.write_text"),
}
"""Functions whose texts no person reads as messages."""

_TEXT_METHODS = (
    *("split", "splitlines", "startswith", "endswith", "removeprefix", "removesuffix", "find", "rfind", "partition"),
    *("props", "classes"),
)
"""Methods of texts that look for their argument or take it apart, and of elements of the page that name properties."""

_NOT_MESSAGES = re.compile(
    r"""^\s*<| => |\A\.replace\(|="\{\}"|&[a-z]+;|\Asandbox |default-src|charset=|HttpOnly|\Arole=|\Abold |\A(flat )?dense|"""
    r"""\A(SELECT|INSERT|UPDATE) |\A# |\A( {2})?gearcad |\A\x08|\A\$ |\A\w+( \| \w+)+\Z|"""
    r"""\A[\w{}]+ \([^)]*\)\Z|\A[a-zN] (mm|mod N)\Z|\A[a-zA-Z_]+ = [a-z ]+\Z"""
)
"""Markup, queries, styles, comments of files, commands, types, and headings of columns in CSV files."""

_NAMES = {
    *(
        "BSpline surface",
        "Open CASCADE",
        "KISSsoft 2017",
        "Brown & Sharpe",
        "m_n mm",
        "Traceback ",
        "pair.normal_module, pinion.teeth",
    ),
    *("NV (nitrocar.)", "GGG (ferr.)", "{} - gearcad"),
}
"""Names that are alike in all languages, and keys."""


_HELP_NAMES = {"_HELP", "_TURNING", "_FORMATS", "_SECOND", "_RATING", "help_text"}
_HELP = {"Print the document of {}.json and nothing else.", "Planetary sets in place of pairs; speed of the input."}
"""Variables with texts of --help, and such texts."""


@cache
def message_texts() -> tuple[MessageText, ...]:
    """Return the texts of all modules, in the order of the code."""
    return tuple(_all_texts())


def _all_texts() -> Iterator[MessageText]:
    for path in sorted(PACKAGE.rglob("*.py")):
        if path.stem != "messages":
            yield from texts_of(path)


def texts_of(path: Path) -> Iterator[MessageText]:
    """Yield the texts of a module."""
    module = path.relative_to(PACKAGE).as_posix()
    tree = ast.parse(path.read_text(encoding="utf-8"))
    parents = {child: node for node in ast.walk(tree) for child in ast.iter_child_nodes(node)}
    only_errors = module.startswith(FILES_ONLY)
    for node in ast.walk(tree):
        template = _template(node)
        if template is None or template in _HELP or not _has_words(template) or not _is_said(node, parents, only_errors):
            continue
        yield MessageText(template, module, node.lineno)  # type: ignore[attr-defined]


def _template(node: ast.AST) -> str | None:
    """Return the text of a string or f-string with {} in place of each value; None for other code."""
    if isinstance(node, ast.Constant) and isinstance(node.value, str):
        return _NAMED_HOLE.sub("{}", node.value)
    if isinstance(node, ast.JoinedStr):
        return "".join(str(each.value) if isinstance(each, ast.Constant) else "{}" for each in node.values)
    return None


_NAMED_HOLE = re.compile(r"\{[a-z_]*(?::[^{}\s]*)?\}")
_NAME = re.compile(r"[a-z_0-9.]+")


def _has_words(template: str) -> bool:
    """Return whether a text is more than a single word, names, markup or numbers."""
    tokens = template.replace("{}", "0").split()
    if all(_NAME.fullmatch(each) for each in tokens) and "_" in template and "{}" not in template:
        return False
    return " " in template and any(map(is_english, tokens)) and template not in _NAMES and not _NOT_MESSAGES.search(template)


def _is_said(node: ast.AST, parents: dict[ast.AST, ast.AST], only_errors: bool) -> bool:
    """Return whether a person can read this text: no docstring, part of an f-string, help of a command, or text to look for."""
    parent = parents[node]
    if isinstance(parent, ast.Expr | ast.JoinedStr | ast.Compare):
        return False
    if isinstance(parent, ast.FormattedValue) and parent.format_spec is node:
        return False
    if isinstance(parent, ast.Attribute) and parent.attr in _TEXT_METHODS:
        return False
    if isinstance(parent, ast.keyword) and parent.arg in ("help", "short_help", "epilog"):
        return False
    if isinstance(parent, ast.Dict) and any(
        _is_help(key) and value is node for key, value in zip(parent.keys, parent.values, strict=True)
    ):
        return False
    if isinstance(parent, ast.Call) and isinstance(parent.func, ast.Attribute) and parent.func.attr in _TEXT_METHODS:
        return False
    inside = False
    while node in parents:
        node = parents[node]
        if isinstance(node, ast.Call):
            called = _name(node.func)
            inside = inside or bool(_ERRORS.search(called))
            if called in _NOT_SAID:
                return False
        elif isinstance(node, ast.FunctionDef) and node.name in ("__repr__", "_repr_svg_", "_repr_html_"):
            return False
        elif isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") in _HELP_NAMES:
            return False
        elif isinstance(node, ast.Raise):
            inside = True
    return inside or not only_errors


def _name(function: ast.AST) -> str:
    """Return the name of what is called, with dots; that of its end if its begin is no name."""
    names: list[str] = []
    while isinstance(function, ast.Attribute):
        names.append(function.attr)
        function = function.value
    return ".".join(reversed([*names, function.id] if isinstance(function, ast.Name) else names))


def _is_help(key: ast.AST | None) -> bool:
    """Return whether a key of a mapping says that its value is the help of an option."""
    return isinstance(key, ast.Constant) and key.value == "help"
