"""Exchange of designs with other programs: REXS, the open XML format of FVA for drives (version 1.6).

Facts taken from its published database (fva-net/rexs-api-java, Apache License 2.0): types of components, attributes with their
units, relations with their roles. Lengths in mm, angles in degrees, as in specs; other units are changed where they differ.
"""
