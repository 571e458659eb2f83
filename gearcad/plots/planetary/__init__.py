"""Pictures of planetary trains: how they are built, how they stand in mesh, how they turn, share, run and vibrate."""
