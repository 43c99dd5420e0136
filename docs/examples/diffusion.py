"""Stationary diffusion from the inlet to the outlets of a tree, on tetrahedra between the named ends of `corcast export`:
the least that a solver does with them, in linear finite elements.

    diffusion.py NAME

reads NAME.ends.csv, and NAME.1.node and NAME.1.ele of TetGen; holds the concentration at 1 on inlets and at 0 on outlets,
prints what flows through each end, and writes NAME-cut.pov: the tetrahedra behind the plane z = 0, colored by it.
"""
import csv
import sys

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve

name = sys.argv[1]
points = np.loadtxt(name + ".1.node", skiprows=1)[:, 1:4]
tetrahedra = np.loadtxt(name + ".1.ele", skiprows=1, dtype=int)[:, 1:5] - 1
ends = list(csv.DictReader(open(name + ".ends.csv")))


def nodes_of(end):
    """The nodes on the disc of an end: on its plane, within its circle."""
    center, normal = (np.array([float(end[key]) for key in keys])
                      for keys in (("x_mm", "y_mm", "z_mm"), ("normal_x", "normal_y", "normal_z")))
    away, radius = points - center, float(end["radius_mm"])
    return np.flatnonzero((abs(away @ normal) < 1e-4) & ((away**2).sum(axis=1) < (1.001 * radius)**2))


# What each tetrahedron adds to the matrix: its volume times the products of its corners' gradients.
edges = points[tetrahedra[:, 1:]] - points[tetrahedra[:, :1]]
volumes = np.linalg.det(edges) / 6
gradients = np.linalg.inv(edges).transpose(0, 2, 1)
gradients = np.concatenate([-gradients.sum(axis=1, keepdims=True), gradients], axis=1)
local = abs(volumes)[:, None, None] * (gradients @ gradients.transpose(0, 2, 1))
rows, columns = np.repeat(tetrahedra, 4, axis=1).ravel(), np.tile(tetrahedra, 4).ravel()
matrix = coo_matrix((local.ravel(), (rows, columns)), shape=(len(points),) * 2).tocsr()

value = np.zeros(len(points))
held = np.zeros(len(points), bool)
for end in ends:
    nodes = nodes_of(end)
    held[nodes], value[nodes] = True, end["name"].startswith("inlet")
free = ~held
value[free] = spsolve(matrix[free][:, free], -(matrix[free] @ value))
flow = matrix @ value
print(f"{len(tetrahedra)} tetrahedra, {abs(volumes).sum():.6g} mm^3")
for end in ends:
    print(f"{end['name']:12} flow {flow[nodes_of(end)].sum():+.5f}")
print(f"{'sum':12} flow {flow[held].sum():+.1e}")

# Faces that only one of the tetrahedra has whose middle is behind the plane: the cut, and the wall behind it.
behind = tetrahedra[points[tetrahedra].mean(axis=1)[:, 2] < 0]
faces = np.concatenate([np.delete(behind, k, axis=1) for k in range(4)])
_, first, times = np.unique(np.sort(faces), axis=0, return_index=True, return_counts=True)
faces = faces[first[times == 1]]
lines = np.unique(np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])), axis=0)


def vector(x):
    return "<%.6g,%.6g,%.6g>" % tuple(x)


warm, cold = np.array([0.7, 0.05, 0.03]), np.array([0.05, 0.12, 0.5])
low, high = points.min(axis=0), points.max(axis=0)
middle, height = (low + high) / 2, 1.04 * max(high[1] - low[1], 0.75 * (high[0] - low[0]))
with open(name + "-cut.pov", "w") as out:
    print(f"""#version 3.7;
global_settings {{ assumed_gamma 1 }}
#default {{ finish {{ ambient 0.5 diffuse 0.6 }} }}
background {{ rgb 1 }}
camera {{ orthographic location {vector(middle + [0, 0, 90])} direction -z right {-4 / 3 * height}*x up {height}*y }}
light_source {{ <30, 40, 100> rgb 0.9 parallel point_at 0 }}""", file=out)
    for face in faces:
        part = value[face].mean()
        color = part * warm + (1 - part) * cold
        print("triangle {", ",".join(map(vector, points[face])), "pigment { rgb", vector(color), "} }", file=out)
    for a, b in points[lines]:
        print("cylinder {", vector(a), ",", vector(b), f", {height / 2400} pigment {{ rgb 0.02 }} }}", file=out)
