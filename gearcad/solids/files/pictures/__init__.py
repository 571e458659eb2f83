"""Pictures of scenes: which way one looks, what is cut away, how all turns, and the images (VTK off screen, Pillow)."""
