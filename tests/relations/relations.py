"""Metamorphic relations: pairs of scenes whose pictures, meshes, voxels or numbers must agree.

A relation changes a scene in a way whose effect is known. No reference picture is needed. Scenes are
drawn from a seed. Rules that keep false alarms away:
- coordinates are multiples of 1/64, motions are exact in double precision;
- the camera's point is offset by odd multiples of 2^-20, so that no sample lies exactly on a silhouette;
- a failing pair counts only if it also fails in 2 of 3 pictures whose camera is shifted by a part of a pixel.
A confirmed pair is shrunk: leaves of the tree are removed while the pair still fails. The report holds the
tree as SWC and both commands.

usage: relations.py CORCAST RELATION... [--pairs N] [--seed N]
Exit status 0 if all relations hold, 1 if one is broken.
"""
import argparse
import concurrent.futures
import contextlib
import dataclasses
import io
import itertools
import json
import math
import os
import random
import subprocess
import sys
import tempfile

import numpy

PRIMITIVES = ["cylinders", "rounded", "joined"]
MODELS = PRIMITIVES + ["blob", "isosurface", "mesh"]
BIT = 0.0
SIZE = 48          # pixels along a side of a picture
HEIGHT_MM = 16.0   # of a picture: 3 pixels per millimetre


@dataclasses.dataclass(frozen=True)
class Row:
    """A row of an SWC file."""
    id: int
    at: tuple
    radius: float
    parent: int


@dataclasses.dataclass(frozen=True)
class Scene:
    rows: tuple
    location: tuple
    look_at: tuple
    up: tuple
    options: tuple      # of the command, without camera and size
    height: float = HEIGHT_MM
    width_px: int = SIZE
    height_px: int = SIZE
    angle: float = 0    # degrees; 0: orthographic
    files: tuple = ()   # (name, text) of further files that options name

    def changed(self, **what):
        return dataclasses.replace(self, **what)

    def with_options(self, *more):
        return self.changed(options=self.options + more)


class Failure(Exception):
    """The program refused a scene."""


def swc(rows):
    return "".join(
        f"{r.id} 3 {r.at[0]!r} {r.at[1]!r} {r.at[2]!r} {r.radius!r} {r.parent}\n" for r in rows)


def command(scene):
    """The arguments of `corcast render` for a scene in the current folder, without -o."""
    triple = lambda v: ",".join(repr(x) for x in v)
    camera = ["--location", triple(scene.location), "--look-at", triple(scene.look_at), "--up", triple(scene.up)]
    camera += ["--projection", "perspective", "--angle", repr(scene.angle)] if scene.angle else ["--height", repr(scene.height)]
    # A look that does not change with the extent of the tree, as one that fades does.
    camera += [] if "--look" in scene.options else ["--look", os.path.join(GOLDEN, "red.ini")]
    return ["render", "t.swc", "--size", f"{scene.width_px}x{scene.height_px}", "--quiet", *camera, *scene.options]


def run(arguments, folder):
    done = subprocess.run([CORCAST, *arguments], cwd=folder, capture_output=True, text=True, timeout=60)
    if done.returncode:
        raise Failure(f"exit status {done.returncode}: {done.stderr.strip()}")
    return done.stdout


@contextlib.contextmanager
def folder_with(rows, files=()):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in (("t.swc", swc(rows)), *files):
            with open(os.path.join(folder, name), "w") as file:
                file.write(text)
        yield folder


def read_pfm(path):
    with open(path, "rb") as file:
        channels = 3 if file.readline().strip() == b"PF" else 1
        width, height = map(int, file.readline().split())
        scale = float(file.readline())
        values = numpy.frombuffer(file.read(), "<f4" if scale < 0 else ">f4")
    return values.reshape(height, width, channels)[::-1]


def read_ppm(path):
    with open(path, "rb") as file:
        data = file.read()
    fields = data.split(maxsplit=4)[:4]
    width, height = int(fields[1]), int(fields[2])
    return numpy.frombuffer(data[-3 * width * height:], "u1").reshape(height, width, 3)


def draw(scene):
    """The linear colors and the depths of a scene's pixels."""
    with folder_with(scene.rows, scene.files) as folder:
        run([*command(scene), "--planes", "depth", "-o", "p.pfm"], folder)
        return {"color": read_pfm(f"{folder}/p.pfm"), "depth": read_pfm(f"{folder}/p.depth.pfm")}


def draw_colors(scene):
    with folder_with(scene.rows, scene.files) as folder:
        run([*command(scene), "-o", "p.pfm"], folder)
        return {"color": read_pfm(f"{folder}/p.pfm")}


def draw_tiles(scene):
    """8-bit pixels of a picture that is joined from three tiles."""
    with folder_with(scene.rows) as folder:
        for i in (1, 2, 3):
            run([*command(scene), "--tile", f"{i}/3", "-o", f"p.tile-{i}.png"], folder)
        run(["merge", *(f"p.tile-{i}.png" for i in (1, 2, 3)), "-o", "p.png", "--quiet"], folder)
        run(["convert", "p.png", "p.ppm", "--quiet"], folder)
        return {"code": read_ppm(f"{folder}/p.ppm")}


def draw_codes(scene):
    with folder_with(scene.rows) as folder:
        run([*command(scene), "-o", "p.ppm"], folder)
        return {"code": read_ppm(f"{folder}/p.ppm")}


# ---- scenes --------------------------------------------------------------------------------------


def grid(rng, low, high):
    return rng.randint(round(low * 64), round(high * 64)) / 64


def random_tree(rng, radii=(0.25, 1.5), segments=(2, 7)):
    rows = [Row(1, (grid(rng, -4, 4), grid(rng, -4, 4), grid(rng, -4, 4)), grid(rng, *radii), -1)]
    for i in range(rng.randint(*segments)):
        parent = rng.choice(rows)
        step = [grid(rng, -4, 4) for _ in range(3)]
        if max(map(abs, step)) < 1:
            step[0] += 2.0
        at = tuple(a + b for a, b in zip(parent.at, step))
        rows.append(Row(2 + i, at, grid(rng, *radii), parent.id))
    return tuple(rows)


def path(*points, radius=0.75):
    return tuple(Row(i + 1, p, radius, i or -1) for i, p in enumerate(points))


def special_tree(rng):
    """Trees in special positions: end-on, touching, thin, thick, long, star, forest."""
    kind = rng.randrange(7)
    if kind == 0:
        return path((0.0, 0.0, -5.0), (0.0, 0.0, 5.0), (3.0, 0.0, 5.0))
    if kind == 1:
        return path((-4.0, 0.0, 0.0), (4.0, 0.0, 0.0)) + tuple(
            Row(r.id + 2, (r.at[0], r.at[1] + 1.5, r.at[2]), r.radius, r.parent + 2 if r.parent > 0 else -1)
            for r in path((-4.0, 0.0, 0.0), (4.0, 0.0, 0.0)))
    if kind == 2:
        return random_tree(rng, radii=(1 / 64, 8 / 64))
    if kind == 3:
        return path((-1.0, 0.0, 0.0), (1.0, 0.25, 0.0), radius=3.0)
    if kind == 4:
        return path((-60.0, -2.0, 1.0), (70.0, 3.0, -2.0))
    if kind == 5:
        return (Row(1, (0.0, 0.0, 0.0), 1.0, -1),) + tuple(
            Row(2 + i, (5 * x, 5 * y, 5 * z), 0.5, 1)
            for i, (x, y, z) in enumerate([(1.0, 0.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, -1.0, 0.5), (0.0, 0.25, 1.0)]))
    return random_tree(rng) + tuple(
        Row(r.id + 100, tuple(x + 3 for x in r.at), r.radius, r.parent + 100 if r.parent > 0 else -1)
        for r in random_tree(rng))


# Directions with integer components and an integer length, and an up vector at a right angle.
FRAMES = [((0, 0, -1), (0, 1, 0)), ((3, 0, -4), (0, 1, 0)), ((0, -4, -3), (0, 3, -4)), ((2, -1, -2), (1, 2, 0)), ((-6, 2, -3), (1, 3, 0))]


def random_scene(rng, model, options=(), tree=None, angle=None):
    rows = tree or (special_tree(rng) if rng.random() < 0.4 else random_tree(rng))
    direction, up = rng.choice(FRAMES)
    off = [(2 * rng.randrange(1 << 15) + 1) / (1 << 20) for _ in range(3)]
    look_at = tuple(off)
    distance = 8 if max(map(abs, direction)) > 1 else 24
    location = tuple(a - distance * d for a, d in zip(look_at, direction))
    if angle is None:
        angle = rng.choice([0, 0, 30])
    return Scene(rows, location, look_at, tuple(map(float, up)), ("--model", model, *options), angle=angle)


def map_points(scene, move, vector=None):
    """The scene with `move` applied to all points and `vector` (move without its offset) to `up`."""
    return scene.changed(
        rows=tuple(dataclasses.replace(r, at=move(r.at)) for r in scene.rows),
        location=move(scene.location), look_at=move(scene.look_at), up=(vector or (lambda v: v))(scene.up))


# ---- relations of pictures -----------------------------------------------------------------------


@dataclasses.dataclass(frozen=True)
class Pair:
    first: Scene
    second: Scene
    color: float = BIT           # largest difference of a linear color
    depth: float = BIT           # largest difference of a depth, mm
    pixels: int = 0              # pixels that may differ by more
    depth_scale: float = 1       # the second scene's depths are this many times those of the first
    flip: bool = False           # the second picture is the mirror image of the first
    rows: tuple = (0, None)      # first and end row of the second picture that the first one shows
    draw_first: object = draw
    draw_second: object = draw


# Ways of drawing: engines, light, effects, samples.
GOLDEN = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(__file__))), "golden")
WAYS = [(), ("--shadows", "on"), ("--ao", "8"), ("--look", os.path.join(GOLDEN, "point.ini"), "--shadows", "on"), ("--look", "journal"),
        ("--look", "depth"), ("--look", "xray"), ("--antialias", "1"), ("--exact",), ("--color-by", "radius"),
        ("--min-width", "1.5"), ("--method", "trace"), ("--method", "zbuffer")]
METHODS = {"trace": PRIMITIVES + ["blob"], "zbuffer": PRIMITIVES}


def way(rng, model, without=()):
    def usable(options):
        method = options[1] if options[:1] == ("--method",) else None
        return not set(options) & set(without) and (not method or model in METHODS[method])
    return rng.choice([w for w in WAYS if usable(w)])


def pair_threads(rng, model):
    scene = random_scene(rng, model, way(rng, model))
    return Pair(scene.with_options("--threads", "1"), scene.with_options("--threads", "3", "--memory", "0.05"))


def pair_tiles(rng, model):
    scene = random_scene(rng, model, way(rng, model))
    return Pair(scene, scene, draw_first=draw_codes, draw_second=draw_tiles)


def pair_planes(rng, model):
    scene = random_scene(rng, model, way(rng, model))
    return Pair(scene, scene, draw_first=draw_colors)


def pair_ids(rng, model):
    scene = random_scene(rng, model, way(rng, model))
    new = {r.id: 3 * r.id + 17 for r in scene.rows}
    new[-1] = -1
    return Pair(scene, scene.changed(
        rows=tuple(dataclasses.replace(r, id=new[r.id], parent=new[r.parent]) for r in scene.rows)))


def pair_rows(rng, model):
    """Rows in another order, parents first. Outlines appear where a depth passes a threshold, so looks with outlines are
    left out. Thin vessels that follow one another in the file add their areas up, so that a few pixels may differ."""
    tree = random_tree(rng) if model == "joined" else None  # of equal vessels, the first is the trunk of a joint
    scene = random_scene(rng, model, way(rng, model, without=["--ao", "journal"]), tree=tree)
    left, order, known = list(scene.rows), [], {-1}
    while left:
        row = rng.choice([r for r in left if r.parent in known])
        known.add(row.id)
        order.append(row)
        left.remove(row)
    limit = 0.02 if model == "mesh" else 1e-5  # of the tolerance of meshes
    return Pair(scene, scene.changed(rows=tuple(order)), color=limit, depth=limit, pixels=3)


def pair_scale(rng, model):
    scene = random_scene(rng, model, way(rng, model, without=["--shadows", "--exact"]))
    # POV-Ray's fixed lengths, which pictures repeat: nothing is seen within 1e-4 mm of the camera, and of blobs within
    # 0.01 mm. X-rays do not count what is thinner than that. Ambient occlusion has a tolerance of 1e-6 mm.
    lowest = {("blob", True): 0, ("blob", False): -8}.get((model, "xray" in scene.options), -4 if "xray" in scene.options else -11)
    by = 2.0 ** rng.choice([k for k in (lowest, -7, -1, 1, 5, 12) if k >= lowest])
    scaled = map_points(scene, lambda p: tuple(x * by for x in p)).changed(height=scene.height * by)
    scaled = scaled.changed(rows=tuple(dataclasses.replace(r, radius=r.radius * by) for r in scaled.rows))
    return Pair(scene, scaled, depth_scale=by)


def pair_translation(rng, model):
    scene = random_scene(rng, model, way(rng, model))
    by = tuple(float(rng.choice([-1, 1]) * 2 ** rng.randrange(4, 12)) for _ in range(3))
    limit = 1e-2 if model == "mesh" else 1e-6
    return Pair(scene, map_points(scene, lambda p: tuple(a + b for a, b in zip(p, by))), color=limit, depth=limit)


def pair_rotation(rng, model):
    scene = random_scene(rng, model, way(rng, model, without=["--ao", "zbuffer"]))
    turn = rng.choice([lambda p: (p[1], p[2], p[0]), lambda p: (-p[1], p[0], p[2]), lambda p: (p[0], -p[2], p[1])])
    return Pair(scene, map_points(scene, turn, turn), color=1e-5, depth=1e-5, pixels=1)


LOOK = """[vessel]
color = 0.62 0.31 0.09
[background]
color = 0.85 0.9 0.95
[finish]
ambient = 0.15
diffuse = 0.7
specular = 0.2
roughness = 0.05
"""
LIGHTS = ["[light {n}]\ndirection = {s}0.5 0.75 1\ncolor = 0.6 0.5 0.4\n", "[light {n}]\ndirection = {m}0.75 -0.25 0.5\ncolor = 0.2 0.25 0.3\n"]


def look(first, second, mirrored=False):
    signs = {"s": "-" if mirrored else "", "m": "" if mirrored else "-"}
    return ("l.ini", LOOK + LIGHTS[first].format(n="a", **signs) + LIGHTS[second].format(n="b", **signs))


def pair_mirror(rng, model):
    options = rng.choice([(), ("--shadows", "on"), ("--exact",)])
    scene = random_scene(rng, model, ("--look", "./l.ini", "--antialias", "1", *options))
    # The mirror image lies across the plane through the camera's axis and its up vector.
    flip = lambda p: (-p[0], p[1], p[2])
    mirrored = map_points(scene, flip, flip).changed(files=(look(0, 1, True),))
    return Pair(scene.changed(files=(look(0, 1),)), mirrored, color=1e-5, depth=1e-5, flip=True)


def pair_lights(rng, model):
    scene = random_scene(rng, model, ("--look", "./l.ini", *rng.choice([(), ("--shadows", "on")])))
    return Pair(scene.changed(files=(look(0, 1),)), scene.changed(files=(look(1, 0),)), color=1e-6)


def pair_split(rng, model):
    tree = random_tree(rng, radii=(0.5, 1), segments=(1, 4))
    if model == "joined":  # pieces must be longer than their joints
        tree = path((-8.0, 1.0, 0.5), (8.0, -2.0, 1.5))
    scene = random_scene(rng, model, way(rng, model, without=["--ao", "--color-by", "--method", "journal"]), tree=tree)
    at = {r.id: r.at for r in tree}
    row = rng.choice(tree[1:])
    middle = tuple((a + b) / 2 for a, b in zip(row.at, at[row.parent]))
    rows = []
    for r in tree:
        if r is row:
            rows.append(Row(1000, middle, r.radius, r.parent))
            r = dataclasses.replace(r, parent=1000)
        rows.append(r)
    return Pair(scene, scene.changed(rows=tuple(rows)), color=3e-4, depth=3e-4, pixels=0)


def pair_crop(rng, model):
    scene = random_scene(rng, model, way(rng, model, without=["--ao", "--look"]), angle=0)
    tall = scene.changed(height=2 * scene.height, height_px=2 * scene.height_px)
    return Pair(scene, tall, color=1e-5, depth=1e-6, rows=(SIZE // 2, SIZE // 2 + SIZE))


def pair_kernels(rng, model):
    scene = random_scene(rng, model, way(rng, model, without=["--exact"]))
    return Pair(scene, scene.with_options("--kernels", "portable"), color=1e-5, depth=1e-4)


def pair_outside(rng, model):
    """A vessel beside the frame, wide or thin, changes nothing in it."""
    scene = random_scene(rng, model, way(rng, model, without=["--ao", "--shadows", "--look", "--color-by"]), angle=0,
                         tree=rng.choice([None, random_tree(rng, radii=(1 / 64, 6 / 64))]))
    forward = [b - a for a, b in zip(scene.location, scene.look_at)]
    aside = numpy.cross(forward, scene.up)
    aside *= 128 / max(abs(aside))
    far = tuple(float(round(x)) for x in aside)
    radius = rng.choice([2.0, 1 / 16])
    rows = scene.rows + (Row(5001, far, radius, -1), Row(5002, (far[0] + 1, far[1] + 1, far[2] + 1), radius, 5001))
    return Pair(scene, scene.changed(rows=rows), color=1e-5, depth=1e-5)


def pair_behind(rng, model):
    """A vessel behind the camera changes nothing."""
    scene = random_scene(rng, model, way(rng, model, without=["--ao", "--shadows", "--look", "--color-by"]))
    behind = tuple(2 * a - b + (a - b) / 4 for a, b in zip(scene.location, scene.look_at))
    radius = rng.choice([1.0, 3 / 64])
    rows = scene.rows + (Row(5001, behind, radius, -1),
                         Row(5002, (behind[0] + 2, behind[1] + 3, behind[2] + 1), radius, 5001))
    return Pair(scene, scene.changed(rows=rows), color=1e-5, depth=1e-5)


# Relation -> models that it is tried with. What is missing is not promised: see METHODS.md.
PICTURES = {
    "threads": (pair_threads, MODELS), "tiles": (pair_tiles, MODELS), "planes": (pair_planes, MODELS),
    "ids": (pair_ids, MODELS), "rows": (pair_rows, MODELS), "scale": (pair_scale, MODELS),
    "translation": (pair_translation, MODELS), "rotation": (pair_rotation, MODELS[:-1]),
    "mirror": (pair_mirror, MODELS[:-1]), "lights": (pair_lights, MODELS), "split": (pair_split, MODELS[:-1]),
    "crop": (pair_crop, MODELS), "kernels": (pair_kernels, MODELS), "outside": (pair_outside, MODELS[:-1]),
    "behind": (pair_behind, MODELS[:-1]),
}


class Refused(Failure):
    """The first scene of a pair was refused, so that the pair tells nothing about its relation."""


def differences(pair):
    """Sentences about the planes that differ by more than the pair allows."""
    try:
        first = pair.draw_first(pair.first)
    except Failure as why:
        raise Refused(why) from why
    try:
        second = pair.draw_second(pair.second)
    except Failure as why:
        return [f"the second scene was refused ({why})"]
    said = []
    for name in first.keys() & second.keys():
        a, b = first[name].astype(float), second[name].astype(float)[slice(*pair.rows)]
        if pair.flip:
            b = b[:, ::-1]
        if name == "depth":
            b = b / pair.depth_scale
        with numpy.errstate(invalid="ignore"):
            off = numpy.where(a == b, 0, numpy.abs(a - b)).max(axis=2)
        limit = {"color": pair.color, "depth": pair.depth, "code": BIT}[name]
        many = int((~(off <= limit)).sum())
        if many > pair.pixels:
            said.append(f"{name}: {many} pixels differ by up to {off.max():.3g}, allowed {limit:g}")
    return said


def shifted(pair, k):
    """The pair with both cameras moved by an odd part of a pixel along their up vectors."""
    def move(scene, scale=1.0):
        part = scale * (2 * k + 1) / 1024 / max(map(abs, scene.up))
        step = [part * u for u in scene.up]
        return scene.changed(location=tuple(a + s for a, s in zip(scene.location, step)),
                             look_at=tuple(a + s for a, s in zip(scene.look_at, step)))
    return dataclasses.replace(pair, first=move(pair.first), second=move(pair.second, pair.depth_scale))


def confirmed(pair):
    return sum(fails(shifted(pair, k)) for k in (1, 5, 11)) >= 2


def without_leaf(pair):
    """Smaller pairs: one leaf that both trees have is gone."""
    ids = {r.parent for r in pair.first.rows} | {r.parent for r in pair.second.rows}
    shared = [r.id for r in pair.first.rows if r.id not in ids and any(s.id == r.id for s in pair.second.rows)]
    for leaf in shared:
        less = lambda scene: scene.changed(rows=tuple(r for r in scene.rows if r.id != leaf))
        yield dataclasses.replace(pair, first=less(pair.first), second=less(pair.second))


def fails(pair):
    try:
        return bool(differences(pair))
    except Refused:
        return False


def shrunk(pair):
    smaller = True
    while smaller:
        smaller = next((p for p in without_leaf(pair) if fails(p)), None)
        pair = smaller or pair
    return pair


def report(name, model, pair):
    pair = shrunk(pair)
    lines = [f"{name}, {model}: " + "; ".join(differences(pair))]
    for scene in (pair.first, pair.second):
        lines.append("  corcast " + " ".join(command(scene)))
        lines += ["    " + row for row in swc(scene.rows).splitlines()]
    return "\n".join(lines)


def check_pictures(name, pairs, seed):
    make, models = PICTURES[name]
    jobs = [(model, i) for i in range(pairs) for model in models]

    def one(job):
        model, i = job
        pair = make(random.Random(f"{seed} {name} {model} {i}"), model)
        try:
            return report(name, model, pair) if differences(pair) and confirmed(pair) else None
        except Refused as why:
            refused.append(f"{name}, {model}: no scene was drawn: {why}")
        return None

    refused = []
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        said = [one for one in pool.map(one, jobs) if one]
    # Overlapping vessels have no mesh, so that a few scenes may be refused.
    return said + (refused if len(refused) > len(jobs) / 4 else [])


# ---- relations of numbers, meshes, voxels and growth ---------------------------------------------


def moved_rows(rows, move=lambda p: p, radius=1.0):
    return tuple(dataclasses.replace(r, at=move(r.at), radius=r.radius * radius) for r in rows)


def near(a, b, relative):
    return math.isclose(a, b, rel_tol=relative, abs_tol=0)


def export(rows, *options, name="m.stl"):
    with folder_with(rows) as folder:
        run(["export", "t.swc", "--quiet", *options, "-o", name], folder)
        with open(os.path.join(folder, name), "rb") as file:
            return file.read()


def facets(stl):
    """The corners of the triangles of a binary STL file, as single-precision numbers."""
    kind = numpy.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")])
    return numpy.frombuffer(stl[84:], kind)["corners"]


def volume_of(stl):
    a, b, c = numpy.moveaxis(facets(stl).astype(float), 1, 0)
    return numpy.einsum("ij,ij->", a, numpy.cross(b, c)) / 6


def check_export(pairs, seed):
    said = []
    for i in range(max(1, pairs // 2)):
        rng = random.Random(f"{seed} export {i}")
        tree = random_tree(rng, radii=(0.5, 1.0), segments=(1, 4))
        for model in ("isosurface", "rounded"):
            options = ("--model", model)
            try:
                plain = export(tree, *options)
            except Failure:
                continue
            by = 2.0 ** rng.choice([-6, -1, 3])
            scaled = facets(export(moved_rows(tree, lambda p: tuple(x * by for x in p), by), *options))
            if not numpy.array_equal(facets(plain) * numpy.float32(by), scaled):
                said.append(f"export, {model}: the mesh of the tree times {by} is another\n{swc(tree)}")
            ids = tuple(dataclasses.replace(r, id=r.id + 40, parent=r.parent + 40 if r.parent > 0 else -1) for r in tree)
            if export(ids, *options)[84:] != plain[84:] or export(tree, *options, "--threads", "3")[84:] != plain[84:]:
                said.append(f"export, {model}: ids or threads change the mesh\n{swc(tree)}")
            for move in (lambda p: (-p[1], p[0], p[2]), lambda p: (-p[0], p[1], p[2]), lambda p: (p[0] + 256, p[1] - 256, p[2] - 4096)):
                other = export(moved_rows(tree, move), *options)
                if not near(volume_of(plain), volume_of(other), 2e-3):
                    said.append(f"export, {model}: volume {volume_of(plain)} becomes {volume_of(other)} by a motion\n{swc(tree)}")
    return said


def voxels(rows, side, *options):
    data = export(rows, "--spacing", repr(side), "--depth", "float", *options, name="v.nrrd")
    head, _, body = data.partition(b"\n\n")
    fields = dict(line.split(": ", 1) for line in head.decode().splitlines() if ": " in line)
    if fields["encoding"].startswith("gz"):
        import gzip
        body = gzip.decompress(body)
    return numpy.frombuffer(body, "<f4").reshape(tuple(map(int, fields["sizes"].split()))[::-1])


def check_voxels(pairs, seed):
    said = []
    for i in range(pairs):
        rng = random.Random(f"{seed} voxels {i}")
        tree = random_tree(rng, radii=(0.25, 1.0), segments=(1, 4))
        options = ()
        plain = voxels(tree, 0.5, *options)
        by = 2.0 ** rng.choice([-4, 3])
        if not numpy.array_equal(plain, voxels(moved_rows(tree, lambda p: tuple(x * by for x in p), by), 0.5 * by, *options)):
            said.append(f"voxels, {options}: the tree times {by} fills others\n{swc(tree)}")
        ids = tuple(dataclasses.replace(r, id=r.id + 40, parent=r.parent + 40 if r.parent > 0 else -1) for r in tree)
        if not numpy.array_equal(plain, voxels(ids, 0.5, *options)):
            said.append(f"voxels, {options}: ids change them\n{swc(tree)}")
        there = voxels(moved_rows(tree, lambda p: (p[0] + 8, p[1] - 64, p[2] + 16)), 0.5, *options)
        if plain.shape != there.shape or not numpy.allclose(plain, there, rtol=0, atol=1e-6):
            said.append(f"voxels, {options}: a translation by whole voxels changes them\n{swc(tree)}")
        turned = voxels(moved_rows(tree, lambda p: (-p[1], p[0], p[2])), 0.5, *options)
        if not near(float(plain.sum()), float(turned.sum()), 3e-3):  # radii are half a voxel and more
            said.append(f"voxels, {options}: the sum {plain.sum()} becomes {turned.sum()} by a turn\n{swc(tree)}")
    return said


def info(rows):
    with folder_with(rows) as folder:
        return json.loads(run(["info", "t.swc", "--json"], folder))


def check_info(pairs, seed):
    said = []
    for i in range(2 * pairs):
        rng = random.Random(f"{seed} info {i}")
        tree = random_tree(rng)
        plain = info(tree)
        for move in (lambda p: (-p[1], p[0], p[2]), lambda p: (p[0], p[1], -p[2]), lambda p: (p[0] + 1024, p[1] - 512, p[2])):
            other = info(moved_rows(tree, move))
            for key in ("segments", "terminals", "bifurcations", "total_length_mm", "volume_mm3"):
                if not near(plain[key], other[key], 2e-15 * len(tree)):
                    said.append(f"info: {key} {plain[key]} becomes {other[key]} by a motion\n{swc(tree)}")
    return said


def check_diagram(pairs, seed):
    def picture(rows):
        with folder_with(rows) as folder:
            run(["diagram", "t.swc", "--quiet", "-o", "d.svg"], folder)
            with open(f"{folder}/d.svg") as file:
                return file.read()

    said = []
    for i in range(2 * pairs):
        tree = random_tree(random.Random(f"{seed} diagram {i}"))
        plain = picture(tree)
        for move in (lambda p: (-p[1], p[0], p[2]), lambda p: (-p[0], p[1], p[2]), lambda p: (p[0] + 1024, p[1] - 512, p[2])):
            if picture(moved_rows(tree, move)) != plain:
                said.append(f"diagram: a motion changes it\n{swc(tree)}")
    return said


def grown(*options):
    with tempfile.TemporaryDirectory() as folder:
        run(["grow", "--quiet", *options, "-o", "t.swc"], folder)
        with open(f"{folder}/t.swc") as file:
            lines = [line.split() for line in file if not line.startswith("#")]
        return [(int(f[0]), int(f[6]), *map(float, f[2:6])) for f in lines]


def check_grow(pairs, seed):
    said = []
    cases = itertools.product(["ball:{}", "disc:{}", "ellipsoid:{},{},{}"], [(), ("--gamma", "2.7"), ("--lambda", "1.5")])
    for number, (domain, more) in enumerate(itertools.islice(cases, 9)):
        k = [-3, 3, 7][number % 3]
        sizes = [16.0, 24.0, 20.0]
        options = ["--terminals", "40", "--seed", str(seed + number), *more]
        first = grown("--domain", domain.format(*sizes), "--q-perf", "64", *options)
        second = grown("--domain", domain.format(*(s * 2.0**k for s in sizes)), "--q-perf", repr(64 * 2.0**(3 * k)), *options)
        if [r[:2] for r in first] != [r[:2] for r in second]:
            said.append(f"grow {domain} {more}: the topology of the domain times 2^{k} is another")
        elif any(abs(x * 2.0**k - y) > 1e-11 * 24 * 2.0**k for a, b in zip(first, second) for x, y in zip(a[2:], b[2:])):
            said.append(f"grow {domain} {more}: positions in the domain times 2^{k} are others")
    return said


def check_certify(pairs, seed):
    def certified(rows, lam):
        with folder_with(rows) as folder:
            return json.loads(run(["certify", "t.swc", "--lambda", repr(lam), "--json", "--quiet"], folder))

    said = []
    for lam in (1.0, 2.0):
        rows = [Row(*r[:1], r[2:5], r[5], r[1]) for r in grown("--terminals", "12", "--domain", "ball:16", "--seed", str(seed))]
        plain = certified(rows, lam)
        for move, by in ((lambda p: (-p[1], p[0], p[2]), 1.0), (lambda p: (p[0], -p[1], p[2]), 1.0), (lambda p: tuple(4 * x for x in p), 4.0)):
            other = certified(moved_rows(rows, move, by), lam)
            for key in ("target", "bound", "best_geometry"):
                if not near(plain[key] * by ** (1 + lam), other[key], 1e-9):
                    said.append(f"certify, lambda {lam}: {key} {plain[key]} becomes {other[key]} by a motion and scale {by}")
    return said


OTHERS = {"export": check_export, "voxels": check_voxels, "info": check_info, "diagram": check_diagram, "grow": check_grow, "certify": check_certify}


def main():
    global CORCAST
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("corcast")
    parser.add_argument("relations", nargs="*", default=[*PICTURES, *OTHERS])
    parser.add_argument("--pairs", type=int, default=2, help="pairs for each relation and model")
    parser.add_argument("--seed", type=int, default=1)
    arguments = parser.parse_args()
    CORCAST = os.path.abspath(arguments.corcast)
    broken = 0
    for name in arguments.relations or [*PICTURES, *OTHERS]:
        if name in PICTURES:
            said = check_pictures(name, arguments.pairs, arguments.seed)
        else:
            said = OTHERS[name](arguments.pairs, arguments.seed)
        print(f"{name}: {len(said)} broken" if said else f"{name}: holds")
        print("\n".join(said[:3]))
        broken += len(said)
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
