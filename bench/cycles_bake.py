# blender -b --factory-startup --python-exit-code 1 -P cycles_bake.py -- FILE.glb POINTS.csv SAMPLES...
#
# Bakes the lightmaps of a file of `deltalux export` anew by Blender's path tracer Cycles, on the same texels, and prints
# CSV: samples, processor seconds of the bake, median and 95th percentile of the relative errors of irradiance at the points
# [%]. Points are read between texels, as lightmaps are shown. Emission in the file is radiance [W/(sr m2)], which is
# what Cycles' emission takes, so its light is compared as it is, without a factor.
import csv
import json
import math
import pathlib
import struct
import sys
import tempfile
import time

import bmesh
import bpy
import numpy
from mathutils import Vector
from mathutils.bvhtree import BVHTree
from mathutils.geometry import barycentric_transform

numpy.bool = bool  # Debian 12's importer asks for the alias that its numpy has dropped

FILE, POINTS, *SAMPLES = sys.argv[sys.argv.index("--") + 1:]
GRAY = (0.265, 0.670, 0.065)


def read(path):
    """The document, and the file with materials named after the page that their light is on."""
    data = pathlib.Path(path).read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    document, rest = json.loads(data[20:20 + length]), data[20 + length:]
    for i, material in enumerate(document["materials"]):
        light = material.get("extensions", {}).get("MOZ_lightmap")
        material["name"] = "%s page %d" % (i, light["index"] if light else -1)
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    return document, data[:8] + struct.pack("<II", 20 + len(text) + len(rest), len(text)) + data[16:20] + text + rest


def prepare(sides):
    """An image for every page as its materials' bake target; the lightmap's coordinates for it."""
    images = []
    for page, (width, height) in enumerate(sides):
        image = bpy.data.images.new("page %d" % page, width, height, alpha=False, float_buffer=True)
        image.colorspace_settings.name = "Non-Color"
        images.append(image)
    spare = bpy.data.images.new("unlit", 4, 4, alpha=False, float_buffer=True)
    for material in bpy.data.materials:
        material.use_nodes = True
        page = page_of(material)
        node = material.node_tree.nodes.new("ShaderNodeTexImage")
        node.image = images[page] if page >= 0 else spare
        material.node_tree.nodes.active = node
    objects = [o for o in meshes() if len(o.data.uv_layers) > 1]
    bpy.ops.object.select_all(action="DESELECT")
    for o in objects:
        o.data.uv_layers.active_index = 1
        o.select_set(True)
    bpy.context.view_layer.objects.active = objects[0]
    return images, objects


def drop_dark_backs():
    """Sides are for themselves in the file, seen from one side alone; for Cycles a black back lies in its front's light."""
    def is_dark(o, polygon):
        for node in o.data.materials[polygon.material_index].node_tree.nodes:
            if node.type == "BSDF_PRINCIPLED":
                return max(node.inputs["Emission"].default_value[:3]) == 0 and max(node.inputs["Base Color"].default_value[:3]) == 0
        return False

    lit = [o for o in meshes() if any(not is_dark(o, p) for p in o.data.polygons)]
    trees = []
    for o in lit:
        polygons = [list(p.vertices) for p in o.data.polygons if not is_dark(o, p)]
        trees.append(BVHTree.FromPolygons([o.matrix_world @ v.co for v in o.data.vertices], polygons))

    def has_front(o, polygon):
        at, normal = o.matrix_world @ polygon.center, o.matrix_world.to_3x3() @ polygon.normal
        found = [tree.find_nearest(at, 1e-5) for tree in trees]
        return any(f[0] is not None and f[1].dot(normal) < -0.99 * normal.length for f in found)

    for o in meshes():
        shape = bmesh.new()
        shape.from_mesh(o.data)
        shape.faces.ensure_lookup_table()
        backs = [shape.faces[p.index] for p in o.data.polygons if is_dark(o, p) and has_front(o, p)]
        bmesh.ops.delete(shape, geom=backs, context="FACES")
        shape.to_mesh(o.data)
        shape.free()


def meshes():
    return [o for o in bpy.data.objects if o.type == "MESH"]


def page_of(material):
    return int(material.name.split(" page ")[1].split(".")[0])


def readers(objects, extras, points):
    """For each point the page and the texture coordinates at which its irradiance is read."""
    up, scale, origin = Vector(extras["up"]), extras["metresPerUnit"], Vector(extras.get("origin", (0, 0, 0)))
    turn = up.rotation_difference(Vector((0, 1, 0)))

    def to_blender(v):  # glTF's y is up; Blender's importer turns it to z
        g = turn @ v
        return Vector((g.x, -g.z, g.y))

    trees = []
    for o in objects:
        corners = [o.matrix_world @ v.co for v in o.data.vertices]
        trees.append((o.data, corners, BVHTree.FromPolygons(corners, [p.vertices for p in o.data.polygons])))
    found = []
    for p in points:
        normal = to_blender(Vector([float(p[k]) for k in ("nx", "ny", "nz")])).normalized()
        at = scale * to_blender(Vector([float(p[k]) for k in "xyz"]) - origin) + 1e-3 * normal
        best = None
        for mesh, corners, tree in trees:
            position, _, index, distance = tree.ray_cast(at, -normal)
            if position is not None and (best is None or distance < best[0]):
                best = (distance, mesh, corners, index, position)
        if best is None or best[0] > 0.01:
            found.append(None)
            continue
        _, mesh, corners, index, position = best
        polygon = mesh.polygons[index]
        page = page_of(mesh.materials[polygon.material_index])
        uv = [mesh.uv_layers[1].data[i].uv.to_3d() for i in polygon.loop_indices[:3]]
        found.append((page, barycentric_transform(position, *[corners[v] for v in polygon.vertices[:3]], *uv)))
    return found


def irradiance(pixels, uv):
    height, width, _ = pixels.shape
    x, y = min(max(uv.x * width - 0.5, 0), width - 1.001), min(max(uv.y * height - 0.5, 0), height - 1.001)
    i, j, s, t = int(x), int(y), x - int(x), y - int(y)
    row = lambda k: (1 - s) * pixels[k, i] + s * pixels[k, i + 1]
    return math.pi * float(numpy.dot((1 - t) * row(j) + t * row(j + 1), GRAY))  # Cycles bakes E / pi


bpy.ops.wm.read_factory_settings(use_empty=True)
document, data = read(FILE)
with tempfile.NamedTemporaryFile(suffix=".glb") as named:
    named.write(data)
    named.flush()
    bpy.ops.import_scene.gltf(filepath=named.name)
bpy.context.view_layer.update()
drop_dark_backs()
scene = bpy.context.scene
scene.world = bpy.data.worlds.new("dark")
scene.world.color = (0, 0, 0)
scene.render.engine = "CYCLES"
scene.render.threads_mode, scene.render.threads = "FIXED", 2
scene.cycles.device, scene.cycles.use_denoising, scene.cycles.use_adaptive_sampling = "CPU", False, False
scene.cycles.max_bounces = scene.cycles.diffuse_bounces = scene.cycles.glossy_bounces = scene.cycles.transmission_bounces = 32
scene.cycles.sample_clamp_indirect = scene.cycles.blur_glossy = 0
extras = document["asset"]["extras"]["deltalux"]
folder = pathlib.Path(FILE).resolve().parent
images, objects = prepare([bpy.data.images.load(str(folder / page["exr"])).size[:] for page in extras["lightmap"]["pages"]])
with open(POINTS, encoding="utf-8") as table:
    points = list(csv.DictReader(line for line in table if not line.startswith("#")))
places = readers(objects, extras, points)
for samples in SAMPLES:
    scene.cycles.samples = int(samples)
    for image in images:  # use_clear would clear them for every object
        image.pixels.foreach_set(numpy.zeros(4 * image.size[0] * image.size[1], dtype=numpy.float32))
    start = time.process_time()
    bpy.ops.object.bake(type="DIFFUSE", pass_filter={"DIRECT", "INDIRECT"}, margin=1, margin_type="EXTEND", use_clear=False)
    seconds = time.process_time() - start
    pages = []
    for image in images:
        pixels = numpy.empty(image.size[0] * image.size[1] * 4, dtype=numpy.float32)
        image.pixels.foreach_get(pixels)
        pages.append(pixels.reshape(image.size[1], image.size[0], 4)[:, :, :3].astype(float))
    errors = []
    for p, place in zip(points, places):
        expected = sum(w * float(p["E_" + c]) for w, c in zip(GRAY, "rgb"))
        if place and place[0] >= 0 and expected > 0:
            errors.append(abs(irradiance(pages[place[0]], place[1]) / expected - 1))
    errors.sort()
    print("cycles,%s,%.4g,%.4g,%.4g,%d" % (samples, seconds, 100 * errors[len(errors) // 2], 100 * errors[int(0.95 * len(errors))],
                                           len(errors)), flush=True)
