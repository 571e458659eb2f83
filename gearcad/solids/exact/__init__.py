"""The exact solid: Bezier surfaces and the topology made of them, as plain data; of the CAD kernel (OCP) where asked for."""
