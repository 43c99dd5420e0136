#!/usr/bin/env python3
"""Counts the topology of a binary STL file, independently of corcast.

stl_topology.py FILE   prints "COMPONENTS GENUS TRIANGLES", or fails if an edge does not have two triangles, one in each
                       direction. Genus is the sum over all components, from Euler's formula.
"""
import struct
import sys


def find(parent, i):
    while parent.setdefault(i, i) != i:
        parent[i] = parent[parent[i]]
        i = parent[i]
    return i


def components(pairs):
    parent = {}
    for a, b in pairs:
        parent[find(parent, a)] = find(parent, b)
    return len({find(parent, i) for i in list(parent)})


def triangles_of(path):
    with open(path, "rb") as file:
        data = file.read()
    (n,) = struct.unpack_from("<I", data, 80)
    assert len(data) == 84 + 50 * n, "the file's length does not fit its number of triangles"
    for i in range(n):
        at = 84 + 50 * i + 12
        yield [data[at + 12 * k : at + 12 * k + 12] for k in range(3)]


def measure_stl(path):
    edges, points, n = set(), {}, 0
    for corners in triangles_of(path):
        a, b, c = [points.setdefault(corner, len(points)) for corner in corners]
        for edge in ((a, b), (b, c), (c, a)):
            if edge[0] == edge[1] or edge in edges:
                sys.exit(f"the edge {edge} occurs twice in one direction")
            edges.add(edge)
        n += 1
    lone = sum((b, a) not in edges for a, b in edges)
    if lone:
        sys.exit(f"{lone} edges have one triangle")
    parts = components(edges)
    euler = len(points) - len(edges) // 2 + n
    return parts, parts - euler // 2, n


if __name__ == "__main__":
    print(*measure_stl(sys.argv[1]))
