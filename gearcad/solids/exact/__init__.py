"""The exact solid: Bezier surfaces and the topology made of them (OCP)."""
