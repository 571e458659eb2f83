"""The check of solid bodies."""
