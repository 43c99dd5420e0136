#!/usr/bin/env python3
"""Writes the middles of an answer's intervals as a PPM of 8 bits: the picture of a renderer without a
fault. Reads OpenEXR by itself, and shares no code with corcast.

usage: answer_picture.py A.exr P.ppm [srgb|2.2]
"""
import struct
import sys
import zlib


def read_header(data):
    """Returns the attributes of a file of one part, and the offset behind them."""
    at, attributes = 8, {}
    while data[at]:
        name, at = data[at : data.index(0, at)].decode(), data.index(0, at) + 1
        at = data.index(0, at) + 1  # the type
        size = struct.unpack_from("<i", data, at)[0]
        attributes[name] = data[at + 4 : at + 4 + size]
        at += 4 + size
    return attributes, at + 1


def channel_names(block):
    names, at = [], 0
    while block[at]:
        end = block.index(0, at)
        names.append(block[at:end].decode())
        assert struct.unpack_from("<i", block, end + 1)[0] in (0, 2)  # four bytes a value
        at = end + 17
    return names


def unzipped(block, size):
    """Undoes the compression ZIP: differences of bytes, of which the even ones come first."""
    if len(block) == size:
        return block
    raw = bytearray(zlib.decompress(block))
    for i in range(1, size):
        raw[i] = (raw[i - 1] + raw[i] - 128) & 255
    mixed = bytearray(size)
    mixed[0::2], mixed[1::2] = raw[: (size + 1) // 2], raw[(size + 1) // 2 :]
    return bytes(mixed)


def read(path):
    """Returns width, height, and for each channel its values by rows."""
    data = open(path, "rb").read()
    attributes, at = read_header(data)
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height, names = right - left + 1, bottom - top + 1, channel_names(attributes["channels"])
    assert attributes["compression"] in (b"\2", b"\3")
    lines = 16 if attributes["compression"] == b"\3" else 1
    planes = {name: [] for name in names}
    for chunk in range((height + lines - 1) // lines):
        offset = struct.unpack_from("<Q", data, at + 8 * chunk)[0]
        y, size = struct.unpack_from("<2i", data, offset)
        rows = min(lines, bottom + 1 - y)
        values = unzipped(data[offset + 8 : offset + 8 + size], rows * width * len(names) * 4)
        for row in range(rows):
            for k, name in enumerate(names):
                planes[name] += struct.unpack_from(f"<{width}f", values, ((row * len(names)) + k) * width * 4)
    return width, height, planes


def code(linear, curve):
    v = min(max(linear, 0.0), 1.0)
    if curve == "srgb":
        encoded = 12.92 * v if v <= 0.0031308 else 1.055 * v ** (1 / 2.4) - 0.055
    else:
        encoded = v ** (1 / float(curve))
    return int(255 * encoded + 0.5)


def main():
    width, height, planes = read(sys.argv[1])
    curve = (sys.argv + ["srgb"])[3]
    bounds = [(planes["lo." + c], planes["hi." + c]) for c in "RGB"]
    codes = bytes(code((low[i] + high[i]) / 2, curve) for i in range(width * height) for low, high in bounds)
    open(sys.argv[2], "wb").write(b"P6 %d %d 255\n" % (width, height) + codes)


main()
