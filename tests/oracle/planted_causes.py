#!/usr/bin/env python3
"""Plants known faults in pictures and says which cause `compare` names: planted_causes.py CORCAST
[PICTURE.ppm ...]. Prints a table of Markdown; exit status 1 when a cause is named that was not
planted. scipy moves, blurs and turns; Pillow compresses and changes hues."""
import collections
import io
import json
import subprocess
import sys
import tempfile

import numpy as np
from PIL import Image, ImageEnhance
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


def mixed(codes, weight):
    """Nearer to the grey of the same luma: weight 1 is grey."""
    luma = (codes @ [0.299, 0.587, 0.114])[..., None]
    return codes + weight * (luma - codes)


def hue_turned(codes, degrees):
    """Turned about the grey axis."""
    angle = np.radians(degrees)
    c, s = np.cos(angle), np.sin(angle)
    third, root = (1 - c) / 3, s / np.sqrt(3)
    return codes @ np.array([[c + third, third + root, third - root], [third - root, c + third, third + root],
                             [third + root, third - root, c + third]])


def as_image(codes):
    return Image.fromarray(np.clip(np.rint(codes), 0, 255).astype(np.uint8))


def compressed(codes, quality, subsampling=2):
    file = io.BytesIO()
    as_image(codes).save(file, "JPEG", quality=quality, subsampling=subsampling)
    return np.asarray(Image.open(file)).astype(float)


def enhanced(codes, factor):
    """The saturation of Pillow."""
    return np.asarray(ImageEnhance.Color(as_image(codes)).enhance(factor)).astype(float)


def hue_of_hsv(codes, steps):
    """The hue of Pillow's HSV, in steps of 360 / 256 degrees."""
    h, s, v = as_image(codes).convert("HSV").split()
    return np.asarray(Image.merge("HSV", (h.point(lambda x: (x + steps) % 256), s, v)).convert("RGB")).astype(float)


def warped(codes, degrees=0, scale=1, at=(0.5, 0.5), order=3):
    """Turned clockwise and enlarged about a place, a fraction of the sides."""
    c, s = np.cos(np.radians(degrees)), np.sin(np.radians(degrees))
    matrix = np.array([[c, -s], [s, c]]) / scale
    middle = np.array([at[1] * (codes.shape[0] - 1), at[0] * (codes.shape[1] - 1)])
    return np.stack([ndimage.affine_transform(codes[:, :, k], matrix, middle - matrix @ middle, order=order, mode="nearest")
                     for k in range(3)], axis=2)


def cropped(codes, part):
    """A window of the picture, `part` of its sides, enlarged to its size by Pillow."""
    height, width = codes.shape[:2]
    left, top = int(0.3 * (1 - part) * width), int(0.8 * (1 - part) * height)
    box = (left, top, left + int(part * width), top + int(part * height))
    return np.asarray(as_image(codes).crop(box).resize((width, height), Image.BICUBIC)).astype(float)


def in_part(codes, made, rows, columns):
    """`made` in a part of the picture, whose sides are fractions of it, and `codes` elsewhere; `codes` alone where
    nothing is elsewhere that `made` changes, as then it is no fault of a part."""
    height, width = codes.shape[:2]
    y, x = slice(int(rows[0] * height), int(rows[1] * height)), slice(int(columns[0] * width), int(columns[1] * width))
    out = codes.copy()
    out[y, x] = np.clip(made, 0, 255)[y, x]
    return codes if (np.rint(out) == np.clip(np.rint(made), 0, 255)).all() else out


def recolored(codes, color):
    """Things of another color, as bright as before; the background as it was."""
    linear = light(codes)
    made = codes_of(linear.mean(axis=2, keepdims=True) * np.array(color))
    return np.where((codes == codes[0, 0]).all(axis=2)[..., None], codes, made)


def quantised(codes, step):
    return np.rint(codes / step) * step


def ramp(codes, axis):
    return np.indices(codes.shape)[axis] / codes.shape[axis]


MOVED, BLURRED, TONE, GAMMA = "moved", "blurred", "gain or offset", "gamma or encoding"
TURNED, CHANNELS, MISSING = "turned or mirrored", "channels", "one thing missing"
BACKGROUND, ROUNDING, NONE = "background", "rounding", "unknown"
CURVE, SHADING, COLORS = "some other curve", "shading", "other colors"
HUE, SATURATION, NOISE, JPEG = "hue", "saturation", "noise", "JPEG"
ROTATED, ZOOMED, CROPPED = "rotated", "zoomed", "cropped"
WORDS = [
    ("clockwise", ROTATED), ("cropped", CROPPED), ("enlarged", ZOOMED), ("reduced", ZOOMED),
    ("hues", HUE), ("saturation", SATURATION), ("JPEG", JPEG), ("with noise", NOISE),
    ("moved by", MOVED), ("blurred", BLURRED), ("power of", GAMMA), ("encoded", GAMMA),
    ("negative", GAMMA), ("made brighter", TONE), ("made darker", TONE), ("mirrored", TURNED),
    ("flipped", TURNED), ("rotated by", TURNED), ("exchanged", CHANNELS), ("channels in", CHANNELS),
    ("another tone curve", CURVE),
    ("only the background", BACKGROUND), ("only rounding", ROUNDING), ("an object", MISSING),
    ("only at outlines", "outlines"), ("highlights", "highlights"), ("shading", SHADING),
]
WHOLE, HALF = (0, 1), (0, 0.5)
# What is planted, and the answer that is right beside "unknown".
FAULTS = [
    ("moved by whole pixels", MOVED, lambda c: moved(c, 1, 0)), ("moved by whole pixels", MOVED, lambda c: moved(c, -3, 2)),
    ("moved by parts of pixels", MOVED, lambda c: moved(c, 0.5, 0)),
    ("moved by parts of pixels", MOVED, lambda c: moved(c, 0.1, -0.3, 3)),
    ("moved by parts of pixels", MOVED, lambda c: moved(c, 2.25, 1.75, 2)),
    ("blurred", BLURRED, lambda c: blurred(c, 0.5)), ("blurred", BLURRED, lambda c: blurred(c, 1)),
    ("blurred", BLURRED, lambda c: blurred(c, 2)), ("blurred in light", BLURRED, in_light(lambda l: blurred(l, 1))),
    ("light times a number", TONE, in_light(lambda l: 1.1 * l)), ("light times a number", TONE, in_light(lambda l: 0.8 * l)),
    ("codes times a number", TONE, lambda c: 0.95 * c), ("codes plus a number", TONE, lambda c: c + 6),
    ("codes plus a number", TONE, lambda c: c - 9),
    ("gamma", GAMMA, lambda c: 255 * (c / 255) ** 1.1), ("gamma", GAMMA, lambda c: 255 * (c / 255) ** 0.8),
    ("not encoded", GAMMA, lambda c: 255 * light(c)), ("encoded twice", GAMMA, lambda c: codes_of(c / 255)),
    ("encoded by 2.2", GAMMA, lambda c: 255 * light(c) ** (1 / 2.2)), ("negative", GAMMA, lambda c: 255 - c),
    ("upside down", TURNED, lambda c: c[::-1]), ("mirrored", TURNED, lambda c: c[:, ::-1]),
    ("turned by 180 degrees", TURNED, lambda c: c[::-1, ::-1]),
    ("red for blue", CHANNELS, lambda c: c[:, :, [2, 1, 0]]), ("channels turned", CHANNELS, lambda c: c[:, :, [1, 2, 0]]),
    ("green for blue", CHANNELS, lambda c: c[:, :, [0, 2, 1]]),
    ("one thing missing", MISSING, without_thing),
    ("another background", BACKGROUND, lambda c: with_background(c, (12, 40, 71))),
    ("a background slightly darker", BACKGROUND, lambda c: with_background(c, c[0, 0] - 3)),
    ("one code more here and there", ROUNDING, lambda c: c + (np.indices(c.shape).sum(axis=0) % 7 == 0)),
    ("light that falls off downwards", SHADING, in_light(lambda l: l * (1 - 0.3 * ramp(l, 0)))),
    ("light that falls off to the right", SHADING, in_light(lambda l: l * (1 - 0.3 * ramp(l, 1)))),
    ("the lower half darker", SHADING, in_light(lambda l: np.where(ramp(l, 0) > 0.5, 0.8 * l, l))),
    ("a curve", CURVE, lambda c: 255 * (0.9 * c / 255) ** 1.3), ("a sine", CURVE, lambda c: 255 * np.sin(c / 255 * 1.5)),
    # Other colors, which no sentence is about.
    ("desaturated a little", SATURATION, lambda c: mixed(c, 0.1)), ("desaturated a little", SATURATION, lambda c: mixed(c, 0.2)),
    ("desaturated", SATURATION, lambda c: mixed(c, 0.5)), ("grey", SATURATION, lambda c: mixed(c, 1)),
    ("saturated", SATURATION, lambda c: mixed(c, -0.3)), ("desaturated in light", SATURATION, in_light(lambda l: mixed(l, 0.3))),
    ("hue turned a little", HUE, lambda c: hue_turned(c, 5)), ("hue turned a little", HUE, lambda c: hue_turned(c, -12)),
    ("hue turned", HUE, lambda c: hue_turned(c, 40)), ("hue turned by half", HUE, lambda c: hue_turned(c, 180)),
    ("recolored", COLORS, lambda c: recolored(c, (0.3, 0.9, 1.6))),
    ("recolored nearly grey", COLORS, lambda c: recolored(c, (1, 1.03, 0.98))),
    ("warmer white", COLORS, lambda c: c * [1.04, 1, 0.9]),
    ("one channel brighter", COLORS, lambda c: c * [1.1, 1, 1]), ("one channel plus a number", COLORS, lambda c: c + [0, 0, 8]),
    ("one channel missing", COLORS, lambda c: c * [1, 1, 0]),
    # A part of the picture.
    ("left half moved", NONE, lambda c: in_part(c, moved(c, 2, 1), WHOLE, HALF)),
    ("right half moved", NONE, lambda c: in_part(c, moved(c, 0, 3), WHOLE, (0.5, 1))),
    ("upper half moved", NONE, lambda c: in_part(c, moved(c, -1, 0), HALF, WHOLE)),
    ("lower half moved by a part of a pixel", NONE, lambda c: in_part(c, moved(c, 0.5, 0.25, 3), (0.5, 1), WHOLE)),
    ("a quarter moved", NONE, lambda c: in_part(c, moved(c, 2, 2), (0.25, 0.75), (0.25, 0.75))),
    ("four fifths moved", NONE, lambda c: in_part(c, moved(c, 1, 1), (0, 0.8), WHOLE)),
    ("half blurred", NONE, lambda c: in_part(c, blurred(c, 1), WHOLE, HALF)),
    ("half desaturated", COLORS, lambda c: in_part(c, mixed(c, 0.4), HALF, WHOLE)),
    ("half of another gamma", NONE, lambda c: in_part(c, 255 * (c / 255) ** 1.2, HALF, WHOLE)),
    # Two faults at once.
    ("moved, and noise", NONE, lambda c: noisy(moved(c, 1, 0), 2, 3)), ("moved, and noise", NONE, lambda c: noisy(moved(c, 2, -1), 5, 4)),
    ("moved, and noise", NONE, lambda c: noisy(moved(c, 0.4, 0.3, 3), 3, 5)),
    ("moved, and much noise", NONE, lambda c: noisy(moved(c, 1, 2), 12, 6)),
    ("moved, and brighter", NONE, lambda c: 1.05 * moved(c, 1, 0)), ("moved, and darker", NONE, lambda c: 0.97 * moved(c, 2, 1)),
    ("moved, and darker", NONE, lambda c: moved(0.9 * c, 1.5, 0)), ("moved, and a number", NONE, lambda c: moved(c, 1, 1) - 4),
    ("moved, and a number", NONE, lambda c: 0.8 * moved(c, 2, 1) + 9),
    ("moved, and light times a number", NONE, in_light(lambda l: 1.1 * moved(l, 1, 0))),
    ("moved, and light times a number", NONE, in_light(lambda l: 0.95 * moved(l, 0.5, 0.5))),
    ("moved, and desaturated", NONE, lambda c: mixed(moved(c, 1, 0), 0.2)),
    ("moved, and upside down", NONE, lambda c: moved(c[::-1], 3, 1)), ("blurred and mirrored", NONE, lambda c: blurred(c, 1)[:, ::-1]),
    ("blurred, and darker", NONE, lambda c: 0.95 * blurred(c, 1)), ("blurred, and noise", NONE, lambda c: noisy(blurred(c, 1), 4, 7)),
    ("red for blue, and brighter", NONE, lambda c: 1.1 * c[:, :, [2, 1, 0]] - 12),
    # What no sentence is about.
    ("noise", NOISE, lambda c: noisy(c, 4, 1)), ("much noise", NOISE, lambda c: noisy(c, 30, 2)),
    ("turned by less than a degree", ROTATED, lambda c: ndimage.rotate(c, 0.7, reshape=False, order=3, mode="nearest")),
    ("rotated", ROTATED, lambda c: warped(c, 1)), ("rotated", ROTATED, lambda c: warped(c, -3, order=1)),
    ("rotated", ROTATED, lambda c: warped(c, 6)), ("rotated about a corner", ROTATED, lambda c: warped(c, 0.5, at=(0, 0))),
    ("scaled", ZOOMED, lambda c: ndimage.affine_transform(c, np.diag([1.01, 1.01, 1]), order=1, mode="nearest")),
    ("enlarged", ZOOMED, lambda c: warped(c, scale=1.03)), ("enlarged", ZOOMED, lambda c: warped(c, scale=1.15, order=1)),
    ("reduced", ZOOMED, lambda c: warped(c, scale=0.95)),
    ("cropped and enlarged", CROPPED, lambda c: cropped(c, 0.95)), ("cropped and enlarged", CROPPED, lambda c: cropped(c, 0.8)),
    ("rotated and enlarged", ROTATED, lambda c: warped(c, 2, 1.04)),
    ("JPEG", JPEG, lambda c: compressed(c, 90)), ("JPEG", JPEG, lambda c: compressed(c, 75)), ("JPEG", JPEG, lambda c: compressed(c, 40)),
    ("JPEG without subsampling", JPEG, lambda c: compressed(c, 85, 0)),
    ("saturation of Pillow", SATURATION, lambda c: enhanced(c, 0.6)), ("saturation of Pillow", SATURATION, lambda c: enhanced(c, 1.3)),
    ("hue of HSV", HUE, lambda c: hue_of_hsv(c, 20)), ("hue of HSV", HUE, lambda c: hue_of_hsv(c, -60)),
    ("little noise", NOISE, lambda c: noisy(c, 1.5, 8)),
    ("grey noise", NOISE, lambda c: c + np.random.default_rng(9).normal(0, 5, c.shape[:2])[..., None]),
    ("half rotated", NONE, lambda c: in_part(c, warped(c, 2), WHOLE, HALF)),
    ("half enlarged", NONE, lambda c: in_part(c, warped(c, scale=1.05), HALF, WHOLE)),
    ("half noisy", NONE, lambda c: in_part(c, noisy(c, 6, 10), WHOLE, HALF)),
    ("half another hue", NONE, lambda c: in_part(c, hue_turned(c, 30), WHOLE, HALF)),
    ("a quarter compressed", NONE, lambda c: in_part(c, compressed(c, 40), HALF, HALF)),
    ("rotated, and noise", NONE, lambda c: noisy(warped(c, 1), 6, 11)), ("rotated, and brighter", NONE, lambda c: 1.06 * warped(c, 1) - 3),
    ("enlarged, and another hue", NONE, lambda c: hue_turned(warped(c, scale=1.03), 25)),
    ("moved, and compressed", NONE, lambda c: compressed(moved(c, 2, 1), 60)),
    ("blurred, and compressed", NONE, lambda c: compressed(blurred(c, 1.2), 60)),
    ("another hue and saturation", COLORS, lambda c: mixed(hue_turned(c, 40), 0.4)),
    ("another hue, and noise", NONE, lambda c: noisy(hue_turned(c, 40), 5, 12)),
    ("sheared", NONE, lambda c: np.stack([ndimage.affine_transform(c[:, :, k], [[1, 0.03], [0, 1]], order=3, mode="nearest") for k in range(3)], axis=2)),
    ("a swirl", NONE, lambda c: np.stack([ndimage.map_coordinates(c[:, :, k], np.indices(c.shape[:2]) + 2 * np.sin(np.indices(c.shape[:2])[::-1] / 17),
                                                                  order=1, mode="nearest") for k in range(3)], axis=2)),
    ("noise that is blurred", NONE, lambda c: c + blurred(np.random.default_rng(13).normal(0, 20, c.shape), 1)),
    ("stripes", NONE, lambda c: c + 6 * np.sin(np.indices(c.shape)[1])),
    ("few levels", CURVE, lambda c: quantised(c, 17)),
    ("a ghost", NONE, lambda c: np.roll(c.reshape(-1), 3 * 41).reshape(c.shape) * 0.5 + c * 0.5),
]


def cause_of(corcast, a, b):
    """The cause that is named, and its kind."""
    made = subprocess.run([corcast, "compare", a, b, "--json", "--metrics", "off"], capture_output=True, check=False)
    cause = json.loads(made.stdout)["cause"] or ""
    return cause, next((kind for words, kind in WORDS if words in cause), NONE)


def main():
    corcast, named, wrong = sys.argv[1], collections.Counter(), []
    with tempfile.TemporaryDirectory() as folder:
        for path in sys.argv[2:]:
            codes, made = read(path), set()
            for planted, right, plant in FAULTS:
                write(folder + "/b.ppm", plant(codes))
                planted_codes = read(folder + "/b.ppm")
                # A fault that changes nothing, or no more than another that was planted: grey is not desaturated.
                if (planted_codes == codes).all() or planted_codes.tobytes() in made:
                    continue
                made.add(planted_codes.tobytes())
                cause, kind = cause_of(corcast, path, folder + "/b.ppm")
                named[planted, kind] += 1
                # Two sentences are true of other faults, too: that no value is off by more than 1, and that B is A
                # under some curve of tones, which a gain that clips and a gamma are.
                rounded = kind == ROUNDING and np.abs(planted_codes - codes).max() <= 1
                curved = kind == CURVE and right in (TONE, GAMMA)
                if kind not in (right, NONE) and not rounded and not curved:
                    wrong.append(f"{path}: {planted}: {cause}")
    columns = sorted({kind for _, kind in named}, key=lambda kind: (kind == NONE, kind))
    print("| planted | " + " | ".join(columns) + " |\n|---" + "|---" * len(columns) + "|")
    for planted in dict.fromkeys(planted for planted, _, _ in FAULTS):
        cells = [str(named[planted, kind] or "") for kind in columns]
        print(f"| {planted} | " + " | ".join(cells) + " |")
    kinds = len({planted for planted, _, _ in FAULTS})
    right = sum(n for (_, kind), n in named.items() if kind != NONE) - len(wrong)
    print(f"\n{kinds} kinds of faults, {sum(named.values())} pictures: {right} causes named rightly, {len(wrong)} wrongly")
    print("\n".join(wrong), file=sys.stderr)
    return 1 if wrong else 0


sys.exit(main())
