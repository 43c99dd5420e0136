"""Reads a 3MF with lib3mf 1.8, through its C interface, and prints JSON of its mesh objects: triangles, whether they are
closed, and of a beam lattice the beams, their radii, and what represents it.

    read_lattice.py FILE
"""
import ctypes
import json
import math
import sys

lib = ctypes.CDLL("lib3MF.so.1")


class Vertex(ctypes.Structure):
    _fields_ = [("at", ctypes.c_float * 3)]


class Beam(ctypes.Structure):
    _fields_ = [("nodes", ctypes.c_uint32 * 2), ("radii", ctypes.c_double * 2), ("caps", ctypes.c_int * 2)]


def call(name, *arguments):
    result = getattr(lib, "lib3mf_" + name)(*arguments)
    if result != 0:
        sys.exit(f"lib3mf_{name} fails: {result & 0xffffffff:#x}")


def get(name, kind, *arguments):
    value = kind()
    call(name, *arguments, ctypes.byref(value))
    return value.value if hasattr(value, "value") and kind is not ctypes.c_void_p else value


def beams(mesh):
    """Nodes, radii and ends of caps of each, and its length."""
    for i in range(get("meshobject_getbeamcount", ctypes.c_uint32, mesh)):
        beam = get("meshobject_getbeam", Beam, mesh, ctypes.c_uint32(i))
        ends = [list(get("meshobject_getvertex", Vertex, mesh, ctypes.c_uint32(node)).at) for node in beam.nodes]
        yield {"nodes": list(beam.nodes), "radii": list(beam.radii), "caps": list(beam.caps), "length": math.dist(*ends)}


def described(mesh):
    has, of = ctypes.c_int(), ctypes.c_uint32()
    call("meshobject_getbeamlattice_representation", mesh, ctypes.byref(has), ctypes.byref(of))
    return {
        "id": get("resource_getresourceid", ctypes.c_uint32, mesh),
        "triangles": get("meshobject_gettrianglecount", ctypes.c_uint32, mesh),
        "closed": bool(get("meshobject_ismanifoldandoriented", ctypes.c_int, mesh)),
        "represented_by": of.value if has.value else None,
        "minlength": get("meshobject_getbeamlattice_minlength", ctypes.c_double, mesh),
        "beams": list(beams(mesh)),
    }


model = get("createmodel", ctypes.c_void_p)
reader = get("model_queryreader", ctypes.c_void_p, model, b"3mf")
call("reader_readfromfileutf8", reader, sys.argv[1].encode())
objects = get("model_getmeshobjects", ctypes.c_void_p, model)
found = []
while get("resourceiterator_movenext", ctypes.c_int, objects):
    found.append(described(get("resourceiterator_getcurrent", ctypes.c_void_p, objects)))
json.dump({"warnings": get("reader_getwarningcount", ctypes.c_uint32, reader), "objects": found}, sys.stdout)
