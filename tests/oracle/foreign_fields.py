"""Reads what `export` and `scene` write of one tree, field by field, and compares each field with the tree. The readers
are not corcast's: NumPy, VTK, nibabel, zipfile, ElementTree, OpenSCAD's own evaluation, and a bpy that records what a
script asks of Blender. The tree has no symmetry, lies far from the origin, has two roots, ids with gaps, two classes of
values and one value that is missing.

    foreign_fields.py tree FOLDER     writes tree.csv and load.csv
    foreign_fields.py FORMAT FILE...  reads the files; prints and fails at the first field that is wrong
"""
import base64
import gzip
import json
import math
import re
import struct
import sys
import types
import zipfile
import xml.etree.ElementTree as ElementTree

import numpy as np

# id: parent, x, y, z, radius; all single precision.
NODES = {
    11: (0, 1003.5, -702.25, 411.125, 2.5),
    12: (11, 1011.25, -698.5, 405.75, 2.5),
    13: (12, 1022.5, -690.125, 409.5, 1.75),
    15: (12, 1009.75, -712.5, 401.25, 1.25),
    16: (13, 1031.5, -693.75, 416.25, 1.125),
    18: (13, 1025.25, -679.5, 402.5, 0.875),
    21: (0, 1040.25, -731.5, 440.75, 1.5),
    22: (21, 1052.75, -727.25, 433.5, 1.375),
}
LOAD = {12: 1.5, 13: 7.25, 15: 3.5, 18: 9.75, 22: 8.5}  # 16 has none
RANK = {12: 3, 13: 7, 15: 65534, 18: 1, 22: 0}  # neither
ORDER = {12: 2, 13: 2, 15: 1, 16: 1, 18: 1, 22: 1}
TREE = {12: 1, 13: 1, 15: 1, 16: 1, 18: 1, 22: 2}
LOW, HIGH, NONE = (0x44, 0x01, 0x54), (0xFD, 0xE7, 0x25), (0x1A, 0xE6, 0x4C)  # ends of viridis, and --no-data
SEGMENTS = [i for i, node in NODES.items() if node[0]]
FREE = {11, 15, 16, 18, 21, 22}  # nodes that one segment meets


def code(segment):
    value = LOAD.get(segment)
    return NONE if value is None else LOW if value < (1.5 + 9.75) / 2 else HIGH


def linear(codes):
    c = np.array(codes) / 255
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


def at(node):
    return np.array(NODES[node][1:4])


def ends(segment):
    return at(NODES[segment][0]), at(segment)


def radius(segment):
    return NODES[segment][4]


def expect(what, found, expected, tolerance=0.0):
    if tolerance or isinstance(expected, np.ndarray) or isinstance(found, np.ndarray):
        found, expected = np.asarray(found, float), np.asarray(expected, float)
        good = found.shape == expected.shape and bool(np.all(np.abs(found - expected) <= tolerance))
    else:
        good = found == expected
    if not good:
        sys.exit(f"{what}: found {found!r:.300}, expected {expected!r:.300}")


def walls(points):
    """For each point: the segment whose wall it lies on, or 0 where that is not clear; the way out there; its place
    along the segment, 0 to 1."""
    distance, away, place = [], [], []
    for segment in SEGMENTS:
        a, b = ends(segment)
        t = np.clip((points - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
        off = points - (a + t[:, None] * (b - a))
        distance.append(np.abs(np.linalg.norm(off, axis=1) - radius(segment)))
        away.append(off)
        place.append(t)
    distance, away, place = np.array(distance), np.array(away), np.array(place)
    best = distance.argmin(axis=0)
    every = np.arange(len(points))
    ranked = np.sort(distance, axis=0)
    clear = (ranked[0] < 0.1) & (ranked[1] > 0.9) & (place[best, every] > 0.3) & (place[best, every] < 0.7)
    out = away[best, every]
    out[~clear] = [1, 0, 0]
    return (np.where(clear, np.array(SEGMENTS)[best], 0), out / np.linalg.norm(out, axis=1)[:, None],
            place[best, every])


def check_triangles(points, triangles, segments=None, codes=None, normals=None):
    """A closed wall of all segments, turned outwards, with what stands at each triangle or its corners."""
    points, triangles = np.asarray(points, float), np.asarray(triangles, int)
    corners = points[triangles]
    middle = corners.mean(axis=1)
    wall, out, _ = walls(middle)
    clear = wall > 0
    expect("segments with triangles", {int(s) for s in wall[clear]}, set(SEGMENTS))
    turned = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    expect("triangles turned inwards", int(((turned * out).sum(axis=1)[clear] <= 0).sum()), 0)
    edges = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    expect("triangles at each edge", set(np.unique(edges, axis=0, return_counts=True)[1].tolist()), {2})
    if segments is not None:
        expect("segments of triangles", int((np.asarray(segments)[clear] != wall[clear]).sum()), 0)
    if codes is not None:
        expected = np.array([code(int(s)) for s in wall[clear]])
        expect("colors of triangles", int((np.asarray(codes)[clear] != expected).any(axis=-1).sum()), 0)
    if normals is not None:
        smooth = np.asarray(normals, float)[clear]
        expect("lengths of normals", np.linalg.norm(smooth, axis=-1).ravel(), np.ones(smooth[..., 0].size), 1e-5)
        expect("normals turned inwards", int(((smooth * out[clear][:, None]).sum(axis=-1) < 0.8).sum()), 0)
    return wall


def check_text(what, text, *words):
    for word in words:
        if word not in text:
            sys.exit(f"{what}: found {text!r}, expected {word!r} in it")


def read_glb(path, colored, phong_size, look):
    data = open(path, "rb").read()
    expect("magic, version, length", list(struct.unpack("<III", data[:12])), [0x46546C67, 2, len(data)])
    size = struct.unpack("<I", data[12:16])[0]
    document, buffer = json.loads(data[20:20 + size]), data[28 + size:]
    expect("asset.version", document["asset"]["version"], "2.0")
    check_text("asset.generator", document["asset"]["generator"], "corcast ")
    check_text("asset.extras.command", document["asset"]["extras"]["command"], "corcast export tree.csv")
    expect("scenes", [document["scene"], document["scenes"]], [0, [{"nodes": [0]}]])
    expect("buffers", document["buffers"][0]["byteLength"], len(buffer))
    root, groups = document["nodes"][0], document["nodes"][1:]
    expect("scale", root["scale"], [0.001] * 3)
    expect("children", root["children"], list(range(1, len(document["nodes"]))))
    check_text("description", root["extras"]["description"], "arterial tree tree.csv")
    if colored:
        found = [root["extras"]["color_" + key] for key in ("by", "unit", "low", "high", "log")]
        expect("extras.color", found, ["load", "", 1.5, 9.75, False])
    expect("names", [g["name"] for g in groups], ["order_1", "order_2"])
    material = document["materials"][0]["pbrMetallicRoughness"]
    expect("baseColorFactor", material["baseColorFactor"], [1, 1, 1, 1], 1e-6)
    expect("metallicFactor", material["metallicFactor"], 0)
    expect("roughnessFactor", material["roughnessFactor"], (2 / (4 * phong_size + 2)) ** 0.25, 1e-6)

    def array(index):
        accessor = document["accessors"][index]
        view = document["bufferViews"][accessor["bufferView"]]
        kind, n = {5126: "<f4", 5125: "<u4"}[accessor["componentType"]], {"VEC3": 3, "SCALAR": 1}[accessor["type"]]
        values = np.frombuffer(buffer, kind, n * accessor["count"], view["byteOffset"] + accessor["byteOffset"])
        values = values.reshape(-1, n)
        if "min" in accessor:
            expect("accessor.min", accessor["min"], values.min(axis=0))
            expect("accessor.max", accessor["max"], values.max(axis=0))
        return values

    for group in groups:
        order = int(group["name"][-1])
        expect("strahler_order", group["extras"]["strahler_order"], order)
        part = document["meshes"][group["mesh"]]["primitives"][0]
        triangles = array(part["indices"]).reshape(-1, 3)
        expect("extras.triangles", group["extras"]["triangles"], len(triangles))
        attributes = {name: array(index).astype(float) for name, index in part["attributes"].items()}
        expect("attributes", set(attributes), {"POSITION", "NORMAL", "COLOR_0"})
        points = attributes["POSITION"]
        wall, out, _ = walls(points)
        clear = wall > 0
        found = {int(s) for s in wall[clear]}
        expect("segments of " + group["name"], found, {s for s in SEGMENTS if ORDER[s] == order})
        expect("NORMAL", ((attributes["NORMAL"] * out).sum(axis=1)[clear] > 0.8).all(), np.True_)
        corners = points[triangles]
        turned = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        expect("winding", ((turned * out[triangles[:, 0]]).sum(axis=1) > 0)[clear[triangles[:, 0]]].all(), np.True_)
        expected = np.array([linear(code(int(s))) if colored else look for s in wall[clear]])
        expect("COLOR_0", attributes["COLOR_0"][clear], expected, 3e-3)


def ply_faces(path):
    """The corners and the segment of each face of a PLY, and the whole of its vertices and faces."""
    head, body = open(path, "rb").read().split(b"end_header\n", 1)
    head = head.decode()
    check_text("head", head, "format binary_little_endian 1.0", "units=mm", "comment corcast ")
    expect("properties", re.findall(r"property (.*)", head),
           ["float x", "float y", "float z", "float nx", "float ny", "float nz", "uchar red", "uchar green",
            "uchar blue", "list uchar int vertex_indices", "int segment", "uchar cap"])
    n, m = (int(re.search(f"element {kind} (\\d+)", head)[1]) for kind in ("vertex", "face"))
    vertices = np.frombuffer(body, np.dtype([("at", "<f4", 3), ("normal", "<f4", 3), ("color", "u1", 3)]), n)
    faces = np.frombuffer(body, np.dtype([("n", "u1"), ("v", "<i4", 3), ("segment", "<i4"), ("cap", "u1")]), m,
                          n * vertices.itemsize)
    expect("length", len(body), n * vertices.itemsize + m * faces.itemsize)
    expect("corners", set(faces["n"].tolist()), {3})
    return vertices, faces


def check_like_ply(ply, points, triangles, codes):
    """Each triangle has the color of the segment that the PLY of the same mesh names for it."""
    vertices, faces = ply_faces(ply)
    key = lambda corners: tuple(sorted(map(tuple, np.float32(corners).tolist())))
    known = {key(vertices["at"][face["v"]]): code(int(face["segment"])) for face in faces}
    points = np.float32(points)
    expect("triangles beside those of PLY", len(known), len(triangles))
    wrong = sum(known.get(key(points[t])) != tuple(int(c) for c in paint) for t, paint in zip(triangles, codes))
    expect("triangles of another color than in PLY", wrong, 0)


def read_ply(path):
    vertices, faces = ply_faces(path)
    triangles = faces["v"]
    check_triangles(vertices["at"], triangles, faces["segment"], None, vertices["normal"][triangles])
    wall, _, _ = walls(vertices["at"].astype(float))
    expected = np.array([code(int(s)) for s in wall[wall > 0]])
    expect("colors of points", vertices["color"][wall > 0], expected)
    check_caps(vertices["at"].astype(float)[triangles].mean(axis=1), faces["cap"] > 0, faces["segment"])


def check_caps(middle, cap, segments):
    """A cap lies in the plane of a free end of its segment, and each free end has one."""
    seen = set()
    for i in np.nonzero(cap)[0]:
        a, b = ends(int(segments[i]))
        axis = (b - a) / np.linalg.norm(b - a)
        offs = {NODES[int(segments[i])][0]: abs((middle[i] - a) @ axis), int(segments[i]): abs((middle[i] - b) @ axis)}
        node = min(offs, key=offs.get)
        expect("a cap off its end", offs[node] < 1e-3 and node in FREE, True)
        seen.add(node)
    expect("ends with caps", seen, FREE)


def read_obj(path, ply):
    materials, name = {}, None
    for words in map(str.split, open(path[:-4] + ".mtl")):
        if words[:1] == ["newmtl"]:
            name = words[1]
        elif words[:1] == ["Kd"]:
            materials[name] = np.round(255 * np.array([float(w) for w in words[1:]])).astype(int)
            expect("the name of a material", name, "vessel_%02X%02X%02X" % tuple(materials[name]))
        elif words[:1] == ["illum"]:
            expect("illum", words[1], "2")
    points, normals, triangles, corners, colors, groups = [], [], [], [], [], []
    color = group = None
    for words in map(str.split, open(path)):
        kind = words[0] if words else "#"
        if kind == "mtllib":
            expect("mtllib", words[1], path[:-4] + ".mtl")
        elif kind == "v":
            points.append([float(w) for w in words[1:]])
        elif kind == "vn":
            normals.append([float(w) for w in words[1:]])
        elif kind == "g":
            group = words[1]
        elif kind == "usemtl":
            color = materials[words[1]]
        elif kind == "f":
            triangles.append([int(w.split("//")[0]) - 1 for w in words[1:]])
            corners.append([int(w.split("//")[1]) - 1 for w in words[1:]])
            colors.append(color)
            groups.append(group)
    check_like_ply(ply, points, triangles, colors)
    wall = check_triangles(points, triangles, None, colors, np.array(normals)[corners])
    expected = [f"order_{ORDER[int(s)]}" for s in wall[wall > 0]]
    expect("groups", [g for g, s in zip(groups, wall) if s], expected)


def read_model(path):
    """The document of a 3MF, its colors, and its objects by id."""
    archive = zipfile.ZipFile(path)
    expect("files", archive.namelist(), ["[Content_Types].xml", "_rels/.rels", "3D/3dmodel.model"])
    check_text("content types", archive.read("[Content_Types].xml").decode(),
               'Extension="model" ContentType="application/vnd.ms-package.3dmanufacturing-3dmodel+xml"')
    check_text("relations", archive.read("_rels/.rels").decode(), 'Target="/3D/3dmodel.model"',
               "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel")
    text = re.sub(r' xmlns(:\w+)?="[^"]*"', "", archive.read("3D/3dmodel.model").decode())
    root = ElementTree.fromstring(re.sub(r"(</?)\w+:", r"\1", text))
    expect("unit", root.get("unit"), "millimeter")
    about = {node.get("name"): node.text for node in root.iter("metadata")}
    check_text("Application", about["Application"], "corcast ")
    check_text("Title", about["Title"], "arterial tree tree.csv")
    check_text("Description", about["Description"], "corcast export tree.csv")
    group = root.find("resources/colorgroup")
    colors = [tuple(bytes.fromhex(c.get("color")[1:])) for c in group]
    return root, group.get("id"), colors, {o.get("id"): o for o in root.iter("object")}


def mesh_of(thing):
    points = [[float(v.get(axis)) for axis in "xyz"] for v in thing.iter("vertex")]
    return points, [[int(t.get(k)) for k in ("v1", "v2", "v3")] for t in thing.iter("triangle")]


def read_3mf(path, ply):
    root, group, colors, things = read_model(path)
    thing = things[root.find("build/item").get("objectid")]
    expect("type", thing.get("type"), "model")
    points, triangles = mesh_of(thing)
    paints = list(thing.iter("triangle"))
    expect("pid", {t.get("pid") for t in paints}, {group})
    codes = [colors[int(t.get("p1"))] for t in paints]
    check_triangles(points, triangles, None, codes)
    check_like_ply(ply, points, triangles, codes)


def read_lattice(path):
    root, group, colors, things = read_model(path)
    check_text("requiredextensions", root.get("requiredextensions"), "b")
    thing = things[root.find("build/item").get("objectid")]
    lattice = thing.find("mesh/beamlattice")
    points = np.array([[float(v.get(axis)) for axis in "xyz"] for v in thing.iter("vertex")])
    expect("cap", lattice.get("cap"), "sphere")
    beams = list(lattice.iter("beam"))
    expect("beams", len(beams), len(SEGMENTS))
    for beam, segment in zip(beams, SEGMENTS):
        a, b = ends(segment)
        expect("v1", points[int(beam.get("v1"))], a)
        expect("v2", points[int(beam.get("v2"))], b)
        expect("r1", float(beam.get("r1")), radius(segment))
        expect("minlength", float(lattice.get("minlength")) < np.linalg.norm(b - a), np.True_)
        expect("pid", beam.get("pid"), group)
        for end in ("p1", "p2"):
            expect(end, list(colors[int(beam.get(end))]), list(code(segment)))
    preview = things[lattice.get("representationmesh")]
    points, triangles = mesh_of(preview)
    paints = [colors[int(t.get("p1"))] for t in preview.iter("triangle")]
    for i, segment in enumerate(SEGMENTS):  # a prism of 12 triangles each
        a, b = ends(segment)
        axis = (b - a) / np.linalg.norm(b - a)
        corners = np.array(points)[np.unique(triangles[12 * i:12 * i + 12])]
        off = corners - a - ((corners - a) @ axis)[:, None] * axis
        expect("corners of the preview", np.linalg.norm(off, axis=1), np.full(8, radius(segment)), 1e-3)
        expect("paints of the preview", [list(p) for p in paints[12 * i:12 * i + 12]], [list(code(segment))] * 12)


def read_stl(path):
    data = open(path, "rb").read()
    n = struct.unpack("<I", data[80:84])[0]
    rows = np.frombuffer(data, np.dtype([("normal", "<f4", 3), ("v", "<f4", (3, 3)), ("attribute", "<u2")]), n, 84)
    expect("length", len(data), 84 + 50 * n)
    check_text("header", data[:80].decode("latin-1"), "corcast")
    expect("header", data[:5] == b"solid", False)
    points, triangles = np.unique(rows["v"].reshape(-1, 3), axis=0, return_inverse=True)
    check_triangles(points, triangles.reshape(-1, 3))
    corners = rows["v"].astype(float)
    turned = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    turned /= np.linalg.norm(turned, axis=1)[:, None]
    expect("normals", (turned * rows["normal"]).sum(axis=1), np.ones(n), 1e-3)
    expect("attributes", set(rows["attribute"].tolist()), {0})


def end_of(name):
    """The node and the segment of a named end, which has the segment's id: an inlet is where that one begins."""
    segment = int(name.split("_")[1])
    return (NODES[segment][0] if name.startswith("inlet") else segment), segment


def check_faces(names, faces, middle, normals):
    """Each named face except the wall lies in the plane of its end, turned outwards."""
    expect("names of parts", sorted(names), sorted(["wall", "inlet_012", "inlet_022"] +
                                                   [f"outlet_{i:03d}" for i in FREE if NODES[i][0]]))
    for i, face in enumerate(faces):
        name = names[face]
        if name == "wall":
            continue
        node, segment = end_of(name)
        a, b = ends(segment)
        out = (b - a if node == segment else a - b) / np.linalg.norm(b - a)
        expect(f"a triangle of {name}", [(middle[i] - at(node)) @ out, normals[i] @ out], [0, 1], 2e-3)


def read_parts(path):
    """STL as text, a solid for each part."""
    names, faces, corners, normals = [], [], [], []
    for words in map(str.split, open(path)):
        if words[0] == "solid":
            names.append(words[1])
        elif words[0] == "facet":
            faces.append(len(names) - 1)
            normals.append([float(w) for w in words[2:]])
        elif words[0] == "vertex":
            corners.append([float(w) for w in words[1:]])
        elif words[0] == "endsolid":
            expect("endsolid", words[1], names[-1])
    points, triangles = np.unique(np.array(corners), axis=0, return_inverse=True)
    check_triangles(points, triangles.reshape(-1, 3))
    middle = np.array(corners).reshape(-1, 3, 3).mean(axis=1)
    check_faces(names, faces, middle, np.array(normals))
    return names


def read_vtp(path):
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(path)
    reader.Update()
    data = reader.GetOutput()
    points = vtk_to_numpy(data.GetPoints().GetData()).astype(float)
    triangles = vtk_to_numpy(data.GetPolys().GetData()).reshape(-1, 4)[:, 1:]
    cells = data.GetCellData()
    faces, segments = (vtk_to_numpy(cells.GetArray(name)) for name in ("ModelFaceID", "segment"))
    names = data.GetFieldData().GetAbstractArray("FaceNames")
    names = [names.GetValue(i) for i in range(names.GetNumberOfValues())]
    about = data.GetFieldData().GetAbstractArray("About")
    about = [about.GetValue(i) for i in range(about.GetNumberOfValues())]
    expect("About's unit", about[3], "mm")
    for line, word in zip(about, ("corcast ", "arterial tree tree.csv", "corcast export tree.csv")):
        check_text("About", line, word)
    expect("normals", data.GetPointData().GetNumberOfArrays(), 0)
    check_triangles(points, triangles, segments)
    corners = points[triangles]
    turned = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    check_faces(names, faces - 1, corners.mean(axis=1), turned / np.linalg.norm(turned, axis=1)[:, None])
    check_caps(corners.mean(axis=1), faces > 1, segments)


def read_ends(path):
    rows = [line.strip().split(",") for line in open(path) if line[0] != "#"]
    for row in (dict(zip(rows[0], row)) for row in rows[1:]):
        number = {key: float(row[key]) for key in row if key != "name"}
        segment = int(number["id"])
        node, named = end_of(row["name"])
        a, b = ends(segment)
        out = (b - a if node == segment else a - b) / np.linalg.norm(b - a)
        expect("id", segment, named)
        expect("place", [number[key] for key in ("x_mm", "y_mm", "z_mm")], at(node), 1e-9)
        expect("normal", [number["normal_" + axis] for axis in "xyz"], out, 1e-9)
        expect("radius_mm", number["radius_mm"], radius(segment), 1e-9)
        expect("area_mm2", number["area_mm2"] / (math.pi * radius(segment) ** 2), 1, 0.02)


def record_blender(path):
    """Runs the script with a bpy that only records."""
    made = types.SimpleNamespace(materials=[], objects=[], linked=[])

    class Points(list):
        def add(self, n):
            self.extend(types.SimpleNamespace(co=None, radius=None) for _ in range(n))

    class Splines(list):
        def new(self, kind):
            self.append(types.SimpleNamespace(kind=kind, points=Points([types.SimpleNamespace()]), material_index=0))
            return self[-1]

    class Thing(dict):
        def __init__(self, name, data):
            super().__init__()
            self.name, self.data, self.parent = name, data, None

    def new_material(name):
        node = types.SimpleNamespace(type="BSDF_PRINCIPLED", inputs={
            key: types.SimpleNamespace(default_value=None) for key in ("Base Color", "Roughness", "Metallic")})
        made.materials.append(types.SimpleNamespace(name=name, node_tree=types.SimpleNamespace(nodes=[node])))
        return made.materials[-1]

    def new_object(name, data):
        made.objects.append(Thing(name, data))
        return made.objects[-1]

    data = types.SimpleNamespace(
        materials=types.SimpleNamespace(new=new_material), objects=types.SimpleNamespace(new=new_object),
        curves=types.SimpleNamespace(
            new=lambda name, kind: types.SimpleNamespace(name=name, kind=kind, splines=Splines(), materials=[])))
    scene = types.SimpleNamespace(collection=types.SimpleNamespace(objects=types.SimpleNamespace(link=made.linked.append)))
    sys.modules["bpy"] = types.SimpleNamespace(data=data, context=types.SimpleNamespace(scene=scene))
    exec(compile(open(path).read(), path, "exec"), {})
    return made


def read_py(path, phong_size):
    made = record_blender(path)
    rough = (2 / (4 * phong_size + 2)) ** 0.25
    for each in made.materials:
        codes = bytes.fromhex(each.name.removeprefix("vessel_"))
        inputs = each.node_tree.nodes[0].inputs
        expect("diffuse_color", each.diffuse_color, [*linear(list(codes)), 1], 3e-3)
        expect("Base Color", inputs["Base Color"].default_value, [*linear(list(codes)), 1], 3e-3)
        expect("roughness", [each.roughness, inputs["Roughness"].default_value], [rough, rough], 1e-6)
    expect("linked objects", [o.name for o in made.linked], [o.name for o in made.objects])
    root = made.objects[0]
    expect("the empty", [root.name, root.data, root["unit"]], ["tree", None, "mm"])
    check_text("command", root["command"], "corcast export tree.csv")
    expect("rotation and scale", [*root.rotation_euler, *root.scale], [math.pi / 2, 0, 0, 0.001, 0.001, 0.001], 1e-12)
    segments = []
    for thing in made.objects[1:]:
        curve = thing.data
        expect("name", [thing.name, curve.name], [f"tree_{thing['tree']}_order_{thing['strahler_order']}"] * 2)
        expect("parent", thing.parent is root, True)
        expect("curve", [curve.kind, curve.dimensions, curve.fill_mode, curve.bevel_depth, curve.use_fill_caps],
               ["CURVE", "3D", "FULL", 1, True])
        for spline, first in zip(curve.splines, thing["segment_ids"]):
            expect("kind of spline", spline.kind, "POLY")
            rows = np.array([[*p.co, p.radius] for p in spline.points])
            expect("w", rows[:, 3], np.ones(len(rows)))
            name = curve.materials[spline.material_index].name
            segments += check_line(rows[:, :3], rows[:, 4], first, [name] * len(rows), thing["tree"],
                                   thing["strahler_order"], lambda s: "vessel_%02X%02X%02X" % code(s))
    expect("segments", sorted(segments), SEGMENTS)


def check_line(points, radii, first, colors, tree, order, color_of):
    """Points of a curve from the start of segment `first` on; returns the ids of its segments."""
    segments, segment = [], first
    expect("the start of a curve", points[0], ends(first)[0])
    expect("the first radius", radii[0], radius(first))
    for k in range(1, len(points)):
        if k > 1:
            segment = next(s for s in SEGMENTS if NODES[s][0] == segment and np.array_equal(at(s), points[k]))
        expect("a point", points[k], at(segment))
        expect("a radius", radii[k], radius(segment))
        expect("tree and order", [tree, order], [TREE[segment], ORDER[segment]])
        expect("a color", colors[k], color_of(segment))
        segments.append(segment)
    return segments


def read_usda(path):
    text = open(path).read()
    check_text("head", text, "#usda 1.0\n", "metersPerUnit = 0.001", 'upAxis = "Y"', 'defaultPrim = "tree"',
               'string generator = "corcast ', 'string command = "corcast export tree.csv')
    segments = []
    for prim in text.split("def BasisCurves ")[1:]:
        def numbers(name):
            found = re.search(re.escape(name) + r" = \[(.*?)\]", prim, re.S)[1]
            return np.array([float(x) for x in re.findall(r"[-+0-9.e]+", found)])
        order, tree = (int(re.search(f"int {name} = (\\d+)", prim)[1]) for name in ("strahlerOrder", "tree"))
        expect("name", prim.split('"')[1], f"tree_{tree}_order_{order}")
        check_text("kind of curves", prim, 'token type = "linear"', 'token wrap = "nonperiodic"',
                   'interpolation = "vertex"')
        cuts = numbers("curveVertexCounts").astype(int).cumsum()[:-1]
        rows = np.column_stack([numbers("points").reshape(-1, 3), numbers("widths"),
                                numbers("displayColor").reshape(-1, 3), numbers("primvars:segment")])
        for part in np.split(rows, cuts):
            codes = [tuple(np.round(255 * np.where(c <= 0.0031308, 12.92 * c, 1.055 * c ** (1 / 2.4) - 0.055))
                           .astype(int).tolist()) for c in part[:, 4:7]]
            found = check_line(part[:, :3], part[:, 3] / 2, int(part[0, 7]), codes, tree, order, code)
            expect("primvars:segment", part[:, 7], [found[0], *found])
            segments += found
        low = np.min([np.minimum(*ends(s)) - radius(s) for s in found_of(rows)], axis=0)
        high = np.max([np.maximum(*ends(s)) + radius(s) for s in found_of(rows)], axis=0)
        expect("extent", numbers("extent"), [*low, *high], 1e-3)
    expect("segments", sorted(segments), SEGMENTS)


def found_of(rows):
    return {int(s) for s in rows[:, 7]}


def read_html(path):
    text = open(path).read()

    def block(name, kind):
        found = re.search(f'<script type="text/plain" id="{name}">(.*?)</script>', text, re.S)[1]
        return np.frombuffer(base64.b64decode(found), kind)

    told = json.loads(re.search(r'<script type="application/json"[^>]*>(.*?)</script>', text, re.S)[1])
    check_text("told", json.dumps(told), "corcast ", "corcast export tree.csv")
    ids = block("id", "<u4")
    expect("id", ids, list(NODES))
    expect("position", block("position", "<f4").reshape(-1, 3) + np.array(told["origin"]),
           np.array([at(i) for i in NODES]), 1e-4)
    expect("origin near the tree", np.linalg.norm(np.array(told["origin"]) - at(13)) < 60, np.True_)
    expect("radius", block("radius", "<f4"), [NODES[i][4] for i in NODES])
    expect("parent", ids[block("parent", "<u4")], [NODES[i][0] or i for i in NODES])
    for k, field in enumerate(told["fields"]):
        values = block(f"field-{k}", "<u2" if field["whole"] else "<f4").astype(float)
        values[values == 65535] = math.nan
        known = {"load": LOAD, "strahler": ORDER, "tree": TREE, "radius": {s: radius(s) for s in SEGMENTS},
                 "rank": RANK}.get(field["name"])
        if known:
            expected = np.array([known.get(i, math.nan) for i in NODES])
            expect("values without a number of " + field["name"], np.isnan(values), np.isnan(expected))
            expect("values of " + field["name"], np.nan_to_num(values), np.nan_to_num(expected), 1e-6)
    names = {field["name"]: field for field in told["fields"]}
    expect("fields", {"load", "radius", "strahler", "tree", "rank"} <= set(names), True)
    expect("units", [names["load"]["unit"], names["radius"]["unit"]], ["", "mm"])
    expect("whole", [names[name]["whole"] for name in ("load", "strahler", "rank")], [False, True, True])
    expect("start", told["start"], {"field": "load", "map": "magma", "kind": "log", "low": 2, "high": 9})
    maps = {each["name"]: k for k, each in enumerate(told["maps"])}
    for name, low, high in (("viridis", LOW, HIGH), ("magma", (0, 0, 4), (252, 253, 191))):
        codes = block(f"map-{maps[name]}", "u1").reshape(-1, 3)
        expect("ends of " + name, [*codes[0], *codes[-1]], [*low, *high])
    expect("separate", [told["maps"][maps[name]]["separate"] for name in ("viridis", "Set1")], [False, True])
    look = told["look"]
    found = [look[key] for key in ("ambient", "diffuse", "specular", "roughness")]
    expect("finish", found, [0.14, 0.72, 0.5, 0.022], 1e-6)
    expect("look", look["name"], "cast")
    expect("lights", [light["point"] for light in look["lights"]], [False, False])
    expect("directions", np.array([light["direction"] for light in look["lights"]]),
           [[-0.22, 0.3, 1], [1.3, 0.5, -0.7]], 1e-6)
    expect("colors of lights", np.array([light["color"] for light in look["lights"]]),
           [[0.97, 0.94, 0.89], [0.9, 0.7, 0.6]], 1e-6)


def filled(points, reach):
    """Which points lie so deep in a vessel, or with a negative reach so far outside, that no sample can say otherwise."""
    depth = np.full(len(points), -np.inf)
    label = np.zeros(len(points), int)
    for segment in SEGMENTS:
        a, b = ends(segment)
        t = np.clip((points - a) @ (b - a) / ((b - a) @ (b - a)), 0, 1)
        own = radius(segment) - np.linalg.norm(points - (a + t[:, None] * (b - a)), axis=1)
        label = np.where(own > depth, segment, label)
        depth = np.maximum(depth, own)
    return depth > reach, depth < -reach, label


def check_volume(what, samples, first, steps, full):
    """samples[x, y, z] of voxels whose first centre and steps are in the tree's coordinates."""
    grid = np.stack(np.meshgrid(*(np.arange(n) for n in samples.shape), indexing="ij"), axis=-1).reshape(-1, 3)
    inside, outside, _ = filled(first + grid * steps, 1.05 * np.linalg.norm(steps) / 2)
    values = samples.reshape(-1)
    expect(what + ": samples deep inside", values[inside], np.full(inside.sum(), full), 1e-6)
    expect(what + ": samples outside", values[outside], np.zeros(outside.sum()))
    expect(what + ": voxels deep inside", inside.sum() > 200 and (~inside & (values > 0)).sum() > 200, np.True_)


STEPS = np.array([0.5, 0.75, 0.625])


def read_volumes(base, manifest):
    import nibabel
    said = json.load(open(manifest))
    first = np.array(said["first_voxel_mm"])
    expect("voxel_mm", said["voxel_mm"], STEPS)
    expect("model, unit", [said["model"], said["unit"], said["segments"]], ["rounded", "mm", len(SEGMENTS)])
    image = nibabel.load(base + ".nii.gz")
    header, samples = image.header, np.asarray(image.dataobj)
    expect("voxels", said["voxels"], list(samples.shape))
    expect("affine", image.affine, np.vstack([np.column_stack([np.diag(STEPS), first]), [0, 0, 0, 1]]), 1e-4)
    expect("qform", image.get_qform(), image.affine, 1e-4)
    expect("codes", [int(header["sform_code"]), int(header["qform_code"])], [1, 1])
    expect("zooms", header.get_zooms(), STEPS, 1e-6)
    expect("units", header.get_xyzt_units()[0], "mm")
    expect("type and slope", [header.get_data_dtype().name, said["full"], round(1 / float(header["scl_slope"]))],
           ["uint8", 255, 255]) if not math.isnan(float(header["scl_slope"])) else None
    check_volume("NIfTI", samples, first, STEPS, 1)
    raw = np.asarray(image.dataobj.get_unscaled())
    expect("filled_voxels", said["filled_voxels"], int((raw > 0).sum()))
    expect("volume_mm3", said["volume_mm3"], raw.sum() / 255 * STEPS.prod(), 1e-6)
    labels = nibabel.load(base + ".labels.nii.gz")
    expect("intent", labels.header.get_intent()[0], "label")
    expect("affine of labels", labels.affine, image.affine)
    grid = np.stack(np.meshgrid(*(np.arange(n) for n in samples.shape), indexing="ij"), axis=-1).reshape(-1, 3)
    found = np.asarray(labels.dataobj).reshape(-1)
    expect("labels where nothing is", int((found[raw.reshape(-1) == 0] > 0).sum()), 0)
    wall, _, place = walls(first + grid * STEPS)
    inside, _, nearest = filled(first + grid * STEPS, 0.45)
    clear = inside & (place > 0.4) & (place < 0.6)
    expect("labels", found[clear], nearest[clear])
    expect("labels that were compared", {int(s) for s in nearest[clear]} >= {12, 13, 15, 22}, True)

    head, body = open(base + ".nrrd", "rb").read().split(b"\n\n", 1)
    fields = dict(line.split(": ", 1) for line in head.decode().split("\n") if ": " in line and line[0] != "#")
    expect("NRRD's fields", [fields[key] for key in ("type", "dimension", "space", "encoding", "kinds", "space units")],
           ["uint8", "3", "right-anterior-superior", "gzip", "domain domain domain", '"mm" "mm" "mm"'])
    vectors = [[float(x) for x in v.split(",")] for v in re.findall(r"\(([^)]*)\)", fields["space directions"])]
    expect("space directions", vectors, np.diag(STEPS))
    expect("space origin", [float(x) for x in fields["space origin"].strip("()").split(",")], first)
    sizes = [int(x) for x in fields["sizes"].split()]
    expect("sizes", sizes, list(samples.shape))
    expect("old max and min", [fields["old max"], fields["old min"]], ["255", "0"])
    expect("NRRD's samples", np.frombuffer(gzip.decompress(body), "u1").reshape(sizes, order="F"), raw)

    head, body = open(base + ".mha", "rb").read().split(b"ElementDataFile = LOCAL\n", 1)
    fields = dict(line.split(" = ", 1) for line in head.decode().strip().split("\n"))
    expect("MetaImage's fields", [fields[key] for key in ("ObjectType", "NDims", "BinaryData", "BinaryDataByteOrderMSB",
           "CompressedData", "ElementType", "AnatomicalOrientation")],
           ["Image", "3", "True", "False", "False", "MET_UCHAR", "LPI"])
    row = lambda key: np.array([float(x) for x in fields[key].split()])
    expect("DimSize", row("DimSize"), np.array(samples.shape))
    expect("ElementSpacing", row("ElementSpacing"), STEPS)
    turn = row("TransformMatrix").reshape(3, 3)  # each row is the direction of an axis, in left-posterior-superior
    to_ras = np.diag([-1, -1, 1])
    expect("TransformMatrix", turn @ to_ras, np.eye(3))
    expect("Offset", to_ras @ row("Offset"), first)
    expect("MetaImage's samples", np.frombuffer(body, "u1").reshape(samples.shape, order="F"), raw)

    data = open(base + ".df3", "rb").read()
    expect("sizes of the density file", struct.unpack(">HHH", data[:6]), tuple(samples.shape))
    expect("its samples", np.frombuffer(data[6:], "u1").reshape(samples.shape, order="F"), raw)


def read_csg(path, source):
    """What OpenSCAD makes of the model: a tree of matrices about cylinders and spheres."""
    text = open(source).read()
    expect("calls of vessel()", sorted(int(i) for i in re.findall(r"^\s*vessel\((\d+),", text, re.M)), SEGMENTS)
    stack, color, found, balls = [np.eye(4)], [], [], []
    for line in open(path):
        line = line.strip()
        if line.startswith("multmatrix("):
            stack.append(stack[-1] @ np.array(json.loads(line[len("multmatrix("):line.index(") {")])))
        elif line.startswith("color("):
            color.append(json.loads(line[len("color("):line.index(") {")])[:3])
            stack.append(stack[-1])
        elif line.endswith("{"):
            stack.append(stack[-1])
        elif line == "}":
            stack.pop()
        number = lambda key: float(re.search(rf"\b{key} = ([-0-9.e]+)", line)[1])
        if line.startswith("cylinder("):
            expect("radii of a cylinder", number("r1"), number("r2"))
            a, b = (stack[-1] @ [0, 0, z, 1] for z in (0, number("h")))
            found.append((a[:3], b[:3], number("r1"), color[-1]))
        elif line.startswith("sphere("):
            balls.append((stack[-1][:3, 3], number("r"), color[-1]))
    expect("cylinders", len(found), len(SEGMENTS))
    for (a, b, r, c), segment in zip(sorted(found, key=lambda row: tuple(np.round(row[1], 2))),
                                     sorted(SEGMENTS, key=lambda s: tuple(at(s)))):
        expect("a cylinder", [*a, *b, r], [*ends(segment)[0], *ends(segment)[1], radius(segment)], 1e-3)
        expect("its color", c, np.array(code(segment)) / 255, 2e-3)
    expect("balls", len(balls), len(NODES))
    for node in NODES:
        meeting = [s for s in SEGMENTS if node in (s, NODES[s][0])]
        thickest = max(meeting, key=lambda s: (radius(s), s == node))
        centre, r, c = min(balls, key=lambda ball: np.linalg.norm(ball[0] - at(node)))
        expect("a ball", [*centre, r], [*at(node), radius(thickest)], 1e-3)
        expect("its color", c, np.array(code(thickest)) / 255, 2e-3)


def read_mesh2(path, ply):
    """The meshes of an exported .inc, one for each tree, with paints and without; POV-Ray reads them in other tests."""
    points, painted, plain, all_paints = [], [], [], []
    for part in open(path).read().split("mesh2 {")[1:]:
        def rows(name, start=0):
            body = part[part.index(name + " {", start) + len(name) + 2:]
            body = body[:body.index("\n  }")]
            found = re.findall(r"<([^>]*)>((?:\s*,\s*\d+)*)", body)
            expect("the count of " + name, int(body.split(",")[0]), len(found))
            return found
        first = len(points)
        points += [[float(x) for x in row.split(",")] for row, _ in rows("vertex_vectors")]
        paints = re.findall(r"Vessel_Paint\(([^,]*),(\d+),(\d+),([^,]*),<([^>]*)>",
                            part[:part.index("face_indices")])
        for size, segment, order, value, color in paints:
            segment = int(segment)
            expect("radius and order of a paint", [float(size), int(order)], [radius(segment), ORDER[segment]])
            expect("value of a paint", value if segment not in LOAD else float(value), LOAD.get(segment, "Value_None"))
            expect("color of a paint", [float(x) for x in color.split(",")], linear(code(segment)), 3e-3)
        all_paints += [int(paint[1]) for paint in paints]
        corners = lambda row: [first + int(x) for x in row[0].split(",")]
        painted += [(corners(row), int(paints[int(re.findall(r"\d+", row[1])[0])][1])) for row in rows("face_indices")]
        plain += [corners(row) for row in rows("face_indices", part.index("#else"))]
    expect("paints", all_paints, SEGMENTS)
    check_triangles(points, [row for row, _ in painted], [segment for _, segment in painted])
    expect("faces without paints", plain, [row for row, _ in painted])
    check_like_ply(ply, points, plain, [code(segment) for _, segment in painted])


def read_tachyon(path):
    """The look has the numbers below; the view is the front, so that the camera's axes are the world's."""
    text = open(path).read()
    origin = np.array([float(x) for x in re.search(r"about <(.*?)> of the tree", text)[1].split(",")])
    numbers = lambda line: [float(x) for x in re.findall(r"(?<![\w])-?[0-9.]+(?:e-?\d+)?", line)]
    line = lambda start: numbers(re.search(f"^ *{start} (.*)", text, re.M)[1])
    expect("RESOLUTION", line("RESOLUTION"), [61, 43])
    check_text("camera", text, "PROJECTION ORTHOGRAPHIC", "ANTIALIASING 3 ", "RAYDEPTH 1")
    expect("VIEWDIR and UPDIR", [line("VIEWDIR"), line("UPDIR")], [[0, 0, -1], [0, 1, 0]])
    right, left, bottom, top = line("FRUSTUM")
    expect("FRUSTUM", (right - left) / (top - bottom), 61 / 43, 1e-6)
    expect("BACKGROUND", line("BACKGROUND"), [0.25, 0.5, 0.75])
    key = -np.array([-0.22, 0.3, 1])
    expect("DIRECTIONAL_LIGHT", line("DIRECTIONAL_LIGHT"), [*key / np.linalg.norm(key), 0.9, 0.8, 0.7], 1e-6)
    low = np.min([np.minimum(*ends(s)) - radius(s) for s in SEGMENTS], axis=0) - origin
    high = np.max([np.maximum(*ends(s)) + radius(s) for s in SEGMENTS], axis=0) - origin
    half = np.linalg.norm(high - low) / 2
    expect("LIGHT", line("LIGHT"), [*(low + high) / 2 + half * np.array([3, 2, 5]), 0, 0.3, 0.4, 0.5], 1e-3)
    expect("TEXDEF of the ground", line("TEXDEF ground"), [0.15, 0.55, 0, 1, 0, 40, 0.4, 0.6, 0.8, 0])
    normal = np.array([0.1, 0.2, 1]) / np.linalg.norm([0.1, 0.2, 1])
    offset = min((end - origin) @ normal - radius(s) for s in SEGMENTS for end in ends(s)) - 0.3 * half
    expect("PLANE", line("PLANE"), [*offset * normal, *normal], 1e-3)
    for segment in SEGMENTS:
        expect("TEXDEF of a vessel", line(f"TEXDEF v{segment}"),
               [0.2, 0.6, 0, 1, 0.3, 17, *linear(code(segment)), 0], 3e-3)
    rows = re.findall(r"^(FCYLINDER|SPHERE|RING) (.*) v(\d+)$", text, re.M)
    cylinders = [(numbers(row), int(i)) for kind, row, i in rows if kind == "FCYLINDER"]
    expect("segments", [i for _, i in cylinders], SEGMENTS)
    for row, i in cylinders:
        expect("FCYLINDER", row, [*ends(i)[0] - origin, *ends(i)[1] - origin, radius(i)], 1e-5)
    balls = [(numbers(row), int(i)) for kind, row, i in rows if kind == "SPHERE"]
    expect("SPHERE", sorted(row for row, _ in balls), sorted(
        [*(at(node) - origin).tolist(), max(radius(s) for s in SEGMENTS if node in (s, NODES[s][0]))] for node in NODES))
    expect("radii of balls", [row[3] for row, _ in balls], [radius(i) for _, i in balls])
    for row, i in [(numbers(row), int(i)) for kind, row, i in rows if kind == "RING"]:
        a, b = ends(i)
        out = (b - a) / np.linalg.norm(b - a)
        at_end = min((a, b), key=lambda end: np.linalg.norm(end - origin - row[:3]))
        expect("RING", [*row[:3], abs(np.dot(row[3:6], out)), *row[6:]], [*at_end - origin, 1, -1, radius(i)], 1e-5)


def write_tree(folder):
    with open(folder + "/tree.csv", "w") as out:
        print("id,parent,x_mm,y_mm,z_mm,radius_mm,rank", file=out)
        for i, (parent, *rest) in NODES.items():
            print(i, parent or -1, *rest, RANK.get(i, ""), sep=",", file=out)
    with open(folder + "/load.csv", "w") as out:
        print("id,load", file=out)
        for segment in SEGMENTS:
            print(segment, LOAD.get(segment, ""), sep=",", file=out)


READERS = {
    "tree": write_tree, "ply": read_ply, "obj": read_obj, "3mf": read_3mf, "lattice": read_lattice, "stl": read_stl,
    "parts": read_parts, "vtp": read_vtp, "ends": read_ends, "usda": read_usda, "html": read_html,
    "volumes": read_volumes, "csg": read_csg, "mesh2": read_mesh2,
    "tachyon": read_tachyon,
    "py": lambda path, phong: read_py(path, float(phong)),
    "glb": lambda path, phong: read_glb(path, True, float(phong), None),
    "glb-plain": lambda path, phong, *look: read_glb(path, False, float(phong), [float(x) for x in look]),
}

READERS[sys.argv[1]](*sys.argv[2:])
