"""Sheets for the workshop: gears as ISO 2203 draws them, with dimensions, gear data and title block. Lengths in mm of paper."""
