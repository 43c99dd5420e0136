"""Draws JSON scenes of `corcast suite --format json` with Blender's Cycles, on the processor.

usage: blender --background --factory-startup --python cycles.py -- SCENE.json PICTURE.exr [SCENE.json PICTURE.exr]...

Shapes are meshes: cylinders of 512 sides, spheres of 256 x 128. Samples lie within 0.01 pixels of the center of the
pixel, without indirect light, so that nothing is random with one light. Of several lights, Cycles chooses one at random
for each of the 256 samples. Area lights become point lights. The light of points does not fall off with distance.
"""
import json
import math
import sys

import bpy
from mathutils import Matrix, Vector

SIDES = 512


def shader(color, finish):
    """Diffuse light and ambient light; highlights as those of a glossy Phong lobe have no like in Cycles."""
    material = bpy.data.materials.new("vessel")
    material.use_nodes = True
    material.cycles.sample_as_light = False  # its glow is seen, and lights nothing
    tree = material.node_tree
    tree.nodes.clear()
    output, total = tree.nodes.new("ShaderNodeOutputMaterial"), tree.nodes.new("ShaderNodeAddShader")
    body, glow = tree.nodes.new("ShaderNodeBsdfDiffuse"), tree.nodes.new("ShaderNodeEmission")
    body.inputs["Color"].default_value = [c * finish["diffuse"] for c in color] + [1]
    glow.inputs["Color"].default_value = [c * finish["ambient"] for c in color] + [1]
    for k, node in enumerate((body, glow)):
        tree.links.new(node.outputs[0], total.inputs[k])
    last = total
    if finish["phong"] or finish["specular"]:
        gloss, sum_of = tree.nodes.new("ShaderNodeBsdfGlossy"), tree.nodes.new("ShaderNodeAddShader")
        exponent = finish["phong_size"] if finish["phong"] else 1 / finish["roughness"]
        gloss.inputs["Roughness"].default_value = (2 / (exponent + 2)) ** 0.25
        gloss.inputs["Color"].default_value = [2 * math.pi * (finish["phong"] or finish["specular"]) / (exponent + 2)] * 3 + [1]
        tree.links.new(total.outputs[0], sum_of.inputs[0])
        tree.links.new(gloss.outputs[0], sum_of.inputs[1])
        last = sum_of
    tree.links.new(last.outputs[0], output.inputs["Surface"])
    return material


def add_shape(shape, finish):
    a, b = Vector(shape["a"]), Vector(shape["b"])
    if shape["kind"] == "sphere":
        bpy.ops.mesh.primitive_uv_sphere_add(segments=SIDES // 2, ring_count=SIDES // 4, radius=shape["radius"], location=a)
    else:
        bpy.ops.mesh.primitive_cylinder_add(vertices=SIDES, radius=shape["radius"], depth=(b - a).length, location=(a + b) / 2,
                                            rotation=(b - a).to_track_quat("Z", "Y").to_euler())
    made = bpy.context.object
    made.data.materials.append(shader(shape["color"], finish))
    bpy.ops.object.shade_smooth()
    if shape["kind"] != "sphere":
        made.data.use_auto_smooth, made.data.auto_smooth_angle = True, math.radians(30)  # flat ends


def add_light(light, shadows):
    lamp = bpy.data.lights.new("light", "SUN" if light["parallel"] else "POINT")
    lamp.color = light["color"]
    lamp.cycles.cast_shadow = shadows and light["casts_shadows"]
    made = bpy.data.objects.new("light", lamp)
    made.location = light["location"]
    if light["parallel"]:
        lamp.energy, lamp.angle = math.pi, 0
        made.rotation_euler = (Vector(light["location"]) - Vector(light["target"])).to_track_quat("Z", "Y").to_euler()
    else:
        lamp.energy, lamp.shadow_soft_size = 4 * math.pi ** 2, 0
        lamp.use_nodes = True
        tree = lamp.node_tree
        falloff = tree.nodes.new("ShaderNodeLightFalloff")
        falloff.inputs["Strength"].default_value = 1
        tree.links.new(falloff.outputs["Constant"], tree.nodes["Emission"].inputs["Strength"])
    bpy.context.collection.objects.link(made)


def add_camera(camera):
    right, up, direction = (Vector(camera[k]) for k in ("right", "up", "direction"))
    lens = bpy.data.cameras.new("camera")
    side = max(right.length, up.length)
    if camera["projection"] == "orthographic":
        lens.type, lens.ortho_scale = "ORTHO", side
    else:
        lens.angle = 2 * math.atan(side / 2 / direction.length)
    lens.clip_start, lens.clip_end = 1e-3, 1e6
    made = bpy.data.objects.new("camera", lens)
    axes = Matrix([right.normalized(), up.normalized(), -direction.normalized()]).transposed()
    made.matrix_world = Matrix.Translation(Vector(camera["location"])) @ axes.to_4x4()
    bpy.context.collection.objects.link(made)
    return made


def draw(data, picture):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    for shape in data["shapes"]:
        add_shape(shape, data["finish"])
    if data["ground"]:
        normal = Vector(data["ground"]["normal"])
        bpy.ops.mesh.primitive_plane_add(size=1e4, location=normal * data["ground"]["offset"],
                                         rotation=normal.to_track_quat("Z", "Y").to_euler())
        bpy.context.object.data.materials.append(shader(data["ground"]["color"], data["ground"]["finish"]))
    for light in data["lights"]:
        add_light(light, data["shadows"])
    scene.camera = add_camera(data["camera"])
    scene.world = bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    tree = scene.world.node_tree  # the background is seen, and lights nothing
    tree.nodes["Background"].inputs["Color"].default_value = data["background"] + [1]
    tree.links.new(tree.nodes.new("ShaderNodeLightPath").outputs["Is Camera Ray"], tree.nodes["Background"].inputs["Strength"])
    scene.world.cycles.sampling_method = "NONE"
    render, cycles = scene.render, scene.cycles
    render.engine, render.resolution_percentage, render.threads_mode, render.threads = "CYCLES", 100, "FIXED", 1
    render.resolution_x, render.resolution_y = data["camera"]["width"], data["camera"]["height"]
    cycles.device, cycles.use_denoising, cycles.use_adaptive_sampling = "CPU", False, False
    cycles.samples = 1 if len(data["lights"]) < 2 else 256
    cycles.pixel_filter_type, cycles.filter_width, cycles.max_bounces = "BOX", 0.01, 0
    cycles.sample_clamp_direct, cycles.sample_clamp_indirect, cycles.light_sampling_threshold = 0, 0, 0
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    render.image_settings.color_mode, render.image_settings.exr_codec = "RGB", "ZIP"
    render.filepath, render.use_file_extension = picture, False
    bpy.ops.render.render(write_still=True)


names = sys.argv[sys.argv.index("--") + 1:]
for source, target in zip(names[::2], names[1::2]):
    draw(json.load(open(source)), target)
