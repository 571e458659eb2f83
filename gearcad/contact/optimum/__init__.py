"""The flank modifications that serve best, sought among many variants of the same bodies."""
