"""The version of gearcad, which output files state.

A build, or an installation of a checkout, writes it to `_version.py`, from the tag of the repository.
"""

from importlib import import_module

__all__ = ["__version__"]

try:
    __version__: str = import_module("gearcad._version").__version__
except ModuleNotFoundError:
    __version__ = "0.2.0.dev0"  # a checkout that was never installed
