"""What contact in the plane and of solid bodies have in common."""
