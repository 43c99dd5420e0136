"""corcast: grow, read, draw, export and check arterial trees.

    import corcast
    tree = corcast.grow(terminals=1000, seed=4, domain="ball:30")
    tree.positions, tree.radii, tree.parents       # numpy arrays; lengths are millimetres
    tree.field("wss")                              # an array with a value per node
    tree.refine(level="topology")
    tree.render(model="isosurface", size=(800, 800), ao=16).save("tree.png")
    tree.export("tree.stl")
    corcast.compare("a.png", "b.png").cause

Keyword arguments are the options of the corcast command of the same name, with `_` for `-`:
docs/REFERENCE.md lists them, and corcast.schema("grow") returns them with ranges, units and
defaults. A value is a string as on the command line, a number, True or False, or a sequence of
numbers. A list of strings is joined by commas. A sequence of sequences sets the option several
times. None selects the default.

Two keyword arguments are not options. `progress` is a function of (step, fraction); it returns
False to stop the operation. `message` is a function of (sentence, is_warning). Without `message`,
warnings of the library become Python warnings.

A failure raises corcast.Error, whose text is the library's error message. The module needs numpy
and the shared library libcorcast.so.0. The environment variable CORCAST_LIBRARY may name the path
of the library. Otherwise the module searches its own folder, the installed prefix and the build
folder of a source tree.
"""

import collections.abc
import ctypes
import json
import numbers
import os
import pathlib
import sys
import threading
import warnings
from ctypes import POINTER, byref, c_char_p, c_double, c_int, c_size_t, c_void_p

import numpy

__all__ = ["Error", "Image", "Mesh", "Page", "Report", "Scene", "Tree", "compare", "figure", "grow",
           "read", "schema", "version"]


class Error(Exception):
    """A failure of the library; the text is one sentence.

    exit_status: the exit status of the command line: 1 a comparison found a difference, 2 wrong
    input or options, 3 a failure of memory, a file, another program or a callback.
    kind: "usage", "input", "infeasible", "io", "memory", "tool", "cancelled" or "differs".
    """

    def __init__(self, sentence, exit_status, kind):
        super().__init__(sentence)
        self.exit_status = exit_status
        self.kind = kind

    def __reduce__(self):
        return Error, (str(self), self.exit_status, self.kind)


# ---- the library ---------------------------------------------------------------------------------

_PROGRESS = ctypes.CFUNCTYPE(c_int, c_void_p, c_char_p, c_double)
_MESSAGE = ctypes.CFUNCTYPE(None, c_void_p, c_int, c_char_p)
_SINK = ctypes.CFUNCTYPE(c_int, c_void_p, c_char_p, c_void_p, c_size_t)


class _Nodes(ctypes.Structure):
    _fields_ = [("n", c_size_t), ("positions", POINTER(c_double)), ("radii", POINTER(c_double)),
                ("parents", POINTER(ctypes.c_int32)), ("ids", POINTER(ctypes.c_int32))]


class _Pixels(ctypes.Structure):
    _fields_ = [("width", c_int), ("height", c_int), ("channels", c_int), ("type", c_int),
                ("data", c_void_p), ("size", c_size_t)]


class _Triangles(ctypes.Structure):
    _fields_ = [("n_vertices", c_size_t), ("n_triangles", c_size_t),
                ("vertices", POINTER(c_double)), ("indices", POINTER(ctypes.c_uint32)),
                ("segments", POINTER(ctypes.c_uint32))]


# The parameters of the functions of corcast.h that return a status, without the last parameter,
# the error: h handle, H pointer that receives a handle, s text, i int, z size, p pointer,
# f function.
_FUNCTIONS = {
    "options_new": "sH", "options_set": "hss", "options_callbacks": "hffp",
    "schema": "sH", "tree_read": "shH", "tree_from_nodes": "pH", "tree_copy": "hH",
    "tree_nodes": "hp", "tree_field": "hshpp", "tree_write": "hs", "grow": "hHH",
    "refine": "hhH", "certify": "hhH", "info": "hhH", "pulse": "hhH", "flow": "hhH",
    "coverage": "hhH", "answer": "hhsH", "scene_new": "hhH", "render": "hHH",
    "image_read": "sH", "image_read_bytes": "pzsH", "image_from_pixels": "pH",
    "image_shape": "hippp", "image_write_bytes": "hiisfp",
    "image_pixels": "hiipz", "image_write": "hiis", "compare": "hhhH", "mesh_new": "hhH",
    "mesh_triangles": "hp", "export": "hhs", "export_bytes": "hhsfp", "verify": "hhsH",
    "figure": "shs",
}
_TYPES = {"h": c_void_p, "H": c_void_p, "s": c_char_p, "i": c_int, "z": c_size_t, "p": c_void_p,
          "f": c_void_p}


def _library_paths():
    """Yields the paths where the library may be, in the order of precedence."""
    here = pathlib.Path(__file__).resolve().parent
    name = "libcorcast.so.0"
    if os.environ.get("CORCAST_LIBRARY"):
        yield pathlib.Path(os.environ["CORCAST_LIBRARY"])
        return
    yield here / name
    yield here / "lib" / name                      # a wheel
    yield here.parent.parent / name                # PREFIX/lib/python3/dist-packages/corcast.py
    yield here.parent.parent / "build" / name      # src/python/corcast.py of a source tree
    yield pathlib.Path(sys.prefix) / "lib" / name


def _load():
    paths = [path for path in _library_paths() if path.exists()]
    library = ctypes.CDLL(str(paths[0]) if paths else "libcorcast.so.0")
    for name, parameters in _FUNCTIONS.items():
        function = getattr(library, "corcast_" + name)
        function.argtypes = [_TYPES[letter] for letter in parameters] + [c_void_p]
        function.restype = c_int
    for name in ("version", "error_text", "error_kind", "report_json"):
        function = getattr(library, "corcast_" + name)
        function.argtypes = [] if name == "version" else [c_void_p]
        function.restype = c_char_p
    library.corcast_error_new.restype = c_void_p
    for name in ("error", "options", "report", "tree", "scene", "image", "mesh"):
        free = getattr(library, "corcast_" + name + "_free")
        free.argtypes = [c_void_p]
        free.restype = None
    return library


_library = _load()


_field_lock = threading.Lock()


def _text(value):
    return None if value is None else os.fsencode(value)


def _call(name, *arguments, accept=(0,)):
    """Calls corcast_NAME with an error; returns its status, or raises Error."""
    error = _library.corcast_error_new()
    try:
        status = getattr(_library, "corcast_" + name)(*arguments, error)
        if status not in accept:
            sentence = _library.corcast_error_text(error).decode("utf-8", "replace")
            raise Error(sentence, status, _library.corcast_error_kind(error).decode())
        return status
    finally:
        _library.corcast_error_free(error)


class _Handle:
    """Owns a handle of the library, and frees it when this object is destroyed."""

    _kind = None  # "tree"

    def __init__(self, handle=None):
        self._handle = c_void_p(handle)

    def __reduce_ex__(self, _protocol):
        raise TypeError(f"a corcast {self._kind} cannot be copied or pickled")

    def __del__(self):
        if getattr(self, "_handle", None):
            getattr(_library, "corcast_" + self._kind + "_free")(self._handle)
            self._handle = c_void_p()


class _ReportHandle(_Handle):
    _kind = "report"

    def content(self):
        return json.loads(_library.corcast_report_json(self._handle) or b"{}")


class Report(dict):
    """The result of an operation: the JSON document that the command line writes, as a dict. Its
    members are also attributes.
    """

    def __getattr__(self, name):
        try:
            value = self[name]
        except KeyError:
            raise AttributeError(f"the report has no member {name!r}; it has "
                                 f"{', '.join(self)}") from None
        return Report(value) if isinstance(value, dict) else value


# ---- options -------------------------------------------------------------------------------------

def _number(value):
    whole = isinstance(value, numbers.Integral) or (float(value).is_integer() and abs(value) < 2**53)
    return str(int(value)) if whole else repr(float(value))


def _is_sequence(value):
    return isinstance(value, (collections.abc.Sequence, numpy.ndarray)) and \
        not isinstance(value, (str, bytes))


def _value(name, value):
    """Returns a value as text in the form of the command line."""
    if isinstance(value, (bool, numpy.bool_)):
        return "on" if value else "off"
    if isinstance(value, numbers.Real):
        return _number(value)
    if _is_sequence(value):
        return ("x" if name == "size" else ",").join(_value(name, item) for item in value)
    return os.fspath(value)


def _values(name, value):
    """Returns the texts of an option: one, or several if the option is set several times."""
    if isinstance(value, list) and value and isinstance(value[0], str):
        return [",".join(value)]
    if _is_sequence(value) and len(value) and _is_sequence(value[0]):
        return [_value(name, item) for item in value]
    return [_value(name, value)]


class _Options(_Handle):
    """The options of a command, and the callbacks of an operation."""

    _kind = "options"

    def __init__(self, command, arguments):
        super().__init__()
        arguments = dict(arguments)
        self._progress = arguments.pop("progress", None)
        self._message = arguments.pop("message", None)
        self._raised = None
        self._stopped = False  # the caller's function has stopped the operation
        _call("options_new", command.encode(), byref(self._handle))
        if os.environ.get("CORCAST_TEMPLATES"):
            arguments.setdefault("templates", os.environ["CORCAST_TEMPLATES"])
        for name, value in arguments.items():
            name = name.rstrip("_").replace("_", "-")
            for one in [] if value is None else _values(name, value):
                _call("options_set", self._handle, name.encode(), _text(one))
        self._callbacks = (_PROGRESS(self._show), _MESSAGE(self._say))
        _call("options_callbacks", self._handle, *[ctypes.cast(f, c_void_p)
                                                   for f in self._callbacks], None)

    def _show(self, _user, step, fraction):
        """Returns 1, to stop the operation, if `progress` returns False or raises, or at Ctrl-C."""
        try:
            if self._progress and step is not None:
                answer = self._progress(step.decode(), fraction)
                self._stopped = answer is not None and not answer
                return int(self._stopped)
        except BaseException as raised:  # must not enter the library; `run` raises it again
            self._raised = raised
            return 1
        return 0

    def _say(self, _user, is_warning, sentence):
        sentence = sentence.decode("utf-8", "replace")
        try:
            if self._message:
                self._message(sentence, bool(is_warning))
            elif is_warning:
                warnings.warn(sentence, stacklevel=4)
        except BaseException as raised:
            self._raised = raised

    def run(self, name, *arguments, accept=(0,)):
        """Calls an operation. Raises the exception that a callback raised, if any."""
        try:
            status = _call(name, *arguments, accept=accept)
        except Error as error:
            if self._raised:
                raise self._raised from None
            if error.kind == "cancelled" and not self._stopped:
                raise KeyboardInterrupt from None  # ctypes ignored Ctrl-C before _show began
            raise
        if self._raised:
            raise self._raised
        return status


def version():
    """Returns the version of the library, such as "0.1.0"."""
    return _library.corcast_version().decode()


def schema(command=None):
    """Returns the description of a command: its options with kinds, ranges, units and defaults.
    Without `command`, returns a list of the descriptions of all commands."""
    report = _ReportHandle()
    _call("schema", _text(command), byref(report._handle))
    commands = report.content()["commands"]
    return Report(commands[0]) if command else [Report(described) for described in commands]


# ---- trees ---------------------------------------------------------------------------------------

def _copy(pointer, shape, dtype):
    count = int(numpy.prod(shape))
    if count == 0:
        return numpy.empty(shape, dtype)
    return numpy.ctypeslib.as_array(pointer, (count,)).astype(dtype, copy=True).reshape(shape)


def _integers(name, values):
    """Returns the values as an array of int32. Raises ValueError if a value does not fit."""
    values = numpy.asarray(values)
    with numpy.errstate(invalid="ignore"):
        integers = numpy.ascontiguousarray(values, numpy.int32)
    if not (integers == values).all():
        raise ValueError(f"{name} are not integers that fit in 32 bits")
    return integers


class Tree(_Handle):
    """An arterial tree, or a forest of several trees.

    Each node i, except a root, is the distal end of segment i: a straight tube of one radius from
    the position of the node's parent to the position of the node. Parents precede their children.
    The arrays are copies.
    """

    _kind = "tree"

    @classmethod
    def from_arrays(cls, positions, radii, parents, ids=None):
        """Makes a tree from arrays: positions (n, 3) in mm, radii (n) in mm, parents (n), which are
        node indices or -1 at a root, and ids (n), each 1 or more. Without ids, the nodes get the
        ids 1, 2, ..."""
        positions = numpy.ascontiguousarray(positions, numpy.float64)
        radii = numpy.ascontiguousarray(radii, numpy.float64)
        parents = _integers("parents", parents)
        n = len(radii)
        if positions.shape != (n, 3) or parents.shape != (n,) or radii.shape != (n,):
            raise ValueError(f"positions {positions.shape}, radii {radii.shape} and parents "
                             f"{parents.shape} are not (n, 3), (n,) and (n,)")
        nodes = _Nodes(n, positions.ctypes.data_as(POINTER(c_double)),
                       radii.ctypes.data_as(POINTER(c_double)),
                       parents.ctypes.data_as(POINTER(ctypes.c_int32)))
        if ids is not None:
            ids = _integers("ids", ids)
            if ids.shape != (n,):
                raise ValueError(f"ids {ids.shape} is not ({n},)")
            nodes.ids = ids.ctypes.data_as(POINTER(ctypes.c_int32))
        tree = cls()
        _call("tree_from_nodes", byref(nodes), byref(tree._handle))
        return tree

    def copy(self):
        """Returns a copy of the tree."""
        tree = Tree()
        _call("tree_copy", self._handle, byref(tree._handle))
        return tree

    def __copy__(self):
        return self.copy()

    def __deepcopy__(self, _memo):
        return self.copy()

    def _nodes(self):
        nodes = _Nodes()
        _call("tree_nodes", self._handle, byref(nodes))
        return nodes

    def __len__(self):
        """Returns the number of nodes."""
        return self._nodes().n

    @property
    def positions(self):
        """Positions of the nodes in mm: an array (n, 3) of float64."""
        nodes = self._nodes()
        return _copy(nodes.positions, (nodes.n, 3), numpy.float64)

    @property
    def radii(self):
        """Radii of the segments in mm, an array (n) of float64. At a root: radius of the inlet."""
        nodes = self._nodes()
        return _copy(nodes.radii, (nodes.n,), numpy.float64)

    @property
    def parents(self):
        """Node indices of the parents, an array (n) of int32; -1 at a root."""
        nodes = self._nodes()
        return _copy(nodes.parents, (nodes.n,), numpy.int32)

    @property
    def ids(self):
        """Ids of the nodes in files, an array (n) of int32."""
        nodes = self._nodes()
        return _copy(nodes.ids, (nodes.n,), numpy.int32)

    def _field(self, name, options):
        options = _Options("info", options)
        values, unit = POINTER(c_double)(), c_char_p()
        with _field_lock:  # the library stores the field in the tree
            _call("tree_field", self._handle, name.encode(), options._handle, byref(values),
                  byref(unit))
            return _copy(values, (len(self),), numpy.float64), unit.value.decode()

    def field(self, name, **options):
        """Returns the values of a field, an array (n) of float64: a column of the tree's file, or a
        computed field such as "flow" (ml/min), "pressure" (mmHg), "wss" (Pa) or "strahler". A node
        without a value has NaN. The options are those of `corcast info`, such as p_perf=100."""
        return self._field(name, options)[0]

    def unit(self, name, **options):
        """Returns the unit of a field; "" for a pure number."""
        return self._field(name, options)[1]

    def save(self, path):
        """Writes the tree to a file. The extension selects the format."""
        _call("tree_write", self._handle, _text(path))

    def refine(self, level=None, **options):
        """Optimizes the tree in place. Returns the report of `corcast refine`. `level` is the value
        of the option --refine: "geometry", "topology" or "anneal"."""
        if level is not None:
            options["refine"] = level
        return self._report("refine", options)

    def certify(self, **options):
        """Proves a lower bound of the growth target for all trees with this topology. Returns a
        report: `bound` is the lower bound, `best_geometry` the lowest target that was found for
        this topology, and `gap` is best_geometry / bound - 1."""
        return self._report("certify", options)

    def info(self, **options):
        """Returns the report of `corcast info --json`: counts, lengths, volume, pressures."""
        return self._report("info", options)

    def pulse(self, **options):
        """Computes pulse waves over a cycle, in place. The tree gets a column for each moment, such
        as "wss_0.0333", which `render(color_by="wss", moment=2)` draws. Returns the report of
        `corcast pulse`. Options: fields="wss,dilation", frames=24."""
        return self._report("pulse", options)

    def flow(self, **options):
        """Computes steady flow in a tree or a network with loops, in place. The tree gets the
        columns flow, pressure, velocity, wss and direction. Returns the report of `corcast flow`:
        `loops`, `inflow`, `mass_imbalance`. Options: boundary="ends.csv", viscosity=3."""
        return self._report("flow", options)

    def coverage(self, **options):
        """Measures how far the tissue is from the nearest vessel. Returns the report of
        `corcast coverage`: `mean_mm`, `quantiles`, `beyond`, `largest_mm`."""
        return self._report("coverage", options)

    def answer(self, path, **options):
        """Computes two proven bounds of each pixel's color, and writes them to the OpenEXR file
        `path`. `corcast compare` grades pictures by this file. Returns a report with the counts of
        pixels and of undecided pixels."""
        options = _Options("answer", options)
        report = _ReportHandle()
        options.run("answer", self._handle, options._handle, _text(path), byref(report._handle))
        return Report(report.content())

    def _report(self, command, options):
        options = _Options(command, options)
        report = _ReportHandle()
        options.run(command, self._handle, options._handle, byref(report._handle))
        return Report(report.content())

    def scene(self, **options):
        """Returns the Scene that `render` draws. The options are those of `corcast render`."""
        return Scene(self, options)

    def render(self, **options):
        """Draws the tree. Returns an Image. The options are those of `corcast render`."""
        return self.scene(**options).render()

    def mesh(self, **options):
        """Returns the closed surface, a Mesh. The options are those of `corcast export`."""
        return Mesh(self, options)

    def export(self, path, command="export", **options):
        """Runs a command on the tree and writes its files. The extension of `path` selects the
        format. `command` is "export" (meshes, volumes, pages), "scene" (POV-Ray, OpenSCAD,
        Tachyon), "render" (pictures), "diagram", "convert" (trees), "pulse" (values over time,
        decks) or "coverage" (volumes of distances). The options are those of the command."""
        options = _Options(command, options)
        options.run("export", self._handle, options._handle, _text(path))

    def export_bytes(self, name, command="export", **options):
        """Returns the files that `export` would write: a dict from file name to bytes."""
        options = _Options(command, options)
        return _files(lambda sink: options.run("export_bytes", self._handle, options._handle,
                                               _text(name), sink, None))

    def page(self, **options):
        """Returns the web page that `corcast export T -o P.html` writes: a Page, which shows the
        tree in three dimensions with its fields. A notebook displays the page."""
        return Page(self.export_bytes("tree.html", **options)["tree.html"])

    def verify(self, folder, **options):
        """Draws the tree with POV-Ray and with corcast, and compares the pictures. `folder`
        receives the scene, the pictures and the report. Returns a report, in which `agrees` is
        true if the renderers agree."""
        options = _Options("verify", options)
        report = _ReportHandle()
        status = options.run("verify", self._handle, options._handle, _text(folder),
                             byref(report._handle), accept=(0, 1))
        result = Report(report.content())
        result.setdefault("agrees", status == 0)
        return result

    def __repr__(self):
        return f"<corcast.Tree of {len(self)} nodes>"

    def _repr_png_(self):
        """Returns a PNG, so that a notebook displays the tree."""
        return self.export_bytes("tree.png", command="render", size=(480, 480))["tree.png"]


def grow(**options):
    """Grows a tree and returns it. The options are those of `corcast grow`, as in
    grow(terminals=1000, seed=4)."""
    options = _Options("grow", options)
    tree = Tree()
    options.run("grow", options._handle, byref(tree._handle), None)
    return tree


def read(path, **options):
    """Reads a tree from a file and returns it. The options are the input options of `corcast
    info`, as in read(path, input_unit="um")."""
    options = _Options("info", options)
    tree = Tree()
    options.run("tree_read", _text(path), options._handle, byref(tree._handle))
    return tree


# ---- pictures ------------------------------------------------------------------------------------

_PLANES = {"color": 0, "depth": 1, "normal": 2, "id": 3}
_U8, _U16, _F32, _U32 = 1, 2, 3, 4
_DTYPES = {_U8: numpy.uint8, _U16: numpy.uint16, _F32: numpy.float32, _U32: numpy.uint32}


def _type_of(dtype):
    for code, known in _DTYPES.items():
        if numpy.dtype(dtype) == known:
            return code
    raise ValueError(f"{numpy.dtype(dtype)} is not one of uint8, uint16, float32, uint32")


def _files(make):
    """Calls `make` with a sink; returns a dict from the names of the files it takes to bytes."""
    files = {}

    def take(_user, file, data, size):
        files.setdefault(os.fsdecode(file), bytearray()).extend(ctypes.string_at(data, size))
        return 0

    sink = _SINK(take)
    make(ctypes.cast(sink, c_void_p))
    return {file: bytes(data) for file, data in files.items()}


class Image(_Handle):
    """A picture, and optionally planes of the same size: depth, normals and ids.

    Arrays have the shape (height, width) or (height, width, channels). Colors of the types uint8
    and uint16 are sRGB codes. Colors of the type float32 are linear.
    """

    _kind = "image"

    @classmethod
    def read(cls, path):
        """Reads a picture: PNG, TIFF, JPEG, WebP, PNM, PFM or OpenEXR."""
        image = cls()
        _call("image_read", _text(path), byref(image._handle))
        return image

    @classmethod
    def from_bytes(cls, data, name="the bytes"):
        """Reads a picture from the bytes of a file. `name` names them in errors."""
        image = cls()
        data = bytes(data)
        _call("image_read_bytes", data, len(data), _text(name), byref(image._handle))
        return image

    @classmethod
    def from_array(cls, pixels):
        """Makes a picture from an array of uint8, uint16 or float32. Its shape is (height, width),
        (height, width, 3) or (height, width, 4)."""
        pixels = numpy.ascontiguousarray(pixels)
        if pixels.ndim not in (2, 3):
            raise ValueError(f"an array of shape {pixels.shape} is no picture")
        channels = pixels.shape[2] if pixels.ndim == 3 else 1
        image = cls()
        given = _Pixels(pixels.shape[1], pixels.shape[0], channels, _type_of(pixels.dtype),
                        pixels.ctypes.data, pixels.nbytes)
        _call("image_from_pixels", byref(given), byref(image._handle))
        return image

    def _shape(self, plane):
        sides = [c_int(), c_int(), c_int()]
        _call("image_shape", self._handle, _PLANES[plane], *[byref(side) for side in sides])
        return [side.value for side in sides]

    def plane(self, name, dtype=None):
        """Returns the plane "color", "depth" (mm), "normal" or "id" as an array; None if the image
        does not have the plane. Colors may be requested with the `dtype` uint8 (default), uint16
        or float32."""
        width, height, channels = self._shape(name)
        if width == 0:
            return None
        kind = {"color": _U8, "id": _U32}.get(name, _F32) if dtype is None else _type_of(dtype)
        out = numpy.empty((height, width, channels), _DTYPES[kind])
        _call("image_pixels", self._handle, _PLANES[name], kind, out.ctypes.data, out.nbytes)
        return out[:, :, 0] if channels == 1 else out

    @property
    def size(self):
        """Width and height in pixels."""
        return tuple(self._shape("color")[:2])

    @property
    def pixels(self):
        """Colors as an array of uint8."""
        return self.plane("color")

    def __array__(self, dtype=None, copy=None):
        return self.pixels if dtype is None else self.pixels.astype(dtype)

    @staticmethod
    def _file_type(name, plane, dtype):
        kind = {"depth": _F32, "normal": _F32, "id": _U32}.get(plane)
        if kind is not None:
            return kind
        extension = os.fspath(name).rsplit(".", 1)[-1].lower()
        return _type_of(dtype or (numpy.float32 if extension in ("exr", "pfm") else numpy.uint8))

    def save(self, path, plane="color", dtype=None):
        """Writes a plane to a file. The extension selects the format."""
        _call("image_write", self._handle, _PLANES[plane], self._file_type(path, plane, dtype),
              _text(path))

    def to_bytes(self, name, plane="color", dtype=None):
        """Returns the bytes of the file that `save` would write. The extension of `name`, a file
        name without a folder, selects the format."""
        kind = self._file_type(name, plane, dtype)
        made = _files(lambda sink: _call("image_write_bytes", self._handle, _PLANES[plane], kind,
                                         _text(name), sink, None))
        return made[os.fspath(name)]

    def __repr__(self):
        return "<corcast.Image of {} x {} pixels>".format(*self.size)

    def _repr_png_(self):
        """Returns a PNG, so that a notebook displays the picture."""
        return self.to_bytes("image.png")


class Scene(_Handle):
    """The geometry, appearance and view of a tree. Made by Tree.scene."""

    _kind = "scene"

    def __init__(self, tree, options):
        super().__init__()
        self._options = _Options("render", options)
        self._options.run("scene_new", tree._handle, self._options._handle, byref(self._handle))
        self.report = None  # of the last call of render: engine, seconds, rays

    def render(self):
        """Draws the scene. Returns an Image. Sets self.report."""
        image, report = Image(), _ReportHandle()
        self._options.run("render", self._handle, byref(image._handle), byref(report._handle))
        self.report = Report(report.content())
        return image


def _image(picture):
    if isinstance(picture, Image):
        return picture
    return Image.from_array(picture) if isinstance(picture, numpy.ndarray) else Image.read(picture)


def compare(a, b, **options):
    """Compares picture `b` with the reference `a`. Each is a path, an Image or an array. Returns a
    report with `agrees` and `cause`. The options are those of `corcast compare`."""
    options = _Options("compare", options)
    a, b, report = _image(a), _image(b), _ReportHandle()
    status = options.run("compare", a._handle, b._handle, options._handle, byref(report._handle),
                         accept=(0, 1))
    result = Report(report.content())
    result.setdefault("agrees", status == 0)
    return result


class Mesh(_Handle):
    """The surface of a tree as triangles. Made by Tree.mesh.

    vertices: (n, 3) of float64, mm. triangles: (m, 3) of uint32, counter-clockwise seen from
    outside. segments: (m) of uint32, per triangle the node index of its segment.
    """

    _kind = "mesh"

    def __init__(self, tree, options):
        super().__init__()
        options = _Options("export", options)
        options.run("mesh_new", tree._handle, options._handle, byref(self._handle))
        arrays = _Triangles()
        _call("mesh_triangles", self._handle, byref(arrays))
        self.vertices = _copy(arrays.vertices, (arrays.n_vertices, 3), numpy.float64)
        self.triangles = _copy(arrays.indices, (arrays.n_triangles, 3), numpy.uint32)
        self.segments = _copy(arrays.segments, (arrays.n_triangles,), numpy.uint32)

    def __repr__(self):
        return f"<corcast.Mesh of {len(self.triangles)} triangles>"


class Page:
    """A web page in one file. A notebook displays the page in a frame."""

    def __init__(self, data):
        self.html = data.decode("utf-8")

    def save(self, path):
        """Writes the page to a file."""
        pathlib.Path(path).write_text(self.html, encoding="utf-8")

    def _repr_html_(self):
        from html import escape
        return ('<iframe style="width:100%;height:640px;border:0" srcdoc="'
                + escape(self.html, quote=True) + '"></iframe>')


def figure(recipe, path, **options):
    """Draws a figure with several panels. `recipe` is the path of the file that describes the
    panels, `path` the output: .pdf, .eps, .svg, .png, .tif or .jpg. The options are those of
    `corcast figure`."""
    options = _Options("figure", options)
    options.run("figure", _text(recipe), options._handle, _text(path))
