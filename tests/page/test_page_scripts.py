"""Nothing that the page is made of takes a text for more than a text."""

from __future__ import annotations

import re

from gearcad.core.runtime import PACKAGE

_UNSAFE = re.compile(
    r"v-html|innerHTML|outerHTML|insertAdjacentHTML|document\.write|\beval\(|new Function|javascript:"
    r"|ui\.html|ui\.markdown|run_javascript|add_head_html|add_body_html|content_html"
)


def test_no_component_takes_a_text_for_html_or_script() -> None:
    sources = [path for path in (PACKAGE / "page").rglob("*") if path.suffix in (".py", ".js")]
    assert len(sources) > 30
    assert [path.name for path in sources if _UNSAFE.search(path.read_text(encoding="utf-8"))] == []
