"""Figures of the first steps."""

from pathlib import Path

from gearcad import picture, read

PAIR = Path(__file__).parents[2] / "templates" / "reducer-21-43.toml"


def draw_pair(path: Path) -> None:
    picture(read(PAIR), path, size=(900, 600))


FIGURES = {"start-pair.png": draw_pair}
