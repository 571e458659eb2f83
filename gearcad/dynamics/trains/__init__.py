"""A train as one writes it down, and the system of equations it makes."""
