#!/usr/bin/python3
"""Reads pictures of every form that other programs write, and what corcast writes, by two readers.

picture_formats.py CORCAST FORMAT[,FORMAT] [TREE PROFILE]  with FORMAT one of exr, tiff, pnm, png, lossy, written; works in
the current folder.
Prints a line for each file that is read otherwise than by its writer or by the second reader, or refused by
another sentence than expected, and a last line with the number of files tried.
"""
import os
import subprocess
import sys

import numpy
import tifffile
from PIL import Image, ImageCms

CORCAST = sys.argv[1]
W, H = 37, 21  # no multiple of tiles, of blocks of 4 or of bytes of bits
random = numpy.random.default_rng(2385)
tried = 0


def check(name, seen, expected, tolerance=0.0):
    """seen is an array, or the sentence of a refusal; expected an array, or a part of that sentence."""
    global tried
    tried += 1
    if isinstance(expected, str):
        if not (isinstance(seen, str) and expected in seen):
            print(f"{name}: expected a refusal that says '{expected}', got {seen if isinstance(seen, str) else 'a picture'}")
    elif isinstance(seen, str):
        print(f"{name}: {seen}")
    elif seen.shape != expected.shape:
        print(f"{name}: read as {seen.shape}, not {expected.shape}")
    else:
        worst = numpy.abs(seen.astype(float) - expected.astype(float)).max()
        if not worst <= tolerance:
            print(f"{name}: off by up to {worst}")


def run(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{command[0]}: {done.stderr.strip()}")


def deep(array):
    """Rows, columns, channels."""
    return array.reshape(array.shape[0], array.shape[1], -1)


def pfm(path):
    kind, size, scale, values = open(path, "rb").read().split(b"\n", 3)
    width, height = map(int, size.split())
    order = "<" if float(scale) < 0 else ">"
    return deep(numpy.frombuffer(values, order + "f4").reshape(height, width, 3 if kind == b"PF" else 1)[::-1])


def corcast(name, *options):
    """What corcast reads of a file: codes with alpha, or floats on a background, or the sentence of a refusal."""
    sentence = ""
    ways = [("read.tif", ("--compression", "none")), ("read.pfm", ("--background", "white"))]
    for out, more in ways[1:] if name.endswith((".exr", ".pfm")) else ways:
        if os.path.exists(out):
            os.remove(out)
        done = subprocess.run([CORCAST, "convert", name, out, "--quiet", *more], capture_output=True, text=True)
        if done.returncode == 0:
            return deep(tifffile.imread(out)) if out == "read.tif" else pfm(out)
        sentence = done.stderr.strip()
        if "holds floats" not in sentence:
            break
    return sentence


def on_white(values, alpha):
    """Floats that are multiplied by alpha, as corcast lays them on white."""
    values = numpy.repeat(values, 3 // values.shape[2], axis=2)
    return values + (1 - alpha)


def smooth():
    """Four channels with values of their own; all are halves, alpha from 0 to 1."""
    y, x = numpy.mgrid[0:H, 0:W]
    made = [0.2 * c + 0.1 * numpy.sin(x * (c + 1) / 5) + 0.05 * numpy.cos(y / 3) + 0.3 + 0.01 * random.random((H, W)) for c in range(4)]
    return numpy.stack([*made[:3], numpy.clip(made[3], 0, 1)], axis=2).astype(numpy.float16).astype(numpy.float32)


def codes(bits, channels):
    """Every code is there, so are runs of one."""
    made = random.integers(0, 1 << bits, (H, W, channels))
    made[5:9, 3:30] = made[5, 3]
    return made.astype(numpy.uint8 if bits <= 8 else numpy.uint16)


def write_tiff(name, array, **options):
    tifffile.imwrite(name, array, metadata=None, **options)


# ---- OpenEXR: written by OpenImageIO through OpenEXR's C++ library, read by both -----------------------------------

COMPRESSIONS = ["none", "rle", "zips", "zip", "piz", "pxr24", "b44", "b44a", "dwaa", "dwab"]


def exr():
    write_tiff("base.tif", smooth(), photometric="rgb", extrasamples=["assocalpha"])
    # Names as the file has them, and the channels of the base that they hold.
    layouts = {"Y": "R", "Y,A": "R,A", "R,G,B": "R,G,B", "R,G,B,A": "R,G,B,A", "X,Y,Z": "R,G,B", "Q": "B",
               "A,B,G,R,Z": "A,B,G,R,G"}
    types = {"half": ["half"], "float": ["float"], "mixed": ["float", "R=half", "Y=half", "A=half"]}
    files, writing = {}, ["oiiotool", "--nosoftwareattrib", "base.tif", "--chnames", "R,G,B,A", "--label", "base"]
    for names, source in layouts.items():
        writing += ["base", "--ch", source, "--chnames", names, "--label", "now"]
        for kind, depths in types.items():
            for compression in COMPRESSIONS:
                for storage in (["--scanline"], ["--tile", 16, 16]):
                    name = f"{names}-{kind}-{compression}{storage[0]}.exr"
                    rare = names in ("Q", "X,Y,Z", "Y,A") and compression not in ("none", "zip", "b44")
                    if rare or kind == "mixed" and (names in ("Y", "Q", "X,Y,Z") or compression.startswith("dwa")):
                        continue
                    files[name] = names
                    writing += ["now"]
                    for depth in depths:
                        writing += ["-d", depth]
                    writing += ["--compression", compression, *storage, "-o", name]
    run(*writing)
    reading = ["oiiotool", "--nosoftwareattrib"]
    for name in files:
        reading += [name, "-d", "float", "--compression", "none", "--scanline", "-o", name + ".tif"]
    run(*reading)
    for name, names in files.items():
        if "dwa" in name and not ("--scanline" in name and names == "Y"):  # OpenImageIO writes it by ZIP
            check(name, corcast(name), "is compressed by DWAA or DWAB")
            continue
        there = deep(tifffile.imread(name + ".tif"))
        order = names.split(",")
        if names.startswith("A,B"):
            order = ["R", "G", "B", "A", "Z"]  # as OpenImageIO puts them
        color = there[..., [order.index(c) for c in order if c not in "AZ" or names == "X,Y,Z"]]
        expected = on_white(color, there[..., [order.index("A")]]) if "A" in order else color
        check(name, corcast(name), expected, 1e-6)


def exr_kinds():
    """Integers, windows, layers, parts, levels, and what is refused."""
    base = smooth()
    write_tiff("base.tif", base, photometric="rgb", extrasamples=["assocalpha"])
    rgb = base[..., :3]
    writing = ["oiiotool", "--nosoftwareattrib", "base.tif", "--chnames", "R,G,B,A", "--ch", "R,G,B", "--label", "rgb"]
    for compression in COMPRESSIONS[:8]:
        writing += ["rgb", "--ch", "G", "--chnames", "id", "-d", "uint32", "--compression", compression, "-o", f"uint-{compression}.exr"]
    writing += ["rgb", "-d", "half", "-otex", "levels.exr", "rgb", "-d", "float", "-o", "plain.exr"]
    writing += ["base.tif", "--ch", "R,G,B", "--chnames", "top.R,top.G,top.B", "-o", "layer.exr", "rgb", "--ch", "R,G", "-o", "two.exr"]
    writing += ["base.tif", "--ch", "R,G,B", "--chnames", "Y,RY,BY", "-o", "luma.exr"]
    writing += ["rgb", "--ch", "R,G,B,R=1", "--chnames", "R,G,B,Z", "--deepen", "-o", "deep.exr"]
    writing += ["rgb", "--ch", "R,G,B", "rgb", "--ch", "G,R,B", "--siappend", "-o", "parts.exr"]
    writing += ["rgb", "--origin", "+5-3", "--fullsize", f"{W}x{H}+0+0", "-o", "window.exr"]
    writing += ["levels.exr", "--selectmip", 0, "-d", "float", "--compression", "none", "--scanline", "-o", "level.tif"]
    run(*writing)
    for compression in COMPRESSIONS[:8]:
        seen = corcast(f"uint-{compression}.exr")
        check(f"uint-{compression}.exr", seen if isinstance(seen, str) else seen / 2.0**32, rgb[..., 1:2], 1e-6)
    shown = numpy.zeros_like(rgb)
    shown[: H - 3, 5:] = rgb[3:, : W - 5]
    check("window.exr", corcast("window.exr"), shown, 1e-6)
    check("levels.exr", corcast("levels.exr"), tifffile.imread("level.tif"), 1e-6)
    check("plain.exr", corcast("plain.exr"), rgb)
    done = subprocess.run([CORCAST, "compare", "layer.exr", "layer.exr", "--layer", "top"], capture_output=True, text=True)
    check("layer top", done.stdout, "agree (tier A): 0 of")
    for name, sentence in (("layer", "has the channels top.B, top.G, top.R; they must be R G B, X Y Z or a single one"),
                           ("two", "has the channels G, R; they must be R G B, X Y Z or a single one"),
                           ("luma", "has the channels BY, RY, Y;"), ("parts", "has 2 parts"),
                           ("deep", "has deep pixels; only flat images can be read")):
        check(f"{name}.exr", corcast(f"{name}.exr"), sentence)
    raw = bytearray(open("plain.exr", "rb").read())
    sampling = raw.index(b"channels\0chlist\0") + 16 + 4 + 2 + 8  # of B: behind the size, its name, type and linearity
    raw[sampling + 4] = 3  # of rows, of which there are 21
    open("subsampled.exr", "wb").write(raw)
    check("subsampled.exr", corcast("subsampled.exr"), "has subsampled channels")


# ---- TIFF: written by tifffile, and through libtiff by Pillow and OpenImageIO -------------------------------------


def tiff_expected(array, associated):
    """Codes as corcast keeps them, floats on white. Alpha is the last of 2 or 4 channels."""
    channels = array.shape[2]
    floats = array.dtype.kind == "f"
    if channels in (1, 3):
        return array.astype(numpy.float32) if floats else array
    alpha = array[..., -1:].astype(numpy.float64)
    color = array[..., :-1].astype(numpy.float64)
    if floats:
        return on_white(color if associated else color * alpha, alpha).astype(numpy.float32)
    most = 255 if array.dtype == numpy.uint8 else 65535
    if associated:
        color = numpy.where(alpha > 0, numpy.minimum(numpy.floor((color * most + numpy.floor(alpha / 2)) / numpy.maximum(alpha, 1)), most), color)
    color = numpy.repeat(color, 3 // color.shape[2], axis=2)
    return numpy.concatenate([color, alpha], axis=2).astype(array.dtype)


def tiff():
    floats = smooth()
    kinds = {"8": codes(8, 4), "16": codes(16, 4), "half": floats.astype(numpy.float16), "float": floats,
             "double": floats.astype(numpy.float64), "signed": codes(8, 4).astype(numpy.int8), "32": codes(16, 4).astype(numpy.uint32),
             "signed16": codes(16, 4).astype(numpy.int16), "complex": floats.astype(numpy.complex64)}
    refused = {"signed": "has signed integers", "signed16": "has signed integers", "32": "has integers of 32 bits",
               "complex": "has complex floats"}
    forms = [(order, planes, tile, packed) for order in "<>" for planes in ("contig", "separate") for tile in (None, (16, 16))
             for packed in (None, "zlib")]
    for kind, array in kinds.items():
        for order, planes, tile, packed in forms:
            for channels in (1, 2, 3, 4):
                if channels == 1 and planes == "separate" or kind in refused and (tile or packed or channels % 2 == 0):
                    continue
                for alpha in ("unassalpha", "assocalpha") if channels in (2, 4) and not tile and order == "<" else ("unassalpha",):
                    part = array[..., :channels]
                    stored = part[..., 0] if channels == 1 else numpy.moveaxis(part, 2, 0) if planes == "separate" else part
                    options = {} if channels == 1 else {"planarconfig": planes}
                    if channels in (2, 4):
                        options["extrasamples"] = [alpha]
                    name = f"{kind}-{order}-{planes}-{tile}-{packed}-{channels}-{alpha}.tif"
                    write_tiff(name, stored, photometric="rgb" if channels > 2 else "minisblack", byteorder=order,
                               tile=tile, compression=packed, **options)
                    check(name, corcast(name), refused.get(kind) or tiff_expected(part, alpha == "assocalpha"), 1e-6)
    write_tiff("five.tif", codes(8, 5), photometric="rgb", extrasamples=[0, 0])
    check("five.tif", corcast("five.tif"), "has 5 samples per pixel")


def tiff_kinds():
    grey, color = codes(8, 1)[..., 0], codes(8, 3)
    write_tiff("white.tif", grey, photometric="miniswhite")
    check("white.tif", corcast("white.tif"), deep(255 - grey))
    palette = random.integers(0, 65536, (3, 256)).astype(numpy.uint16)
    write_tiff("palette.tif", grey, photometric="palette", colormap=palette)
    check("palette.tif", corcast("palette.tif"), numpy.moveaxis(palette[:, grey] >> 8, 0, 2))
    picture = Image.fromarray(color)
    for compression in ("tiff_lzw", "packbits", "tiff_adobe_deflate", "tiff_deflate", "lzma", "zstd", "jpeg"):
        name = f"{compression}.tif"
        picture.save(name, compression=compression)
        check(name, corcast(name), numpy.asarray(Image.open(name)))
    for compression in (None, "group3", "group4", "packbits", "tiff_lzw"):
        name = f"bilevel-{compression}.tif"
        picture.convert("1").save(name, compression=compression)
        check(name, corcast(name), deep(numpy.asarray(Image.open(name).convert("L"))))
    for mode, sentence in (("CMYK", "has CMYK colors"), ("LAB", "has CIELAB colors"),
                           ("YCbCr", "has YCbCr colors without JPEG compression")):
        picture.convert(mode).save(f"{mode}.tif")
        check(mode, corcast(f"{mode}.tif"), sentence)
    picture.save("pages.tif", save_all=True, append_images=[picture])
    check("pages.tif", corcast("pages.tif"), "has several pages")
    # Grey and palettes of fewer bits, which netpbm writes, white as 0 or as the largest value.
    for bits in (1, 2, 4):
        few = random.integers(0, 1 << bits, (H, W)).astype(numpy.uint8)
        write_pnm("few.pgm", "P5", few[..., None], (1 << bits) - 1)
        for option in ("-minisblack", "-miniswhite"):
            with open("few.tif", "wb") as out:
                subprocess.run(["pamtotiff", "-lzw", option, "few.pgm"], stdout=out, stderr=subprocess.DEVNULL, check=True)
            check(f"{bits} bits {option}", corcast("few.tif"), deep(few * (255 // ((1 << bits) - 1))))
        shades = random.integers(0, 256, (1 << bits, 3)).astype(numpy.uint8)
        write_pnm("few.ppm", "P6", shades[few], 255)
        with open("few.tif", "wb") as out:
            subprocess.run(["pamtotiff", "-none", "-indexbits=1,2,4", "few.ppm"], stdout=out, stderr=subprocess.DEVNULL, check=True)
        check(f"palette of {bits} bits", corcast("few.tif"), shades[few])
    write_tiff("base.tif", color, photometric="rgb")
    turned = [color, color[:, ::-1], color[::-1, ::-1], color[::-1], color.transpose(1, 0, 2), numpy.rot90(color, -1),
              color[::-1, ::-1].transpose(1, 0, 2), numpy.rot90(color)]  # [TIFF 6.0, Orientation]
    run("oiiotool", "base.tif", *(word for i in range(1, 9) for word in ("--orientation", i, "-o", f"turned-{i}.tif")))
    for i, upright in enumerate(turned, 1):
        check(f"turned-{i}.tif", corcast(f"turned-{i}.tif"), upright)


# ---- PNM, PFM -----------------------------------------------------------------------------------------------------


def write_pnm(name, kind, array, maximum, comment=b""):
    height, width, channels = array.shape
    with open(name, "wb") as out:
        if kind == "P7":
            kinds = {1: "GRAYSCALE", 2: "GRAYSCALE_ALPHA", 3: "RGB", 4: "RGB_ALPHA"}
            out.write(f"P7\nWIDTH {width}\nHEIGHT {height}\nDEPTH {channels}\nMAXVAL {maximum}\nTUPLTYPE {kinds[channels]}\nENDHDR\n".encode())
        else:
            out.write(f"{kind}\n".encode() + comment + f"{width} {height}\n{'' if kind in ('P1', 'P4') else f'{maximum}' + chr(10)}".encode())
        if kind == "P4":
            out.write(numpy.packbits(array[..., 0], axis=1).tobytes())
        elif kind == "P1":
            out.write("".join(map(str, array.ravel())).encode())
        elif kind in ("P2", "P3"):
            out.write(" ".join(map(str, array.ravel())).encode())
        else:
            out.write(array.astype(">u2" if maximum > 255 else "u1").tobytes())


def pnm():
    channels = {"P1": [1], "P2": [1], "P3": [3], "P4": [1], "P5": [1], "P6": [3], "P7": [1, 2, 3, 4]}
    for kind, depths in channels.items():
        for maximum in (1,) if kind in ("P1", "P4") else (1, 100, 255, 256, 1000, 65535):
            for depth in depths:
                array = random.integers(0, maximum + 1, (H, W, depth))
                name = f"{kind}-{maximum}-{depth}.pnm"
                write_pnm(name, kind, array, maximum, b"# a comment\n")
                most = 255 if maximum <= 255 else 65535
                expected = (array * most + maximum // 2) // maximum
                if kind in ("P1", "P4"):
                    expected = 255 * (1 - array)
                if depth == 2:
                    expected = expected[..., [0, 0, 0, 1]]
                check(name, corcast(name), expected)
    write_pnm("cmyk.pam", "P7", codes(8, 4), 255)
    raw = open("cmyk.pam", "rb").read().replace(b"RGB_ALPHA", b"CMYK")
    open("cmyk.pam", "wb").write(raw)
    check("cmyk.pam", corcast("cmyk.pam"), 'has 4 samples per pixel of the kind "CMYK"')
    floats = smooth()
    for order, scale in (("<", -1.0), (">", 1.0)):
        for channels in (1, 3):
            name = f"{order}{channels}.pfm"
            with open(name, "wb") as out:
                out.write(f"{'PF' if channels == 3 else 'Pf'}\n{W} {H}\n{scale}\n".encode())
                out.write(floats[::-1, :, :channels].astype(order + "f4").tobytes())
            check(name, corcast(name), floats[..., :channels])
    open("scale.pfm", "wb").write(f"Pf\n{W} {H}\n-2.0\n".encode() + bytes(4 * W * H))
    check("scale.pfm", corcast("scale.pfm"), 'the scale is "-2.0"')
    open("four.pfm", "wb").write(f"PF4\n{W} {H}\n-1.0\n".encode() + bytes(16 * W * H))
    check("four.pfm", corcast("four.pfm"), "is a PF4 file (four channels)")


# ---- PNG: written by netpbm and Pillow ----------------------------------------------------------------------------


def png():
    for maximum in (1, 3, 15, 255, 65535):
        for channels in (1, 2, 3, 4):
            if maximum < 255 and channels > 1:
                continue
            array = random.integers(0, maximum + 1, (H, W, channels))
            array[0, 0] = array[3, 4]
            write_pnm("png.pam", "P7", array, maximum)
            most = 65535 if maximum == 65535 else 255
            expected = array * most // maximum
            clear = most * numpy.any(array != array[3, 4], axis=2, keepdims=True)
            for interlace in ([], ["-interlace"]):
                for transparent in ([], ["-transparent", "rgbi:" + "/".join(str(v / maximum) for v in numpy.resize(array[3, 4], 3))]):
                    if transparent and channels % 2 == 0:
                        continue
                    name = f"{maximum}-{channels}-{len(interlace)}-{len(transparent)}.png"
                    with open(name, "wb") as out:
                        done = subprocess.run(["pamtopng", *interlace, *transparent, "png.pam"], stdout=out, stderr=subprocess.PIPE)
                    if done.returncode:
                        print(f"{name}: pamtopng: {done.stderr}")
                    wide = numpy.concatenate([numpy.repeat(expected, 3 // channels, axis=2), clear], axis=2) if transparent else expected
                    check(name, corcast(name), wide[..., [0, 0, 0, 1]] if channels == 2 else wide)
    for bits in (1, 2, 4, 8):
        index = random.integers(0, 1 << bits, (H, W)).astype(numpy.uint8)
        colors = random.integers(0, 256, (1 << bits, 3)).astype(numpy.uint8)
        alpha = random.integers(0, 256, 1 << bits).astype(numpy.uint8)
        picture = Image.fromarray(index, "P")
        picture.putpalette(colors.tobytes())
        picture.save(f"palette-{bits}.png", bits=bits)
        check(f"palette-{bits}.png", corcast(f"palette-{bits}.png"), colors[index])
        picture.save(f"clear-{bits}.png", bits=bits, transparency=alpha.tobytes())
        check(f"clear-{bits}.png", corcast(f"clear-{bits}.png"), numpy.concatenate([colors[index], alpha[index][..., None]], axis=2))


# ---- JPEG, WebP: written by Pillow --------------------------------------------------------------------------------


def lossy():
    floats = smooth()[..., :3]
    color = Image.fromarray((255 * numpy.clip(floats, 0, 1)).astype(numpy.uint8))
    for mode in ("L", "RGB"):
        for progressive in (False, True):
            for sampling in (0, 1, 2):
                name = f"{mode}-{progressive}-{sampling}.jpg"
                color.convert(mode).save(name, progressive=progressive, subsampling=sampling, quality=90)
                check(name, corcast(name), deep(numpy.asarray(Image.open(name))))
    color.convert("CMYK").save("cmyk.jpg")
    check("cmyk.jpg", corcast("cmyk.jpg"), "has CMYK colors")
    exif = Image.Exif()
    exif[0x0112] = 6
    color.save("turned.jpg", exif=exif)
    check("turned.jpg", corcast("turned.jpg"), "its Exif orientation is 6")
    clear = Image.fromarray(codes(8, 4))
    for name, picture, options in (("lossy.webp", color, {"quality": 80}), ("lossless.webp", color, {"lossless": True}),
                                   ("clear.webp", clear, {"lossless": True, "exact": True}), ("clear-lossy.webp", clear, {"quality": 80})):
        picture.save(name, **options)
        check(name, corcast(name), numpy.asarray(Image.open(name)))
    color.save("moving.webp", save_all=True, append_images=[clear])
    check("moving.webp", corcast("moving.webp"), "is an animation")


# ---- what corcast writes: the PPM and the PFM planes say what the other files hold --------------------------------


class Written:
    """Renders pictures, all at the same view, and reads them by other programs."""

    def __init__(self, tree):
        self.tree, self.waiting = tree, []

    def render(self, name, *options):
        run(CORCAST, "render", self.tree, "--quiet", "--size", f"{W}x{H}", *options, "-o", name)
        return name

    def ask(self, name, channels=None):
        """Has OpenImageIO read a file, or channels of it, when `read` is called."""
        self.waiting += [name, *(["--ch", channels] if channels else []), "-d", "float", "--compression", "none"]
        self.waiting += ["--scanline", "-o", f"{name}.{channels}.tif"]

    def read(self):
        run("oiiotool", "--nosoftwareattrib", *self.waiting)

    def seen(self, name, channels=None):
        return deep(tifffile.imread(f"{name}.{channels}.tif"))


def pnm_values(name):
    plain = subprocess.run(["pnmtoplainpnm", name], stdout=subprocess.PIPE, check=True).stdout
    return numpy.array(plain.split()[4:], int).reshape(H, W, 3)


TIFFS = {"l.tif": [], "d.tif": ["--compression", "deflate"], "n.tif": ["--compression", "none"]}
LAYERS = {"R,G,B": "color", "Z": "depth", "N.X,N.Y,N.Z": "normal", "id": "id"}


def written_codes(files, profile):
    """8 and 16 bits, opaque, transparent and in inks. The PPM, and of inks the uncompressed TIFF, say what is right."""
    for bits in (8, 16):
        for name, options in {"t.ppm": [], "t.png": [], **TIFFS}.items():
            files.render(f"{bits}{name}", "--bits", bits, *options)
            files.ask(f"{bits}{name}")
        for name, options in {"t.png": [], **TIFFS}.items():
            files.render(f"{bits}clear-{name}", "--bits", bits, "--background", "none", *options)
            files.ask(f"{bits}clear-{name}")
        for name, options in TIFFS.items():
            files.render(f"{bits}inks-{name}", "--bits", bits, "--cmyk-profile", profile, *options)
    files.render("t.jpg", "--quality", 100)
    files.render("inks.jpg", "--quality", 100, "--cmyk-profile", profile)
    yield
    for bits, most in ((8, 255), (16, 65535)):
        truth = pnm_values(f"{bits}t.ppm")
        kept = corcast(f"{bits}clear-n.tif")
        shown = numpy.concatenate([kept[..., :3].astype(float) * kept[..., 3:] / most, kept[..., 3:]], axis=2)
        inks = tifffile.imread(f"{bits}inks-n.tif")
        check(f"{bits} bits of inks", inks * (255 / most), expected_inks(truth / most, profile), 2)
        for name in ("t.png", *TIFFS):
            check(f"{bits}{name}", numpy.rint(files.seen(f"{bits}{name}") * most), truth)
            check(f"{bits}{name} again", corcast(f"{bits}{name}"), truth)
            name = f"{bits}clear-{name}"  # whose colors OpenImageIO multiplies by alpha
            check(name, files.seen(name) * most, shown, 1)
            check(f"{name} again", corcast(name), kept)
            if bits == 8:
                check(f"{name} by Pillow", numpy.asarray(Image.open(name)), kept)
    for name in TIFFS:
        check(f"8inks-{name}", numpy.asarray(Image.open(f"8inks-{name}")), tifffile.imread("8inks-n.tif"))
    check("inks.jpg", numpy.asarray(Image.open("inks.jpg")), tifffile.imread("8inks-n.tif"), 8)
    check("t.jpg", numpy.asarray(Image.open("t.jpg")), pnm_values("8t.ppm"), 12)


def written_floats(files):
    """OpenEXR of 16 and 32 bits with and without alpha and planes. PFM says what is right, and PNG of alpha."""
    for ground in ("white", "none"):
        files.render(f"{ground}.png", "--planes", "depth,normal,id,color", "--background", ground)
        for bits in (16, 32):
            name = f"{ground}{bits}.exr"
            files.render(f"all-{name}", "--bits", bits, "--planes", "depth,normal,id", "--background", ground)
            files.render(name, "--bits", bits, "--background", ground)
            files.ask(name)
            for channels in LAYERS:
                files.ask(f"all-{name}", channels)
    yield
    for ground in ("white", "none"):
        ids = pnm_values(f"{ground}.id.ppm")
        planes = {name: pfm(f"{ground}.{name}.pfm") for name in ("color", "depth", "normal")}
        planes["id"] = (ids[..., :1] * 256 + ids[..., 1:2]) * 256 + ids[..., 2:]
        for bits in (16, 32):
            name = f"{ground}{bits}.exr"
            for channels, plane in LAYERS.items():
                half = bits == 16 and plane in ("color", "normal")
                expected = planes[plane].astype(numpy.float16 if half else numpy.float32).astype(float)
                check(f"all-{name} {channels}", numpy.nan_to_num(files.seen(f"all-{name}", channels).astype(float), posinf=1e9),
                      numpy.nan_to_num(expected, posinf=1e9))
            seen = files.seen(name)
            if ground == "white":
                check(f"{name} again", corcast(name), seen)
                continue
            codes_of_alpha = numpy.floor(seen[..., 3:] * numpy.float32(255) + numpy.float32(0.5))
            check(f"{name} alpha", codes_of_alpha, corcast("none.png")[..., 3:], 1 if bits == 16 else 0)
            check(f"{name} again", corcast(name), on_white(seen[..., :3], seen[..., 3:]), 1e-6)


def written():
    files = Written(sys.argv[3])
    parts = [written_codes(files, sys.argv[4]), written_floats(files)]
    for part in parts:
        next(part)
    files.read()
    for part in parts:
        next(part, None)


def expected_inks(rgb, profile):
    picture = Image.fromarray(numpy.rint(rgb * 255).astype(numpy.uint8))
    made = ImageCms.profileToProfile(picture, ImageCms.createProfile("sRGB"), profile, renderingIntent=1, outputMode="CMYK", flags=0x2000)
    return numpy.asarray(made)


for function in sys.argv[2].split(","):
    globals()[function]()
print(f"{tried} files")
