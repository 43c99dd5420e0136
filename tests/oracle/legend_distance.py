#!/usr/bin/python3
"""Prints which part of a picture's vessels has the color that the picture's own legend gives their values.

legend_distance.py PICTURE IDS VALUES LOW HIGH  with an id plane as PPM, a CSV of rows ID,VALUE, and the values at the
lower and the upper end of the legend's bar, which is linear and at the right of the tree. A pixel counts as that of
the legend if each of its codes is within 8 of the bar's. With LOW equal to HIGH, the legend is one swatch.
"""
import sys

import numpy
from PIL import Image

picture = numpy.asarray(Image.open(sys.argv[1]).convert("RGB")).astype(int)
ids = numpy.asarray(Image.open(sys.argv[2]).convert("RGB")).astype(int) @ (65536, 256, 1)
values = numpy.genfromtxt(sys.argv[3], delimiter=",")
low, high = map(float, sys.argv[4:])

# The bar is in the columns, right of all vessels, that have the most pixels that are not paper. The title is above it.
filled = (picture.min(axis=2) < 250) & (ids == 0)
filled[:, : numpy.flatnonzero((ids > 0).any(axis=0)).max() + 1] = False
column = filled.sum(axis=0).argmax() + 2
rows = numpy.flatnonzero(filled[:, column])
rows = rows[rows - numpy.arange(len(rows)) == rows[-1] - len(rows) + 1]
bar = picture[rows, column][::-1]

value_of = numpy.full(ids.max() + 1, numpy.nan)
value_of[values[:, 0].astype(int)] = values[:, 1]
shown = value_of[ids[ids > 0]]
place = (shown - low) / (high - low) if high > low else numpy.full(len(shown), 0.5)
expected = bar[numpy.clip((place * len(bar)).astype(int), 0, len(bar) - 1)]
near = numpy.abs(picture[ids > 0] - expected).max(axis=1) <= 8
print(f"{near.mean():.4f} of {len(near)}")
