# Runs inside Blender for blender_test.sh. `measure FILE...` prints for each file triangles, volume
# in mm^3, parts and open edges. `draw FILE PICTURE` draws a GLB or a script with 500 x 500 pixels,
# 100 mm high, viewed along -z with y up, the sun behind the camera, transparent where nothing is
# visible.
import sys

import bpy
import numpy

numpy.bool = bool  # which Blender 3.4's importer of glTF asks of a numpy that no longer has it


def make_meshes():
    """Puts meshes in the place of all curves, as they are drawn."""
    bpy.context.view_layer.update()
    graph = bpy.context.evaluated_depsgraph_get()
    for o in [o for o in bpy.data.objects if o.type == "CURVE"]:
        made = bpy.data.objects.new(o.name, bpy.data.meshes.new_from_object(o.evaluated_get(graph)))
        made.matrix_world = o.matrix_world
        bpy.context.scene.collection.objects.link(made)
        bpy.data.objects.remove(o)


def read(path):
    """Reads a file into an empty scene: its meshes, and how many mm a unit of it is."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    if path.endswith(".py"):
        exec(compile(open(path).read(), path, "exec"), {})
        make_meshes()
    elif path.endswith(".glb"):
        bpy.ops.import_scene.gltf(filepath=path)
    elif path.endswith(".obj"):
        bpy.ops.wm.obj_import(filepath=path)
    elif path.endswith(".ply"):
        bpy.ops.import_mesh.ply(filepath=path)
    else:
        bpy.ops.import_mesh.stl(filepath=path)
    return [o for o in bpy.data.objects if o.type == "MESH"], 1000 if path.endswith((".glb", ".py")) else 1


def corners(objects):
    """Of all triangles the numbers of their corners, and the points, each of which is there once."""
    points = []
    for o in objects:
        at = numpy.array([o.matrix_world @ v.co for v in o.data.vertices])
        o.data.calc_loop_triangles()
        points.append(at[numpy.array([triangle.vertices for triangle in o.data.loop_triangles])])
    points, numbers = numpy.unique(numpy.concatenate(points).reshape(-1, 3), axis=0, return_inverse=True)
    return points, numbers.reshape(-1, 3)


def parts(triangles):
    """How many parts hang together by their corners."""
    label = numpy.arange(triangles.max() + 1)
    while True:
        lowest = label.copy()
        numpy.minimum.at(lowest, triangles, label[triangles].min(axis=1)[:, None])
        lowest = lowest[lowest]
        if (lowest == label).all():
            return len(numpy.unique(label))
        label = lowest


def open_edges(triangles):
    """How many edges are not passed once in each direction."""
    ways = numpy.concatenate([triangles[:, [k, (k + 1) % 3]] for k in range(3)])
    there, times = numpy.unique(ways, axis=0, return_counts=True)
    back, _ = numpy.unique(ways[:, ::-1], axis=0, return_counts=True)
    return (times > 1).sum() + len(numpy.setdiff1d(there @ [1 << 32, 1], back @ [1 << 32, 1]))


def measure(path):
    """A GLB has a mesh for each order, which meet in points at one place."""
    objects, unit = read(path)
    points, triangles = corners(objects)
    a, b, c = (points[triangles[:, k]] for k in range(3))
    volume = (a * numpy.cross(b, c)).sum() / 6 * unit**3
    print("MEASURED", path, len(triangles), volume, parts(triangles), open_edges(triangles))


def draw(path, picture):
    read(path)
    scene = bpy.context.scene
    camera = bpy.data.cameras.new("camera")
    camera.type, camera.ortho_scale, camera.clip_start = "ORTHO", 0.1, 0.001
    eye = bpy.data.objects.new("camera", camera)
    eye.location, eye.rotation_euler = (0, -0.1, 0), (numpy.pi / 2, 0, 0)
    scene.collection.objects.link(eye)
    scene.camera = eye
    sun = bpy.data.objects.new("sun", bpy.data.lights.new("sun", "SUN"))
    sun.data.energy, sun.rotation_euler = 3, eye.rotation_euler
    scene.collection.objects.link(sun)
    scene.view_settings.view_transform = "Standard"  # sRGB
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising = 1, False
    scene.cycles.pixel_filter_type, scene.cycles.filter_width = "BLACKMAN_HARRIS", 0.01  # the pixel's middle
    scene.render.film_transparent = True
    scene.render.resolution_x = scene.render.resolution_y = 500
    scene.render.filepath = picture
    bpy.ops.render.render(write_still=True)


command, *files = sys.argv[sys.argv.index("--") + 1:]
if command == "measure":
    for file in files:
        measure(file)
else:
    draw(*files)
