"""What makes a system vibrate: stiffness over the mesh, and deviations of teeth."""
