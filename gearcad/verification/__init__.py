"""Verification: every claim about a design's files and figures judged by something that did not make it."""
