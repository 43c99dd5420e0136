#!/usr/bin/python3
"""prisms.py M.msh MANIFEST.json ENDS.csv WALL.stl: checks layers of prisms, alone or with the core filled by gmsh.

Reads gmsh's format 2.2, and computes Jacobians, volumes and shared faces by itself. WALL.stl is a text STL of named
parts of the same surface: each of its solids must be the outer faces of the cells under the same name.
"""
import csv
import json
import sys
from collections import Counter

import numpy as np

CORNERS = {2: 3, 3: 4, 4: 4, 6: 6}


def expect(what, is_so):
    if not is_so:
        sys.exit("prisms: " + what)


def section(lines, name):
    at = lines.index("$" + name) + 1
    rows = lines[at + 1:lines.index("$End" + name)]
    expect("number of " + name, len(rows) == int(lines[at]))
    return [row.split() for row in rows]


def faces(kind, c):
    """The faces of a cell, each as its nodes in order, counterclockwise when viewed from outside."""
    if kind == 4:
        return [(c[0], c[2], c[1]), (c[0], c[1], c[3]), (c[1], c[2], c[3]), (c[2], c[0], c[3])]
    return [(c[0], c[2], c[1]), (c[3], c[4], c[5]), (c[0], c[1], c[4], c[3]), (c[1], c[2], c[5], c[4]),
            (c[2], c[0], c[3], c[5])]


def turned(face):
    """The face from its lowest node on, in the same sense."""
    at = face.index(min(face))
    return tuple(face[at:]) + tuple(face[:at])


def prism_volumes(x):
    """Exact volumes, and the smallest Jacobian in 21 triangles across each prism. The Jacobian is linear over a
    triangle, and quadratic from one to the next: Simpson's rule is exact."""
    base, top = x[:, :3], x[:, 3:]
    rise = top - base

    def jacobians(w):
        t = (1 - w) * base + w * top
        normal = np.cross(t[:, 1] - t[:, 0], t[:, 2] - t[:, 0])
        return np.einsum("ij,ikj->ik", normal, rise)

    least = min(jacobians(w).min() for w in np.linspace(0, 1, 21))
    means = [jacobians(w).mean(axis=1) / 2 for w in (0, 0.5, 1)]
    return (means[0] + 4 * means[1] + means[2]) / 6, least


mesh, manifest, ends, solids = sys.argv[1:]
lines = open(mesh).read().split("\n")
points = {int(row[0]): [float(x) for x in row[1:]] for row in section(lines, "Nodes")}
names = {(int(row[0]), int(row[1])): row[2].strip('"') for row in section(lines, "PhysicalNames")}
cells = {}
for row in section(lines, "Elements"):
    row = [int(x) for x in row]
    cells.setdefault(row[1], []).append((row[3], row[4], tuple(row[-CORNERS[row[1]]:])))
manifest = json.load(open(manifest))
said = manifest["layers"]
expect("number of prisms", len(cells[6]) == said["prisms"])
volumes, least = prism_volumes(np.array([[points[i] for i in c] for _, _, c in cells[6]]))
expect("an inverted prism: %g" % least, least > 0)
expect("volume of the prisms", abs(volumes.sum() / said["volume_mm3"] - 1) < 1e-6)
expect("volume of both", abs((said["volume_mm3"] + said["core_volume_mm3"]) / manifest["volume_mm3"] - 1) < 1e-9)

# Each face of a cell belongs to one other cell, in the other sense, or is a named face, in the same sense.
count = Counter(turned(face) for kind in (4, 6) for _, _, c in cells.get(kind, []) for face in faces(kind, c))
expect("two cells on one side of a face", set(count.values()) == {1})
open_faces = {face for face in count if turned(face[::-1]) not in count}
named = {turned(c): names[2, group] for kind in (2, 3) for group, _, c in cells[kind] if group}
inner = [turned(c) for group, _, c in cells[2] if not group]
if 4 in cells:
    x = np.array([[points[i] for i in c] for _, _, c in cells[4]])
    sizes = np.einsum("ij,ij->i", x[:, 1] - x[:, 0], np.cross(x[:, 2] - x[:, 0], x[:, 3] - x[:, 0])) / 6
    expect("a tetrahedron that is inside out", sizes.min() > 0)
    expect("volume of the core", abs(sizes.sum() / said["core_volume_mm3"] - 1) < 1e-6)
    expect("names of volumes", (names[3, 1], names[3, 2]) == ("layers", "core"))
    expect("the outer faces are not the named ones", open_faces == set(named))
else:
    # The inner surface and the inner parts of the ends enclose the core.
    flat = [face for face, name in named.items() if len(face) == 3 and name != "wall"]
    expect("the outer faces are not the named and the inner ones",
           open_faces == (set(named) - set(flat)) | {turned(face[::-1]) for face in inner})
    edges = Counter((face[k], face[k - 2]) for face in inner + flat for k in range(3))
    expect("the core is not closed", all(edges[b, a] == n == 1 for (a, b), n in edges.items()))

# The wall and the ends are those of the surface that is exported alone.
x = {tuple(np.float32(v)): i for i, v in points.items()}
part, corners, total = None, [], 0
ends = {row["name"]: row for row in csv.DictReader(open(ends))}
for line in open(solids):
    word = line.split()
    if word[0] == "solid":
        part = word[1]
    elif word[0] == "vertex":
        corners.append(x[tuple(np.float32([float(v) for v in word[1:]]))])
    elif word[0] == "endfacet":
        total += 1
        expect("a triangle of the wall", part != "wall" or named.pop(turned(corners), 0) == "wall")
        corners = []
expect("number of triangles", total == manifest["triangles"])
expect("a triangle of the wall that is not in the surface", "wall" not in named.values())
for name, end in ends.items():
    flat = np.zeros(3)
    for face in (face for face in named if named[face] == name):
        p = np.array([points[i] for i in face])
        flat += sum(np.cross(p[k] - p[0], p[k + 1] - p[0]) for k in range(1, len(face) - 1)) / 2
    expect("area of " + name, abs(np.linalg.norm(flat) / float(end["area_mm2"]) - 1) < 1e-5)
print(len(cells[6]), "prisms,", len(cells.get(4, [])), "tetrahedra, smallest Jacobian", least)
