"""What the manual is made with: extensions of Sphinx, and how what its pages show is run."""
