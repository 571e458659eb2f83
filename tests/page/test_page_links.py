"""Links hold a design whole, and nothing that comes in one does harm."""

from __future__ import annotations

import base64
import zlib
from pathlib import Path

import pytest

from gearcad.core.errors import ParameterError
from gearcad.designs.reader import starter_text, starters
from gearcad.page.workbench import LARGEST_TEXT, LONGEST, linked_bench, pack, unpack

PAIR = starter_text("fzg-c")[1]


def _packed(content: bytes) -> str:
    return base64.urlsafe_b64encode(zlib.compress(content, 9)).decode().rstrip("=")


LONG = "".join(f"# {zlib.crc32(str(each).encode())}\n" for each in range(3000))
"""What no link can hold."""


def test_a_link_gives_the_text_back_to_its_last_comment() -> None:
    for name in starters():
        text = starter_text(name)[1]
        assert unpack(pack(name, text)) == (name, text)
    odd = "# ä→ '\"<script>\r\n\t[gear]\r\nteeth = 20"
    assert unpack(pack("Größe 2", odd)) == ("Größe 2", odd)


def test_a_text_that_no_address_holds_is_refused() -> None:
    with pytest.raises(ParameterError, match=f"{LONGEST} characters"):
        pack("long", LONG)


@pytest.mark.parametrize(
    "packed",
    [
        "",
        "x",
        "ä",
        "../../etc/passwd",
        "<script>",
        pack("a", PAIR)[:-3],
        pack("a", PAIR) + "AAAA",
        pack("a", PAIR) * 40,
        _packed(f"a\0{LONG}{PAIR}".encode()),
        _packed(b"no name"),
        _packed(b"a\0\xff"),
        _packed(b"a\0" + bytes(2 * LARGEST_TEXT)),
        _packed(b"a\0" + bytes(1 << 26)),
        _packed(b"../a\0" + PAIR.encode()),
        _packed(b"\0" + PAIR.encode()),
    ],
)
def test_what_is_no_link_is_refused(packed: str) -> None:
    with pytest.raises(ParameterError):
        unpack(packed)
    if packed:
        bench = linked_bench(packed, PAIR, "mine", Path())
        assert bench.text == PAIR and bench.fault is not None


def test_a_link_is_opened_and_what_is_wrong_with_its_design_told(tmp_path: Path) -> None:
    other = PAIR.replace('name = "fzg-c"', 'name = "linked"')
    assert linked_bench(pack("of-link", other), PAIR, "mine", tmp_path).design.name == "linked"
    assert linked_bench("", PAIR, "mine", tmp_path).text == PAIR
    outside = PAIR + '\n[drawing]\ntemplate = "/etc/passwd"\n'
    for wrong in (PAIR.replace("[wheel]", "[whell]"), "[", outside):
        bench = linked_bench(pack("of-link", wrong), PAIR, "mine", tmp_path)
        assert (bench.text, bench.design.name) == (wrong, "fzg-c")
        assert bench.fault is not None and bench.fault.line.startswith("of-link.toml")
