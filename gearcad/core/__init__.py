"""Core: errors, quantities, records, runtime and output, on which all other rooms stand."""
