#!/usr/bin/env python3
"""Plants known faults in pictures and says which cause `compare` names: planted_causes.py CORCAST
[PICTURE.ppm ...]. Prints a table of Markdown; exit status 1 when a cause is named that was not
planted. scipy moves, blurs and turns."""
import collections
import json
import subprocess
import sys
import tempfile

import numpy as np
from scipy import ndimage


def read(path):
    with open(path, "rb") as file:
        assert file.readline() == b"P6\n"
        line = file.readline()
        while line.startswith(b"#"):
            line = file.readline()
        width, height = map(int, line.split())
        assert int(file.readline()) == 255
        return np.frombuffer(file.read(), np.uint8).reshape(height, width, 3).astype(float)


def write(path, codes):
    codes = np.clip(np.rint(codes), 0, 255).astype(np.uint8)
    with open(path, "wb") as file:
        file.write(b"P6\n%d %d\n255\n" % (codes.shape[1], codes.shape[0]) + codes.tobytes())


def light(codes):
    x = codes / 255
    return np.where(x <= 0.04045, x / 12.92, ((x + 0.055) / 1.055) ** 2.4)


def codes_of(linear):
    x = np.clip(linear, 0, 1)
    return 255 * np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)


def moved(codes, dx, dy, order=1):
    """By splines of this order; what is at the edge comes in."""
    return ndimage.shift(codes, (dy, dx, 0), order=order, mode="nearest")


def blurred(codes, sigma):
    return ndimage.gaussian_filter(codes, (sigma, sigma, 0), mode="nearest")


def in_light(change):
    return lambda codes: codes_of(change(light(codes)))


def noisy(codes, sigma, seed):
    return codes + np.random.default_rng(seed).normal(0, sigma, codes.shape)


def largest_thing(codes):
    """The mask of a middling thing before the background."""
    names, n = ndimage.label((codes != codes[0, 0]).any(axis=2))
    sizes = ndimage.sum_labels(np.ones(names.shape), names, range(1, n + 1))
    return names == 1 + int(np.argsort(sizes)[len(sizes) // 2])


def without_thing(codes):
    made = codes.copy()
    made[largest_thing(codes)] = codes[0, 0]
    return made


def with_background(codes, color):
    made = codes.copy()
    made[(codes == codes[0, 0]).all(axis=2)] = color
    return made


MOVED, BLURRED, TONE, GAMMA = "moved", "blurred", "gain or offset", "gamma or encoding"
TURNED, CHANNELS, MISSING = "turned or mirrored", "channels", "one thing missing"
BACKGROUND, ROUNDING, NONE = "background", "rounding", "unknown"
CURVE, SHADING = "some other curve", "shading"
WORDS = [
    ("moved by", MOVED), ("blurred", BLURRED), ("power of", GAMMA), ("encoded", GAMMA),
    ("negative", GAMMA), ("made brighter", TONE), ("made darker", TONE), ("mirrored", TURNED),
    ("upside down", TURNED), ("turned by", TURNED), ("exchanged", CHANNELS), ("channels as", CHANNELS),
    ("some other curve", CURVE),
    ("only the background", BACKGROUND), ("only rounding", ROUNDING), ("one thing", MISSING),
    ("outlines differ", "outlines"), ("highlights", "highlights"), ("shading", SHADING),
]
FAULTS = [
    (MOVED, lambda c: moved(c, 1, 0)), (MOVED, lambda c: moved(c, -3, 2)),
    (MOVED, lambda c: moved(c, 0.5, 0)), (MOVED, lambda c: moved(c, 0.1, -0.3, 3)),
    (MOVED, lambda c: moved(c, 2.25, 1.75, 2)),
    (BLURRED, lambda c: blurred(c, 0.5)), (BLURRED, lambda c: blurred(c, 1)),
    (BLURRED, lambda c: blurred(c, 2)), (BLURRED, in_light(lambda l: blurred(l, 1))),
    (TONE, in_light(lambda l: 1.1 * l)), (TONE, in_light(lambda l: 0.8 * l)),
    (TONE, lambda c: 0.95 * c), (TONE, lambda c: c + 6), (TONE, lambda c: c - 9),
    (GAMMA, lambda c: 255 * (c / 255) ** 1.1), (GAMMA, lambda c: 255 * (c / 255) ** 0.8),
    (GAMMA, lambda c: 255 * light(c)), (GAMMA, lambda c: codes_of(c / 255)),
    (GAMMA, lambda c: 255 * light(c) ** (1 / 2.2)), (GAMMA, lambda c: 255 - c),
    (TURNED, lambda c: c[::-1]), (TURNED, lambda c: c[:, ::-1]), (TURNED, lambda c: c[::-1, ::-1]),
    (CHANNELS, lambda c: c[:, :, [2, 1, 0]]), (CHANNELS, lambda c: c[:, :, [1, 2, 0]]),
    (CHANNELS, lambda c: c[:, :, [0, 2, 1]]),
    (MISSING, without_thing),
    (BACKGROUND, lambda c: with_background(c, (12, 40, 71))),
    (BACKGROUND, lambda c: with_background(c, c[0, 0] - 3)),
    (ROUNDING, lambda c: c + (np.indices(c.shape).sum(axis=0) % 7 == 0)),
    (SHADING, in_light(lambda l: l * (1 - 0.3 * np.indices(l.shape)[1] / l.shape[1]))),
    (SHADING, in_light(lambda l: np.where(np.indices(l.shape)[0] > l.shape[0] // 2, 0.8 * l, l))),
    (CURVE, lambda c: 255 * (0.9 * c / 255) ** 1.3), (CURVE, lambda c: 255 * np.sin(c / 255 * 1.5)),
    # Two at once, and what no sentence is about.
    (NONE, lambda c: moved(0.9 * c, 1.5, 0)), (NONE, lambda c: blurred(c, 1)[:, ::-1]),
    (NONE, lambda c: 1.1 * c[:, :, [2, 1, 0]] - 12),
    (NONE, lambda c: 0.8 * moved(c, 2, 1) + 9), (NONE, lambda c: moved(c[::-1], 3, 1)),
    (NONE, lambda c: noisy(c, 4, 1)), (NONE, lambda c: noisy(c, 30, 2)),
    (NONE, lambda c: ndimage.rotate(c, 0.7, reshape=False, order=3, mode="nearest")),
    (NONE, lambda c: np.roll(c.reshape(-1), 3 * 41).reshape(c.shape) * 0.5 + c * 0.5),
]


def cause_of(corcast, a, b):
    made = subprocess.run([corcast, "compare", a, b, "--json"], capture_output=True, check=False)
    cause = json.loads(made.stdout)["cause"] or ""
    return cause, next((kind for words, kind in WORDS if words in cause), NONE)


def main():
    corcast, named, wrong = sys.argv[1], collections.Counter(), []
    with tempfile.TemporaryDirectory() as folder:
        for path in sys.argv[2:]:
            codes = read(path)
            for number, (planted, plant) in enumerate(FAULTS):
                write(folder + "/b.ppm", plant(codes))
                if (read(folder + "/b.ppm") == codes).all():
                    continue
                cause, kind = cause_of(corcast, path, folder + "/b.ppm")
                named[planted, kind] += 1
                if kind not in (planted, NONE):
                    wrong.append(f"{path}, fault {number}, {planted}: {cause}")
    columns = sorted({kind for _, kind in named}, key=lambda kind: (kind == NONE, kind))
    print("| planted | " + " | ".join(columns) + " |\n|---" + "|---" * len(columns) + "|")
    for planted in dict.fromkeys(kind for kind, _ in FAULTS):
        cells = [str(named[planted, kind] or "") for kind in columns]
        print(f"| {planted} | " + " | ".join(cells) + " |")
    print("\n".join(wrong), file=sys.stderr)
    return 1 if wrong else 0


sys.exit(main())
