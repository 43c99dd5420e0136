"""A renderer with a planted fault, for tests of `corcast metamorph`.

usage: faulty_renderer.py FAULT CORCAST SCENE.swc PICTURE [OPTION...]

Draws the tree with `corcast render OPTION...`, with one fault:
  none       no fault
  tile       an 8 x 8 tile of the picture is lost
  depth      coordinates z are clamped to [-3, 3]
  tolerance  lengths below 2^-4 are rounded to 0
  children   the last two children of a node are swapped where their rows are not in the order of ids
  strip      a vessel whose row is the last root is drawn 12 mm in front of its place, if it is behind the camera
"""
import math
import subprocess
import sys

fault, corcast, scene, picture, *options = sys.argv[1:]
rows = [line.split() for line in open(scene)]


def vector(name):
    return [float(x) for x in options[options.index(name) + 1].split(",")]


if fault == "depth":
    for row in rows:
        row[4] = repr(max(-3.0, min(3.0, float(row[4]))))
if fault == "tolerance":
    for row in rows:
        row[2:5] = [repr(0.0 if abs(float(x)) < 1 / 16 else float(x)) for x in row[2:5]]
if fault == "children":
    pairs = [(a, b) for a in rows for b in rows if a[6] == b[6] != "-1" and int(a[0]) > int(b[0]) and rows.index(a) < rows.index(b)]
    for a, b in pairs[:1]:
        a[2:6], b[2:6] = b[2:6], a[2:6]
if fault == "strip":
    eye, target = vector("--location"), vector("--look-at")
    forward = [b - a for a, b in zip(eye, target)]
    for row in rows:
        depth = sum((float(x) - e) * f for x, e, f in zip(row[2:5], eye, forward))
        if depth < 0:
            row[2:5] = [repr(float(x) - 2 * depth * f / sum(g * g for g in forward)) for x, f in zip(row[2:5], forward)]
broken = scene + ".broken.swc"
with open(broken, "w") as file:
    file.writelines(" ".join(row) + "\n" for row in rows)
drawn = picture + ".ppm"
done = subprocess.run([corcast, "render", broken, *options, "-o", drawn, "--quiet"])
if done.returncode:
    sys.exit(done.returncode)
data = bytearray(open(drawn, "rb").read())
width, height = (int(x) for x in data.split(maxsplit=3)[1:3])
if fault == "tile":
    start = len(data) - 3 * width * height
    x, y = width * 3 // 8, 24
    for line in range(y, y + 8):
        at = start + 3 * (line * width + x)
        data[at:at + 24] = bytes([255]) * 24
with open(picture, "wb") as file:
    file.write(data)
