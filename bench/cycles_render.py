"""Runs in the Python that has bpy: renders the exported scene once for each seed on standard input, one diffuse bounce.

python cycles_render.py FOLDER SPP      reads FOLDER/scene.npz, writes FOLDER/picture.npy, prints "milliseconds <wall time>"
"""

import math
import sys
import time
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix, Vector


def build(data, spp):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    for k in range(int(data["meshes"])):
        add_mesh(scene, data, k)
    add_lights(scene, data)
    add_camera(scene, data)
    render, cycles = scene.render, scene.cycles
    render.engine, cycles.device = "CYCLES", "CPU"
    render.resolution_x, render.resolution_y = (int(x) for x in data["size"])
    render.resolution_percentage = 100
    render.use_persistent_data = True  # the hierarchy is built once, in the warm-up
    render.image_settings.file_format = "OPEN_EXR"
    render.image_settings.color_depth = "32"
    cycles.samples, cycles.use_adaptive_sampling, cycles.use_denoising = spp, False, False
    cycles.pixel_filter_type, cycles.filter_width = "BOX", 1.0
    cycles.max_bounces = cycles.diffuse_bounces = 1
    cycles.glossy_bounces = cycles.transmission_bounces = cycles.volume_bounces = cycles.transparent_max_bounces = 0
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.use_light_tree = False
    scene.view_settings.view_transform = "Raw"
    return scene


def add_mesh(scene, data, k):
    mesh = bpy.data.meshes.new(f"mesh {k}")
    mesh.from_pydata(data[f"positions {k}"].tolist(), [], data[f"triangles {k}"].tolist())
    material = bpy.data.materials.new(f"material {k}")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    diffuse, output = nodes.new("ShaderNodeBsdfDiffuse"), nodes.new("ShaderNodeOutputMaterial")
    links.new(diffuse.outputs["BSDF"], output.inputs["Surface"])
    diffuse.inputs["Color"].default_value = (*data[f"albedo {k}"], 1)
    if f"texture {k}" in data:
        corners = data[f"texcoords {k}"][data[f"triangles {k}"].ravel()]
        mesh.uv_layers.new(name="uv").data.foreach_set("uv", np.ascontiguousarray(corners, np.float32).ravel())
        texture = nodes.new("ShaderNodeTexImage")
        texture.image = picture_of(f"texture {k}", data[f"texture {k}"])
        links.new(texture.outputs["Color"], diffuse.inputs["Color"])
    mesh.materials.append(material)
    scene.collection.objects.link(bpy.data.objects.new(f"mesh {k}", mesh))


def picture_of(name, pixels):
    """An sRGB image; its row 0 is at the bottom."""
    height, width = pixels.shape[:2]
    image = bpy.data.images.new(name, width, height)
    rgba = np.ones((height, width, 4), np.float32)
    rgba[..., :3] = pixels[::-1] / 255
    image.pixels.foreach_set(rgba.ravel())
    image.pack()
    return image


def add_lights(scene, data):
    sun = bpy.data.lights.new("sun", "SUN")
    sun.energy, sun.angle, sun.color = float(data["sun_irradiance"].max()), 0.0, data["sun_irradiance"] / data["sun_irradiance"].max()
    placed = bpy.data.objects.new("sun", sun)
    placed.rotation_mode = "QUATERNION"
    placed.rotation_quaternion = Vector(data["sun_direction"]).to_track_quat("-Z", "Y")
    scene.collection.objects.link(placed)
    world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (*data["sky"], 1)
    scene.world = world


def add_camera(scene, data):
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit, camera.angle_x = "HORIZONTAL", math.radians(float(data["fov_x"]))
    camera.clip_start, camera.clip_end = 1e-2, 1e6
    placed = bpy.data.objects.new("camera", camera)
    backward = Vector(data["position"] - data["target"]).normalized()
    right = Vector(data["up"]).cross(backward).normalized()
    turn = Matrix((right, backward.cross(right), backward)).transposed()
    placed.matrix_world = Matrix.Translation(Vector(data["position"])) @ turn.to_4x4()
    scene.collection.objects.link(placed)
    scene.camera = placed


def read_picture(path):
    image = bpy.data.images.load(str(path))
    image.colorspace_settings.name = "Non-Color"
    width, height = image.size
    rgba = np.empty(width * height * 4, np.float32)
    image.pixels.foreach_get(rgba)
    bpy.data.images.remove(image)
    return np.ascontiguousarray(rgba.reshape(height, width, 4)[::-1, :, :3])


def main():
    folder, spp = Path(sys.argv[1]), int(sys.argv[2])
    with np.load(folder / "scene.npz") as data:
        scene = build(dict(data), spp)
    for line in sys.stdin:
        scene.cycles.seed = int(line)
        scene.render.filepath = str(folder / "picture.exr")
        start = time.perf_counter()
        bpy.ops.render.render()
        spent = 1e3 * (time.perf_counter() - start)
        bpy.data.images["Render Result"].save_render(str(folder / "picture.exr"))
        np.save(folder / "picture.npy", read_picture(folder / "picture.exr"))
        print(f"\nmilliseconds {spent}", flush=True)


if __name__ == "__main__":
    main()
