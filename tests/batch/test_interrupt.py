"""Ctrl-C is not lost, even where it is pressed while Python throws an object away."""

import signal
import sys
from collections.abc import Iterator

import pytest

from gearcad.batch.pool import remembered_interrupt


class PressedAtItsEnd:
    """An object during whose end the user presses Ctrl-C."""

    def __del__(self) -> None:
        signal.raise_signal(signal.SIGINT)


@pytest.fixture(autouse=True)
def nobody_else_minds_it() -> Iterator[None]:
    kept = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, kept)


def test_interrupt_that_python_drops_is_raised_at_the_next_look(capfd: pytest.CaptureFixture[str]) -> None:
    hook = sys.unraisablehook
    with remembered_interrupt() as look:
        look()
        thrown_away = PressedAtItsEnd()
        del thrown_away
        with pytest.raises(KeyboardInterrupt):
            look()
    assert capfd.readouterr().err == ""
    assert signal.getsignal(signal.SIGINT) is signal.default_int_handler and sys.unraisablehook is hook


def test_interrupt_elsewhere_is_raised_at_once() -> None:
    with remembered_interrupt(), pytest.raises(KeyboardInterrupt):
        signal.raise_signal(signal.SIGINT)


def test_others_that_mind_it_are_left_alone() -> None:
    def handler(*_: object) -> None: ...

    signal.signal(signal.SIGINT, handler)
    with remembered_interrupt() as look:
        look()
        assert signal.getsignal(signal.SIGINT) is handler
