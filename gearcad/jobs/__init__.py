"""What gearcad does with a design, one module a verb."""
