"""Where the page listens: a port that is found free is taken at once."""

from __future__ import annotations

import pytest

from gearcad.core.errors import ParameterError
from gearcad.page.server import LOCAL, _listening_socket


def test_who_looks_at_the_same_time_finds_another_port() -> None:
    with _listening_socket(LOCAL, None) as first, _listening_socket(LOCAL, None) as second:
        taken = first.getsockname()[1]
        assert taken != second.getsockname()[1]
        with pytest.raises(ParameterError, match=f"port = {taken}: must be free at {LOCAL}"):
            _listening_socket(LOCAL, taken)


@pytest.mark.parametrize("host", ["0.0.0.0", "::", ""])
def test_no_page_is_everywhere(host: str) -> None:
    with pytest.raises(ParameterError, match="one address"):
        _listening_socket(host, None)
