"""Torques over the angle of an inertia as a spec of a train names them: a CSV file, or two lists."""

from __future__ import annotations

import re
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from gearcad.core.errors import InputError, SpecError, format_number, shown
from gearcad.designs.design import Where
from gearcad.dynamics.trains.torque_excitation import TorqueCurve

_MOST_ROWS = 1_000_000
"""Greatest number of rows of a file."""


def read_torque(given: Any, where: Where, owner: str) -> TorqueCurve:
    """Return the curve of the key `file` of an excitation: the name of a CSV file, or a table with angle and torque.

    `owner` is the key as written in the spec. Raises SpecError.
    """
    try:
        if isinstance(given, Mapping):
            unknown = next((key for key in given if key not in ("angle", "torque")), None)
            if unknown is not None:
                raise SpecError(
                    f"{where(owner)}: {shown(f'{owner}.{unknown}')}: unknown key; permitted are angle, torque", owner
                )
            return TorqueCurve(angle=given.get("angle", ()), torque=given.get("torque", ()))
        if not isinstance(given, str) or not given.strip() or "\0" in given:
            permitted = 'must be a CSV file with an angle (deg) and a torque (N·m) in each row, as in file = "torque.csv"'
            raise SpecError(f"{where(owner)}: {shown(owner)} = {format_number(given)}: {permitted}", owner)
        angle, torque = _columns(Path(given), where, owner)
        return TorqueCurve(angle=angle, torque=torque)
    except InputError as error:
        unit = f" {error.unit}" if error.unit else ""
        told = f"{shown(owner)}: {error.parameter} = {format_number(error.value)}{unit}: {error.permitted}"
        raise SpecError(f"{where(owner)}: {told}", owner) from error


def _columns(path: Path, where: Where, owner: str) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Return the first two columns of a file of numbers, under a heading or none; lines that begin with # are comments.

    Columns are separated by commas, semicolons or tabs; beside semicolons and tabs a decimal comma may stand.
    """
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise SpecError(f"{where(owner)}: {shown(owner)}: {path}: cannot be read: {error}", owner) from error
    rows: list[tuple[float, float]] = []
    headed = False
    for number, line in enumerate(lines, 1):
        if not line.strip() or line.lstrip().startswith("#"):
            continue
        values = _numbers(line)
        if values is None and not rows and not headed:
            headed = True
            continue
        if values is None or len(rows) >= _MOST_ROWS:
            permitted = "must hold two numbers: an angle in deg and a torque in N·m" if values is None else "too many rows"
            raise SpecError(f"{where(owner)}: {path} line {number}: {shown(line.strip())}: {permitted}", owner)
        rows.append(values)
    return tuple(angle for angle, _ in rows), tuple(torque for _, torque in rows)


def _numbers(line: str) -> tuple[float, float] | None:
    """Return the first two numbers of a line, or None."""
    mark = next((mark for mark in ";\t" if mark in line), ",")
    cells = [each.strip() for each in re.split(mark, line)]
    cells = [each.replace(",", ".") for each in cells] if mark != "," else cells
    try:
        return float(cells[0]), float(cells[1])
    except (ValueError, IndexError):
        return None
