#!/usr/bin/env python3
"""Checks a certificate of `corcast answer --certificate`; shares no code with corcast.

Pattern answers: the color of each sample is computed with 50 digits; the mean must lie in the
interval. Area answers: leaves must tile the pixel and sums must follow from the parts of leaves,
in exact fractions; at random points the parts must enclose the color of the ray through the point.

usage: check_answer.py C.json [POINTS_PER_PIXEL [SEED]]
"""
import json
import math
import random
import struct
import sys
from decimal import Decimal as D
from decimal import getcontext
from fractions import Fraction as F

getcontext().prec = 50
ROUNDING = F(1, 10**11)  # of areas and sums, far below any width of an interval

def dec(x):
    return D(x.numerator) / D(x.denominator) if isinstance(x, F) else D(x)

def vec(v):
    return [dec(x) for x in v]

def dot(a, b):
    return sum(x * y for x, y in zip(a, b))

def sub(a, b):
    return [x - y for x, y in zip(a, b)]

def along(a, b, t):
    return [x + t * y for x, y in zip(a, b)]

def scaled(a, t):
    return [x * t for x in a]

def unit(a):
    return scaled(a, 1 / dot(a, a).sqrt())

def power(x, n):
    return x**n if x > 0 else D(0)

# ---- rays ---------------------------------------------------------------------------------------

def enter_ball(solid, o, d):
    """Returns depth and outward normal where a ray of unit direction enters, or None."""
    q, b = sub(o, solid["a"]), dot(sub(o, solid["a"]), d)
    disc = b * b - dot(q, q) + solid["r"] ** 2
    if disc <= 0:
        return None
    t = -b - disc.sqrt()
    return t, scaled(along(q, d, t), 1 / solid["r"])

def enter_cylinder(solid, o, d):
    axis, q = solid["axis"], sub(o, solid["a"])
    da, qa = dot(d, axis), dot(q, axis)
    dx, qx = along(d, axis, -da), along(q, axis, -qa)
    a, b, c = dot(dx, dx), dot(qx, dx), dot(qx, qx) - solid["r"] ** 2
    if a > D(10) ** -40:
        disc = b * b - a * c
        if disc <= 0:
            return None
        t = (-b - disc.sqrt()) / a
        if 0 <= qa + t * da <= solid["length"]:
            return t, scaled(along(qx, dx, t), 1 / solid["r"])
    if abs(da) > D(10) ** -40:
        t = ((0 if da > 0 else solid["length"]) - qa) / da
        at = along(qx, dx, t)
        if dot(at, at) <= solid["r"] ** 2:
            return t, scaled(axis, -1 if da > 0 else 1)
    return None

def enter_ground(ground, o, d):
    """The normal is that of the side that faces the ray."""
    rate = dot(ground["normal"], d)
    if rate == 0:
        return None
    return (ground["offset"] - dot(ground["normal"], o)) / rate, scaled(ground["normal"], -1 if rate > 0 else 1)

def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]

def enter_triangle(solid, o, d):
    """Returns depth and interpolated normal, on the side that the ray comes from, or None."""
    a, u, v, flat, bounds, normals = solid["triangle"]
    if any(abs(float(dot(sub(o, m), w))) > size for m, w, size in bounds(d)):
        return None
    height, rate = dot(sub(a, o), flat), dot(d, flat)
    if rate == 0:
        return None
    at = sub(along(o, d, height / rate), a)
    area = dot(flat, flat)
    y, z = dot(flat, cross(at, v)) / area, dot(flat, cross(u, at)) / area
    if min(y, z, 1 - y - z) < 0:
        return None
    n = unit(along(along(scaled(normals[0], 1 - y - z), normals[1], y), normals[2], z))
    return height / rate, scaled(n, -1) if dot(n, d) > 0 else n

def triangle(shape):
    points, normals = [vec(p) for p in shape["points"]], [unit(vec(n)) for n in shape["normals"]]
    u, v = sub(points[1], points[0]), sub(points[2], points[0])
    flat, size = cross(u, v), 1.01 * float(max(dot(u, u), dot(v, v))) ** 0.5
    def bounds(d):  # two directions across the ray; a ray farther than `size` from a point misses
        w = unit(cross(d, [D(1), D(0), D(0)] if abs(d[0]) < D("0.9") else [D(0), D(1), D(0)]))
        return [(points[0], w, size)]
    return (points[0], u, v, flat, bounds, [unit(flat)] * 3 if shape["flat"] else normals)

LEVEL, TWO_BY_ROOT_PI = D(-2).exp(), 2 / D("3.14159265358979323846264338327950288419716939937510582").sqrt()

def erf(x):
    """Taylor's series; beyond 7 the function is 1 to 22 digits."""
    if abs(x) > 7:
        return D(1 if x > 0 else -1)
    term, total, n = x, D(0), 0
    while abs(term) > D(10) ** -45:
        total += term / (2 * n + 1)
        n += 1
        term = -term * x * x / n
    return TWO_BY_ROOT_PI * total

class Potential:
    """The isosurface. Crossings are searched in floats, at steps of 1/40 of a radius, and then
    computed with 50 digits. Rays that come within 1e-6 of the level without a crossing are unclear."""

    level = LEVEL

    def __init__(self, segments, groups):
        self.segments = segments
        self.groups = groups or [range(len(segments))]

    def term(self, i, x):
        """Returns the term of segment i, and its gradient, with 50 digits."""
        s = self.segments[i]
        k, q = D(2).sqrt() / s["r"], sub(x, s["a"])
        t = dot(q, s["axis"])
        across = along(q, s["axis"], -t)
        u, v, gauss = k * t, k * (s["length"] - t), (-k * k * dot(across, across)).exp()
        ends, slope = (erf(u) + erf(v)) / 2, TWO_BY_ROOT_PI / 2 * ((-u * u).exp() - (-v * v).exp())
        return gauss * ends, along(scaled(s["axis"], k * gauss * slope), across, -2 * k * k * gauss * ends)

    def prepared(self, o, d):
        """Returns the terms near a ray, as floats, and the interval in which each is near."""
        near = {}
        for i, s in enumerate(self.segments):
            q, axis = sub(o, s["a"]), s["axis"]
            t0, t1 = float(dot(q, axis)), float(dot(d, axis))
            a, b = along(q, axis, -dot(q, axis)), along(d, axis, -dot(d, axis))
            c = [float(dot(a, a)), float(dot(a, b)), float(dot(b, b))]
            r, length = float(s["r"]), float(s["length"])
            middle, half = -float(dot(q, d)), 5 * r + length
            if float(dot(q, q)) - middle**2 < half**2:
                near[i] = (c, t0, t1, length, r, middle - half, middle + half)
        return near

    def float_term(self, square, t, r, length):
        """Returns the term at the squared distance from the axis line, and t along the axis."""
        k = 2**0.5 / r
        return math.exp(-k * k * square) * (math.erf(k * t) + math.erf(k * (length - t))) / 2

    def float_sum(self, near, z):
        """Returns the largest sum of a group less the level, and the group."""
        value = {}
        for i, (c, t0, t1, length, r, first, last) in near.items():
            if first < z < last:
                value[i] = self.float_term(c[0] + z * (2 * c[1] + z * c[2]), t0 + t1 * z, r, length)
        sums = [(sum(value.get(i, 0) for i in group), n) for n, group in enumerate(self.groups)]
        best = max(sums)
        return best[0] - float(self.level), best[1]

    def enter_from_outside(self, o, d):
        """Returns depth, outward normal and the segment of the largest term, or None."""
        middle = -dot(sub(o, self.segments[0]["a"]), d)  # floats are accurate near the vessels
        hit = self.enter(along(o, d, middle), d, -math.inf, math.inf)
        return hit and (hit[0] + middle, *hit[1:])

    def enter(self, o, d, start, far):
        near = self.prepared(o, d)
        stretches = sorted((first, last, r) for *_, r, first, last in near.values())
        z, before, highest = start, -1, -1
        for first, last, r in stretches:
            z = max(z, first)
            while z < min(last, far):
                value, _ = self.float_sum(near, z)
                if value > 0 and before <= 0:
                    return self.refine(o, d, near, z - r / 40, z)
                highest, before, z = max(highest, value), value, z + r / 40
        if highest > -1e-6:
            raise ArithmeticError("unclear")
        return None

    def refine(self, o, d, near, low, high):
        for _ in range(30):
            z = (low + high) / 2
            low, high = (low, z) if self.float_sum(near, z)[0] > 0 else (z, high)
        group, z = self.groups[self.float_sum(near, high)[1]], D(high)
        for _ in range(3):
            terms = {i: self.term(i, along(o, d, z)) for i in group if i in near}
            gradient = [sum(g[k] for _, g in terms.values()) for k in range(3)]
            z -= (sum(v for v, _ in terms.values()) - self.level) / dot(gradient, d)
        return z, unit(scaled(gradient, -1)), max(terms, key=lambda i: terms[i][0])

class Blob(Potential):
    """The sum of the components of METHODS 2.6. A component is (radius, strength, offset): a tube if
    the offset is None, else a ball at each end, `offset` inside it; lengths are in radii."""

    level = D(1)
    components = [("1.1909", "2.8305643108357454", None), ("1.6382", "1.9152", None)]
    components += [(r, f"-{D(s) / 2}", "0") for r, s, _ in components]
    for h, r, s in ("0.0641", "1.0036", "2.2312"), ("0.2403", "1.4344", "0.6311"):
        components += [(r, s, h), (r, f"-{s}", f"-{h}")]

    def term(self, i, x):
        s = self.segments[i]
        q = sub(x, s["a"])
        t, value, gradient = dot(q, s["axis"]), D(0), [D(0)] * 3
        for radius, strength, offset in self.components:
            R, S = D(radius) * s["r"], D(strength)
            inset = offset and D(offset) * s["r"]
            for at in (inset, s["length"] - inset) if offset else (min(max(t, D(0)), s["length"]),):
                off = along(q, s["axis"], -at)
                inside = 1 - dot(off, off) / R**2
                if inside > 0:
                    value += S * inside**2
                    gradient = along(gradient, off, -4 * S * inside / R**2)
        return value, gradient

    def float_term(self, square, t, r, length):
        total = 0.0
        for radius, strength, offset in self.floats:
            inset = offset and offset * r
            for at in (min(max(t, 0), length),) if offset is None else (inset, length - inset):
                total += strength * max(1 - (square + (t - at) ** 2) / (radius * r) ** 2, 0) ** 2
        return total

    floats = [(float(r), float(s), h and float(h)) for r, s, h in components]

def joint(shape):
    """Returns the vectors of C_1 and C_2 - C_1, as in METHODS 7."""
    a, b = vec(shape["axis_a"]), vec(shape["axis_b"])
    other = b
    if math.sqrt(dot(cross(a, b), cross(a, b))) < 1e-12:
        other = vec([1, 0, 0] if abs(a[0]) < D("0.6") else [0, 1, 0])
    side = unit(cross(a, other))
    r, s = D(shape["radius"]), D(shape["radius_b"])
    first, last = scaled(cross(side, a), r), scaled(cross(side, b), s)
    c, e = vec(shape["a"]), vec(shape["b"])
    return c, first, scaled(side, r), sub(e, c), sub(last, first), scaled(side, s - r)

def joint_crossings(solid, o, d):
    """Returns depth and outward normal of the crossings. g is sampled in floats; it is a trigonometric
    polynomial. Crossings are then bisected with 50 digits."""
    c, first, side, span, first_change, side_change = solid["joint"]
    start = -dot(sub(o, c), d)
    q = sub(c, along(o, d, start))
    def ruling(x, half):
        u, v = half * (1 - x * x) / (1 + x * x), 2 * x / (1 + x * x)
        return along(along(q, first, u), side, v), along(along(span, first_change, u), side_change, v), u, v
    def g(x, half):
        at, run, _, _ = ruling(x, half)
        return dot(d, cross(at, run))
    rough = max(dot(q, q), dot(along(q, span, 1), along(q, span, 1))).sqrt() > 4 * solid["size"]
    found, places = [], [D(k) / 50 for k in range(-50, 51)]
    for half in (1, -1) if not rough else ():
        signs = [g(x, half) > 0 for x in places]
        for i in range(100):
            if signs[i] == signs[i + 1]:
                continue
            low, high = places[i], places[i + 1]
            for _ in range(110):
                x = (low + high) / 2
                low, high = (x, high) if (g(x, half) > 0) == signs[i] else (low, x)
            at, run, u, v = ruling(low, half)
            off, across = cross(d, at), cross(d, run)
            l = -dot(off, across) / dot(across, across)
            if 0 <= l <= 1:
                turn = along(scaled(along(side, side_change, l), u), along(first, first_change, l), -v)
                n = unit(cross(turn, run))
                found.append((dot(along(at, run, l), d) + start, n if dot(n, d) < 0 else scaled(n, -1)))
    return found

def enter(solid, o, d):
    if "joint" in solid:
        return min((hit for hit in joint_crossings(solid, o, d) if hit[0] > D(10) ** -20), default=None)
    if "field" in solid:
        hit = solid["field"].enter_from_outside(o, d)
        if hit:
            solid["color"] = solid["field"].segments[hit[2]]["color"]
        return hit and hit[:2]
    if "triangle" in solid:
        return enter_triangle(solid, o, d)
    if "normal" in solid:
        return enter_ground(solid, o, d)
    return enter_ball(solid, o, d) if solid["ball"] else enter_cylinder(solid, o, d)

def finish(f):
    """The exponent of Blinn's highlight is 1 / roughness in single precision."""
    sharpness = struct.unpack("f", struct.pack("f", 1 / f["roughness"]))[0]
    return vec([f[k] for k in ("ambient", "diffuse", "brilliance", "phong", "phong_size", "specular")] + [sharpness])

class Scene:
    def __init__(self, data):
        self.data, camera = data, data["camera"]
        self.solids, self.lights = data["shapes"], data["lights"]
        for s in self.solids:
            if s["kind"] == "joint":
                s["joint"], s["color"], s["finish"] = joint(s), vec(s["color"]), finish(data["finish"])
                s["size"] = D(s["radius"]) + D(s["radius_b"]) + dot(s["joint"][3], s["joint"][3]).sqrt()
                continue
            if s["kind"] == "triangle":
                s.update({"triangle": triangle(s), "color": vec(s["color"]), "finish": finish(data["finish"])})
                continue
            s["a"], s["b"], s["r"], s["color"] = vec(s["a"]), vec(s["b"]), D(s["radius"]), vec(s["color"])
            s["ball"] = s["kind"] == "sphere"
            span = sub(s["b"], s["a"])
            s["length"] = dot(span, span).sqrt()
            s["axis"] = scaled(span, 1 / s["length"]) if not s["ball"] else None
            s["finish"] = finish(data["finish"])
        fields = {"segment": Potential, "blob": Blob}
        if self.solids and self.solids[0]["kind"] in fields:
            field = fields[self.solids[0]["kind"]](self.solids, data["groups"])
            self.solids = [{"field": field, "finish": self.solids[0]["finish"]}]
        ground = data["ground"]
        if ground:
            ground = {"offset": D(ground["offset"]), "finish": finish(ground["finish"])} | {
                k: vec(ground[k]) for k in ("normal", "color")}
            self.solids.append(ground)
        for light in self.lights:
            light["location"], light["target"] = vec(light["location"]), vec(light["target"])
            light["color"] = vec(light["color"])
            light["shadows"] = data["shadows"] and light["casts_shadows"]
        self.least = -100 if any(min(light["color"]) < 0 for light in self.lights) else 0
        self.camera = {k: vec(camera[k]) for k in ("location", "right", "up", "direction")}
        self.size, self.perspective = (camera["width"], camera["height"]), camera["projection"] == "perspective"
        self.background = vec(data["background"])

    def ray(self, x, y):
        c, (w, h) = self.camera, self.size
        offset = along(scaled(c["right"], dec(F(x) / w - F(1, 2))), c["up"], dec(F(1, 2) - F(y) / h))
        if self.perspective:
            return c["location"], unit(along(c["direction"], offset, 1))
        return along(c["location"], offset, 1), unit(c["direction"])

    def shadowed(self, point, towards, distance, own):
        for s in self.solids:
            if "field" in s:
                if s["field"].enter(point, towards, 1e-3, min(float(distance), 1e3)):
                    return True
                continue
            hit = enter(s, point, towards) if s is not own or "joint" in s else None
            if hit and D(10) ** -25 < hit[0] < distance:
                return True
        return False

    def color(self, x, y):
        o, d = self.ray(x, y)
        first = None
        for s in self.solids:
            hit = enter(s, o, d)
            if hit and hit[0] > 0 and (first is None or hit[0] < first[1][0]):
                first = (s, hit)
        if first is None:
            return self.background
        solid, (t, n) = first
        point, pigment = along(o, d, t), solid["color"]
        ambient, diffuse, brilliance, phong, size, specular, sharpness = solid["finish"]
        color = scaled(pigment, ambient)
        for light in self.lights:
            to = sub(light["location"], light["target"] if light["parallel"] else point)
            length = dot(to, to).sqrt()
            to = unit(to)
            distance = dot(sub(light["location"], point), to) if light["parallel"] else length
            cosine = dot(n, to)
            if cosine <= 0 or (light["shadows"] and self.shadowed(point, to, distance, solid)):
                continue
            gloss = phong * power(dot(along(d, n, -2 * dot(d, n)), to), size)
            gloss += specular * power(dot(unit(sub(to, d)), n), sharpness)
            body = diffuse * power(cosine, brilliance)
            color = [c + l * (p * body + gloss) for c, l, p in zip(color, light["color"], pigment)]
        nearest, farthest, near, far = vec(self.data["fade"])
        part = min(max((t - near) / (far - near), D(0)), D(1)) if far > near else D(0)
        fade = 0 if "normal" in solid else nearest + (farthest - nearest) * part
        return [c + (b - c) * fade for c, b in zip(color, self.background)]


def inside(color, low, high):
    return all(D(a) - D("1e-14") <= c <= D(b) + D("1e-14") for a, c, b in zip(low, color, high))

def check_pattern(scene, n, pixel):
    (i, j) = pixel["pixel"]
    offsets = [F(2 * k + 1, 2 * n) - F(1, 2) for k in range(n)] if n > 1 else []
    places = [(F(0), F(0))] + [(x, y) for y in offsets for x in offsets]
    colors = [scene.color(i + F(1, 2) + x, j + F(1, 2) + y) for x, y in places]
    mean = [sum(c[k] for c in colors) / len(colors) for k in range(3)]
    return [] if inside(mean, pixel["low"], pixel["high"]) else ["the mean of its samples is outside"]

def moments(polygon):
    area = mx = my = F(0)
    for (ax, ay), (bx, by) in zip(polygon, polygon[1:] + polygon[:1]):
        cross = ax * by - bx * ay
        area, mx, my = area + cross / 2, mx + cross * (ax + bx) / 6, my + cross * (ay + by) / 6
    return (area, mx, my) if area >= 0 else (-area, -mx, -my)

def contains(polygon, x, y):
    sides = [(bx - ax) * (y - ay) - (by - ay) * (x - ax)
             for (ax, ay), (bx, by) in zip(polygon, polygon[1:] + polygon[:1])]
    return len(polygon) > 2 and (min(sides) >= 0 or max(sides) <= 0)

def exact(points):
    return [(F(x), F(y)) for x, y in points]

def read_leaf(leaf):
    leaf["polygon"] = exact(leaf["polygon"])
    for part in leaf["parts"]:
        if "form" in part:
            part["polygon"] = exact(part["polygon"])
    (ax, ay), (bx, by) = [map(F, leaf[k]) for k in ("along", "across")]
    leaf["scale"] = abs(ax * by - ay * bx)

def check_sums(leaf, least):
    """The leaf's bounds follow from its parts."""
    faults = []
    for c in range(3):
        low = high = F(0)
        for part in leaf["parts"]:
            if "form" in part:
                (k, x, y, e), (area, mx, my) = map(F, part["form"][c]), moments(part["polygon"])
                value = k * area + x * mx + y * my
                low += F(part["weight"]) * max(value - e * area, least * area)
                high += F(part["weight"]) * (value + e * area)
            else:
                low += F(part["area"]) * F(part["low"][c])
                high += F(part["area"]) * F(part["high"][c])
        if F(leaf["low"][c]) > low * leaf["scale"] + ROUNDING:
            faults.append("a leaf's lower bound is above its parts")
        # Colors are cut to the brightest of the scene, so a bound may be below its parts' sum.
        if F(leaf["high"][c]) < min(high * leaf["scale"] - ROUNDING, F(leaf["low"][c])):
            faults.append("a leaf's upper bound is below its parts")
    return faults

def check_point(scene, leaf, x, y):
    """The parts enclose the color at a point of the picture."""
    (ax, ay), (bx, by) = [map(F, leaf[k]) for k in ("along", "across")]
    dx, dy, det = x - F(leaf["at"][0]), y - F(leaf["at"][1]), ax * by - ay * bx
    ex, ey = (dx * by - dy * bx) / det, (ax * dy - ay * dx) / det
    low, high = [F(0)] * 3, [F(0)] * 3
    for part in leaf["parts"]:
        for c in range(3):
            if "form" in part and contains(part["polygon"], ex, ey):
                k, u, v, e = map(F, part["form"][c])
                low[c] += F(part["weight"]) * (k + u * ex + v * ey - e)
                high[c] += F(part["weight"]) * (k + u * ex + v * ey + e)
            elif "area" in part and part["area"] > 1e-6:
                low[c] += min(F(part["low"][c]), 0)  # the point may be in the strip or not
                high[c] += max(F(part["high"][c]), 0)
    color = scene.color(x, y)
    return inside(color, map(dec, low), map(dec, high))

def check_area(scene, pixel, points, rng):
    leaves, (i, j) = pixel["leaves"], pixel["pixel"]
    faults = []
    for leaf in leaves:
        read_leaf(leaf)
        faults += check_sums(leaf, scene.least)
    if abs(sum(moments(leaf["polygon"])[0] * leaf["scale"] for leaf in leaves) - 1) > ROUNDING:
        faults.append("its leaves do not have its area")
    for c in range(3):
        if F(pixel["low"][c]) > sum(F(leaf["low"][c]) for leaf in leaves) + ROUNDING:
            faults.append("its lower bound is above the sum of its leaves")
        if F(pixel["high"][c]) < sum(F(leaf["high"][c]) for leaf in leaves) - ROUNDING:
            faults.append("its upper bound is below the sum of its leaves")
    for _ in range(points):
        x, y = i + F(rng.random()), j + F(rng.random())
        homes = []
        for leaf in leaves:
            (ax, ay), (bx, by) = [map(F, leaf[k]) for k in ("along", "across")]
            dx, dy, det = x - F(leaf["at"][0]), y - F(leaf["at"][1]), ax * by - ay * bx
            if contains(leaf["polygon"], (dx * by - dy * bx) / det, (ax * dy - ay * dx) / det):
                homes.append(leaf)
        if len(homes) != 1:
            faults.append(f"{len(homes)} leaves contain one of its points")
        elif not check_point(scene, homes[0], x, y):
            faults.append("the color at a point is outside the parts of its leaf")
    return faults

def main():
    data = json.load(open(sys.argv[1]))
    points, rng = int((sys.argv + ["", ""])[2] or 8), random.Random(int((sys.argv + ["", ""])[3] or 1))
    assert all(light["samples"] == 1 for light in data["scene"]["lights"])
    scene, faults, n = Scene(data["scene"]), 0, data["pattern"]
    for pixel in data["pixels"]:
        try:
            found = check_pattern(scene, n, pixel) if n else check_area(scene, pixel, points, rng)
        except ArithmeticError as error:
            found = [str(error)]
        faults += bool(found)
        for fault in sorted(set(found)):
            print(f"pixel {pixel['pixel'][0]},{pixel['pixel'][1]}: {fault}")
    print(f"{len(data['pixels']) - faults} of {len(data['pixels'])} pixels proved")
    sys.exit(1 if faults else 0)

main()
