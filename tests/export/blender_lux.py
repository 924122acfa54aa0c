# blender -b --factory-startup --python-exit-code 1 -P blender_lux.py -- FILE.glb POINTS.csv: reads a file of `deltalux export`
# in Blender and prints the lux that its .exr have at points, as tests/export/three_lux.cjs does in three.js.
import csv
import json
import math
import pathlib
import struct
import sys
import tempfile

import bpy
import numpy
from mathutils import Vector
from mathutils.bvhtree import BVHTree

numpy.bool = bool  # Debian 12's importer asks for the alias that its numpy has dropped

FILE, POINTS = sys.argv[sys.argv.index("--") + 1:][:2]


def document(path):
    data = pathlib.Path(path).read_bytes()
    return json.loads(data[20:20 + struct.unpack_from("<I", data, 12)[0]])


def numbered(path, folder):
    """The file with its materials named by number: Blender does not keep MOZ_lightmap, which tells their pages."""
    data = pathlib.Path(path).read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    json_ = json.loads(data[20:20 + length])
    for i, material in enumerate(json_["materials"]):
        material["name"] = "m%d" % i
    text = json.dumps(json_).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + length:]
    out = pathlib.Path(folder) / "numbered.glb"
    out.write_bytes(data[:8] + struct.pack("<II", 20 + len(text) + len(rest), len(text)) + data[16:20] + text + rest)
    return str(out)


def bilinear(pixels, width, height, u, v):
    """Rows run upwards in Blender, and so does its v."""
    x, y = u * width - 0.5, v * height - 0.5
    x0, y0 = math.floor(x), math.floor(y)
    total = [0.0, 0.0, 0.0]
    for dx in (0, 1):
        for dy in (0, 1):
            weight = (x - x0 if dx else 1 - x + x0) * (y - y0 if dy else 1 - y + y0)
            i = 4 * (min(max(y0 + dy, 0), height - 1) * width + min(max(x0 + dx, 0), width - 1))
            for c in range(3):
                total[c] += weight * pixels[i + c]
    return total


def page_of(name):
    light = materials[int(name[1:])]["extensions"]["MOZ_lightmap"]
    return next(i for i, page in enumerate(extras["lightmap"]["pages"]) if page["texture"] == light["index"])


def find(meshes, at, along):
    """The nearest triangle from a point along a direction: (distance, mesh, polygon, position)."""
    best = None
    for mesh, tree in meshes:
        position, _, index, distance = tree.ray_cast(at, along)
        if position is not None and mesh.polygons[index].normal.dot(along) < 0 and (best is None or distance < best[0]):
            best = (distance, mesh, index, position)
    return best


def texcoord(mesh, index, position):
    from mathutils.geometry import barycentric_transform
    polygon = mesh.polygons[index]
    layer = mesh.uv_layers[1].data
    corners = [mesh.vertices[mesh.loops[i].vertex_index].co for i in polygon.loop_indices]
    uvs = [layer[i].uv.to_3d() for i in polygon.loop_indices]
    return barycentric_transform(position, *corners, *uvs)


bpy.ops.wm.read_factory_settings(use_empty=True)
with tempfile.TemporaryDirectory() as folder:
    bpy.ops.import_scene.gltf(filepath=numbered(FILE, folder))
extras, materials = document(FILE)["asset"]["extras"]["deltalux"], document(FILE)["materials"]
pages = []
for page in extras["lightmap"]["pages"]:
    image = bpy.data.images.load(str(pathlib.Path(FILE).resolve().parent / page["exr"]))
    image.colorspace_settings.name = "Non-Color"
    pages.append((list(image.pixels), *image.size))

root = next(o for o in bpy.data.objects if o.parent is None)
bpy.context.view_layer.update()
meshes = []
for o in bpy.data.objects:
    if o.type != "MESH":
        continue
    o.data.transform(o.matrix_world)
    meshes.append((o.data, BVHTree.FromPolygons([v.co for v in o.data.vertices], [p.vertices for p in o.data.polygons])))
up = Vector(extras["up"])
scale = extras["metresPerUnit"]
# glTF's y is up; Blender's importer turns it to z.
to_gltf = up.rotation_difference(Vector((0, 1, 0)))
origin = Vector(extras.get("origin", (0, 0, 0)))


def to_blender(v):
    g = to_gltf @ v
    return Vector((g.x, -g.z, g.y))


worst = 0
for row in csv.DictReader(line for line in open(POINTS) if not line.startswith("#")):
    number = {k: float(v) for k, v in row.items() if k in ("x", "y", "z", "nx", "ny", "nz", "lux")}
    normal = to_blender(Vector((number["nx"], number["ny"], number["nz"]))).normalized()
    at = scale * to_blender(Vector((number["x"], number["y"], number["z"])) - origin)
    hit = find(meshes, at + 1e-3 * scale * normal, -normal)
    if hit is None:
        print(number, "nothing there")
        continue
    uv = texcoord(hit[1], hit[2], hit[3])
    E = bilinear(*pages[page_of(hit[1].materials[hit[1].polygons[hit[2]].material_index].name)], uv.x, uv.y)
    lux = extras["luminousEfficacy"] * sum(e * w for e, w in zip(E, extras["luminanceWeights"]))
    if number.get("lux", 0) > 0:
        worst = max(worst, abs(lux / number["lux"] - 1))
    print("%.3f %.3f %.3f probe %.3f blender %.3f" % (number["x"], number["y"], number["z"], number.get("lux", 0), lux))
print("%d objects, %d materials, worst %.2f %%" % (len(meshes), len(bpy.data.materials), 100 * worst))
sys.exit(worst > 0.03)
