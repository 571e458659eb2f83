"""A design table of real variants: pairs of 12 to 60 teeth, helix angles of 0 to 30 degrees, shifts, three modules, bores."""

from __future__ import annotations

import random
from collections.abc import Iterator

from gearcad import SpecError
from gearcad.designs.reader import design_from_tables

HEADING = "name,normal_module,helix_angle,pinion.teeth,pinion.profile_shift,pinion.face_width,pinion.body.bore,"
HEADING += "wheel.teeth,wheel.profile_shift,wheel.face_width,wheel.body.bore"


def variants(count: int) -> list[str]:
    """The lines of a table with `count` pairs that can be made; the same ones each time."""
    chance = random.Random(1)
    rows: list[str] = []
    while len(rows) < count:
        pair, pinion, wheel = _draw(chance)
        try:
            tables = {"pair": pair, "pinion": pinion, "wheel": wheel}
            design_from_tables(tables, where=lambda _key: "", default_name="any")
        except SpecError:
            continue
        cells = [f"v{len(rows) + 1:04d}", *_values(pair, pinion, wheel)]
        rows.append(",".join(cells))
    return [HEADING, *rows]


def _draw(chance: random.Random) -> tuple[dict[str, float], ...]:
    module = chance.choice([1.5, 2.5, 4.0])
    pair = {"normal_module": module, "helix_angle": chance.choice([0.0, 10.0, 15.0, 20.0, 25.0, 30.0])}
    smaller = chance.randint(12, 40)
    teeth = (smaller, chance.randint(smaller, 60))
    shifts = (round(chance.uniform(0.3 if smaller < 17 else 0.0, 0.6), 2), round(chance.uniform(-0.3, 0.3), 2))
    gears = (
        {"teeth": z, "profile_shift": x, "face_width": 8 * module, "body.bore": round(0.4 * module * z, 1)}
        for z, x in zip(teeth, shifts, strict=True)
    )
    return (pair, *gears)


def _values(*tables: dict[str, float]) -> Iterator[str]:
    for table in tables:
        yield from map(str, table.values())
