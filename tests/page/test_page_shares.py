"""Load shares that the page shows of planets."""

from __future__ import annotations

from dataclasses import replace

from gearcad.core.runtime import templates
from gearcad.designs.planetary_designs import PlanetaryDesign
from gearcad.designs.reader import read_spec
from gearcad.page.panels.views import shares_of


def test_only_trains_with_planets_have_shares() -> None:
    assert shares_of(read_spec(templates() / "spur.toml")) is None


def test_shares_are_those_of_the_job() -> None:
    found = shares_of(read_spec(templates() / "planetary-differential.toml"))
    assert found is not None
    assert len(found["shares"]) == 4
    assert found["factor"] == max(greatest for _, _, greatest in found["shares"]) > 1


def test_without_a_load_it_says_so() -> None:
    design = read_spec(templates() / "planetary-differential.toml")
    assert isinstance(design, PlanetaryDesign)
    found = shares_of(replace(design, load=None))
    assert found is not None
    assert not found["shares"]
    assert "load" in found["why_not"]
