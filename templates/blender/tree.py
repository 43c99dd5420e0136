# ${description}
# ${generator}: ${command}
#
# Vessels as curves for Blender 2.8 and later: blender -P ${input}
# or open this file in the text editor and run it. Coordinates and radii are millimetres, y is up:
# ${extent}.
#
# The empty "tree" scales millimetres to metres and turns y up into z up, as Blender has it. Below it
# is one curve object per Strahler order, or in a forest per tree and order. Its splines are vessels,
# with a radius at each point. Bevel > Depth is 1 and must stay 1. A spline ends where the order ends
# or the material changes. The property segment_ids has the ids of the first segments of the splines.
# Nothing else in the scene is changed.
#
# Options: blender -P ${input} -- --scale 0.1 --camera
# --scale sets the metres per millimetre; 0.1 suits the camera and light of Blender's default scene.
# --camera adds a camera that frames the tree from the front, and a sun.
import argparse
import math
import sys

import bpy


def arguments():
    """The arguments after "--"."""
    options = argparse.ArgumentParser(prog="tree.py")
    options.add_argument("--scale", type=float, default=0.001)
    options.add_argument("--camera", action="store_true")
    return options.parse_known_args(sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else [])[0]


ARGUMENTS = arguments()
SCALE = ARGUMENTS.scale  # metres per millimetre
BEVEL = 6  # Bevel > Resolution: 16 sides
ROUGHNESS = ${roughness}


def material(name, color):
    """A material of linear RGB, which the viewport shows, too."""
    made = bpy.data.materials.new(name)
    made.diffuse_color, made.roughness = (*color, 1), ROUGHNESS
    made.use_nodes = True
    for node in made.node_tree.nodes:
        if node.type == "BSDF_PRINCIPLED":
            node.inputs["Base Color"].default_value = (*color, 1)
            node.inputs["Roughness"].default_value = ROUGHNESS
    return made


def add(name, data, **properties):
    """An object of the data in the scene, with custom properties."""
    made = bpy.data.objects.new(name, data)
    for key, value in properties.items():
        made[key] = value
    bpy.context.scene.collection.objects.link(made)
    return made


def vessels(name, tree, order, splines):
    """A curve object; of each spline the material, the id and x, y, z, radius, x, y, z, radius, ..."""
    curve = bpy.data.curves.new(name, "CURVE")
    curve.dimensions, curve.fill_mode = "3D", "FULL"
    curve.bevel_depth, curve.bevel_resolution = 1, BEVEL
    curve.use_fill_caps = True
    for each in MATERIALS:
        curve.materials.append(each)
    for number, _, at in splines:
        spline = curve.splines.new("POLY")
        spline.material_index = number
        spline.points.add(len(at) // 4 - 1)
        for point, x, y, z, radius in zip(spline.points, at[::4], at[1::4], at[2::4], at[3::4]):
            point.co, point.radius = (x, y, z, 1), radius
    made = add(name, curve, tree=tree, strahler_order=order, segment_ids=[row[1] for row in splines])
    made.parent = TREE


TREE = add("tree", None, unit="mm", command=${quoted_command})
TREE.rotation_euler, TREE.scale = (1.5707963267948966, 0, 0), (SCALE, SCALE, SCALE)
MATERIALS = [material(name, color) for name, color in (
${materials})]

${vessels}


def add_camera():
    """Adds a camera that sees the whole tree from the front, and a sun."""
    from mathutils import Vector
    bpy.context.view_layer.update()
    corners = [each.matrix_world @ Vector(corner) for each in TREE.children for corner in each.bound_box]
    low, high = (Vector(pick(at[k] for at in corners) for k in range(3)) for pick in (min, max))
    middle, radius = (low + high) / 2, (high - low).length / 2
    data = bpy.data.cameras.new("tree_camera")
    distance = 1.05 * radius / math.sin(data.angle_y / 2)
    data.clip_start, data.clip_end = distance / 1000, 10 * distance
    camera = add("tree_camera", data)
    camera.location = middle - Vector((0, distance, 0))
    camera.rotation_euler = (math.pi / 2, 0, 0)
    bpy.context.scene.camera = camera
    sun = add("tree_sun", bpy.data.lights.new("tree_sun", "SUN"))
    sun.data.energy, sun.rotation_euler = 3, (0.7, 0.3, 0.4)


if ARGUMENTS.camera:
    add_camera()
