"""`python -m gearcad` is `gearcad`."""

from gearcad.cli import main

if __name__ == "__main__":
    main(prog_name="gearcad")
