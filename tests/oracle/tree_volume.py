#!/usr/bin/python3
"""tree_volume.py T.swc SPACING: the volume, mm^3, of cylinders about the segments of a tree and balls of the largest
radius about its nodes, each point counted once: how much of them there is along lines parallel to z, SPACING mm apart.
Shares no code with corcast."""
import sys
import numpy

rows = [line.split() for line in open(sys.argv[1]) if line[0] != "#"]
place = {row[0]: numpy.array([float(x) for x in row[2:5]]) for row in rows}
segments = [(place[row[6]], place[row[0]], float(row[5]), row[6], row[0]) for row in rows if row[6] != "-1"]
ball = {}
for _, _, radius, start, end in segments:
    for node in start, end:
        ball[node] = max(ball.get(node, 0), radius)
spacing = float(sys.argv[2])
chords = []  # of each body: line (as a complex number, to tell lines apart), from, to


def lines_about(low, high):
    """The lines, x and y, through the lattice in a rectangle."""
    x, y = (numpy.arange(numpy.ceil(a / spacing), numpy.floor(b / spacing) + 1) for a, b in zip(low, high))
    return [axis.ravel() * spacing for axis in numpy.meshgrid(x, y)]


def keep(x, y, low, high):
    seen = low < high
    line = numpy.rint(x / spacing) * 1e7 + numpy.rint(y / spacing)
    chords.append(numpy.stack([line[seen], low[seen], high[seen]]))


for node, radius in ball.items():
    c = place[node]
    x, y = lines_about(c[:2] - radius, c[:2] + radius)
    half = numpy.sqrt(numpy.maximum(0, radius ** 2 - (x - c[0]) ** 2 - (y - c[1]) ** 2))
    keep(x, y, c[2] - half, c[2] + half)
for a, b, radius, _, _ in segments:
    length = numpy.linalg.norm(b - a)
    w = (b - a) / length
    x, y = lines_about(numpy.minimum(a, b)[:2] - radius, numpy.maximum(a, b)[:2] + radius)
    from_a = numpy.stack([x - a[0], y - a[1], 0 * x - a[2]])
    # |from + z e_z|^2 - ((from + z e_z) . w)^2 = radius^2, a square equation in z.
    along = w @ from_a
    square, half_linear = 1 - w[2] ** 2, from_a[2] - along * w[2]
    root = half_linear ** 2 - square * ((from_a ** 2).sum(0) - along ** 2 - radius ** 2)
    hit = root > 0
    root = numpy.sqrt(numpy.where(hit, root, 0))
    low, high = (-half_linear - root) / square, (-half_linear + root) / square
    if w[2] != 0:
        ends = numpy.stack([-along / w[2], (length - along) / w[2]])
        low, high = numpy.maximum(low, ends.min(0)), numpy.minimum(high, ends.max(0))
    else:
        hit &= (along >= 0) & (along <= length)
    keep(x[hit], y[hit], low[hit], high[hit])

line, low, high = numpy.concatenate(chords, axis=1)
order = numpy.lexsort((low, line))
line, low, high = line[order], low[order], high[order]
# How far each line is covered before each chord: the greatest end so far, lines being kept apart by an offset.
_, number = numpy.unique(line, return_inverse=True)
offset = number * 1e6
covered = numpy.maximum.accumulate(high + offset)
before = numpy.concatenate([[-numpy.inf], covered[:-1]]) - offset
print((numpy.maximum(0, high - numpy.maximum(low, before))).sum() * spacing ** 2)
