"""The page in a browser: what is typed is seen in the inputs, the data, the section and the bodies."""

from __future__ import annotations

from typing import Any


def test_teeth_are_followed_by_all_panels(lent: Any) -> None:
    outline = lent.page.get_attribute(".gear-section", "data-teeth")
    lent.give("pinion.teeth", "22")
    assert lent.page.get_attribute(".gear-section", "data-teeth") != outline
    lent.page.keyboard.press("Escape")
    lent.give("pinion.teeth", "21")
    assert lent.page.get_attribute(".gear-section", "data-teeth") == outline


def test_wrong_input_is_told_at_its_field_and_the_last_good_design_stays(tab: Any) -> None:
    before = tab.shown()
    tab.field("pinion.teeth").fill("2")
    tab.page.wait_for_selector('[data-key="pinion.teeth"] .fault')
    line = tab.page.inner_text('[data-key="pinion.teeth"] .fault')
    assert "pinion.teeth = 2: must be a whole number from 3 to 2000" in line
    outline = tab.page.get_attribute(".gear-section", "data-teeth")
    assert outline and tab.shown() == before
