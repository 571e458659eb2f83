"""The version of gearcad: what makes a file says which it was."""

__all__ = ["__version__"]

__version__ = "0.1.0"
