"""Run by Blender: imports a result by the add-on, compares where things are with what the report says, and renders a
picture by Cycles, whose outline has to be the photograph's. Arguments behind --: ADDON RESULT PICTURE."""
import importlib.util
import json
import sys
from pathlib import Path

import bpy
import numpy as np

METRES = {"cm": 0.01}
PIXELS = 0.5  # how far a projected point may be off
OVERLAP = 0.97  # of the outlines: intersection by union

addon_path, folder, picture = (Path(word) for word in sys.argv[sys.argv.index("--") + 1:])
report = json.loads((folder / "report.json").read_text())


def load_addon():
    spec = importlib.util.spec_from_file_location("photohull_import", addon_path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def expected_place(points: np.ndarray) -> np.ndarray:
    """Blender's coordinates of points of the scene, told in another way than the add-on: +Z is up, so what is up there has
    to be up here, and no mirror."""
    scale = METRES.get(report["options"].get("unit"), 1.0)
    turn = np.array([list(addon.blender_from_scene(report).to_3x3()[i]) for i in range(3)]) / scale
    assert np.allclose(turn @ turn.T, np.eye(3), atol=1e-6) and np.linalg.det(turn) > 0, "it mirrors or shears"
    assert np.allclose(turn @ report["up_axis"], [0, 0, 1], atol=1e-6), "up is not up"
    return scale * points @ turn.T


def read_ply(path: Path) -> np.ndarray:
    """The vertices of a binary PLY file."""
    data = path.read_bytes()
    head, _, body = data.partition(b"end_header\n")
    lines = head.decode().splitlines()
    at = next(i for i, line in enumerate(lines) if line.startswith("element vertex"))
    types = {"float": "<f4", "double": "<f8", "uchar": "u1", "float32": "<f4", "uint8": "u1"}
    fields = []
    for line in lines[at + 1:]:
        if not line.startswith("property"):
            break
        _, kind, name = line.split()
        fields.append((name, types[kind]))
    vertices = np.frombuffer(body, dtype=fields, count=int(lines[at].split()[2]))
    return np.stack([vertices[axis].astype(float) for axis in "xyz"], axis=1)


def vertices_of(things) -> np.ndarray:
    return np.array([list(thing.matrix_world @ v.co) for thing in things if thing.type == "MESH" for v in thing.data.vertices])


def project_by_report(camera: dict, point: np.ndarray) -> np.ndarray:
    x, y, z = np.array(camera["rotation"]) @ (point - np.array(camera["centre"]))
    fx, fy = camera["focal"]
    return np.array([fx * x / z + camera["principal"][0], fy * y / z + camera["principal"][1]])


def project_by_blender(thing, point: np.ndarray) -> np.ndarray:
    """By the matrices that Blender renders with; the centre of the top-left pixel is (0, 0)."""
    render = bpy.context.scene.render
    matrix = thing.calc_matrix_camera(
        bpy.context.evaluated_depsgraph_get(), x=render.resolution_x, y=render.resolution_y,
        scale_x=render.pixel_aspect_x, scale_y=render.pixel_aspect_y)
    clip = np.array(matrix) @ np.array(thing.matrix_world.inverted()) @ np.append(point, 1)
    assert clip[3] > 0, "the point is behind the camera"
    x, y = clip[:2] / clip[3]
    return np.array([(x + 1) / 2 * render.resolution_x - 0.5, (1 - y) / 2 * render.resolution_y - 0.5])


def check_model(made) -> None:
    truth, found = expected_place(read_ply(folder / "mesh.ply")), vertices_of(made["model"])
    voxel = report["grid"]["voxel_size"] * METRES.get(report["options"].get("unit"), 1.0)
    assert len(found) > 100, "there is no model"
    images = {node.image for thing in made["model"] for slot in thing.material_slots
              for node in slot.material.node_tree.nodes if node.type == "TEX_IMAGE"}
    assert bool(images) == ("mesh.glb" in report["files"]), f"its textures: {images}"
    for bound in (np.min, np.max):
        off = np.abs(bound(truth, axis=0) - bound(found, axis=0)).max()
        assert off < voxel, f"the model's bounds are off by {off / voxel:.2f} voxels"
    # The bounds of stairs turned by half a turn are the same; their vertices lie elsewhere.
    some = found[:: max(1, len(found) // 300)]
    off = max(np.linalg.norm(truth - point, axis=1).min() for point in some)
    assert off < 2 * voxel, f"a vertex is {off / voxel:.2f} voxels from all of mesh.ply's"


def check_cameras(made) -> None:
    assert len(made["cameras"]) == len(report["cameras"]), "cameras are missing"
    low, high = np.array(report["box"]["min"]), np.array(report["box"]["max"])
    worst = 0.0
    for camera, thing in zip(report["cameras"], made["cameras"]):
        place = expected_place(np.array([camera["centre"]]))[0]
        assert np.allclose(list(thing.matrix_world.translation), place, rtol=1e-5, atol=1e-5), f"{thing.name} stands elsewhere"
        addon.look_through(bpy.context.scene, thing)
        for share in ((0.5, 0.5, 0.5), (0.1, 0.3, 0.8), (0.9, 0.2, 0.1), (0.3, 0.9, 0.6)):
            point = low + np.array(share) * (high - low)
            off = project_by_report(camera, point) - project_by_blender(thing, expected_place(point[None])[0])
            worst = max(worst, float(np.abs(off).max()))
        images = thing.data.background_images
        assert len(images) == 1 and tuple(images[0].image.size) == tuple(camera["size"]), f"{thing.name} has no photograph"
    print(f"projections differ by {worst:.4f} pixels at most")
    assert worst < PIXELS, f"projections are off by {worst:.2f} pixels"


def check_volume(made) -> None:
    grids = made["volume"].data.grids
    if not grids.load():
        raise AssertionError(f"Blender reads no volume: {grids.error_message}")
    names = {grid.name for grid in grids}
    assert {"surface", "Cd", "confidence"} <= names, f"its grids are {names}"
    surface = next(grid for grid in grids if grid.name == "surface")
    # From indices to Blender's coordinates: steps of a voxel, and index 0 at the lower corner of the box.
    index_to_world = np.array(made["volume"].matrix_world) @ np.array(surface.matrix_object)
    voxel = report["grid"]["voxel_size"] * METRES.get(report["options"].get("unit"), 1.0)
    steps = np.linalg.norm(index_to_world[:3, :3], axis=0)
    assert np.allclose(steps, voxel, rtol=1e-4), f"voxels of {steps}"


def render(made) -> np.ndarray:
    scene = bpy.context.scene
    for name in ("Cube", "Light", "Camera"):
        if name in bpy.data.objects:
            bpy.data.objects.remove(bpy.data.objects[name])
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = 16
    scene.cycles.use_denoising = False
    scene.render.film_transparent = True
    scene.view_settings.view_transform = "Standard"
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (1, 1, 1, 1)
    scene.render.image_settings.file_format = "PNG"
    scene.render.image_settings.color_mode = "RGBA"
    addon.look_through(scene, made["cameras"][0])
    scene.render.filepath = str(picture)
    bpy.ops.render.render(write_still=True)
    return pixels_of(bpy.data.images.load(str(picture)))


def pixels_of(image) -> np.ndarray:
    """Rows from the top."""
    width, height = image.size
    return np.array(image.pixels[:]).reshape(height, width, image.channels)[::-1]


def check_picture(made) -> None:
    drawn = render(made)[..., 3] > 0.5
    name = Path(report["cameras"][0]["name"])
    masks = [Path(entry["path"]) for entry in report["inputs"] if entry["kind"] == "mask"]
    mask = next(path for path in masks if path.stem == name.stem)
    outline = pixels_of(bpy.data.images.load(str(mask)))[..., 0] > 0.5
    overlap = (drawn & outline).sum() / (drawn | outline).sum()
    print(f"the picture overlaps the photograph's mask by {overlap:.4f}")
    assert overlap > OVERLAP, f"the picture overlaps the photograph's mask by {overlap:.3f}"


addon = load_addon()
addon.register()
made = addon.import_result(folder)
assert not made["warnings"], made["warnings"]
bpy.context.view_layer.update()
check_model(made)
check_cameras(made)
check_volume(made)
check_picture(made)
# By the menu, as people do; and what is no result.
assert bpy.ops.import_scene.photohull(filepath=str(folder / "report.json"), volume=False) == {"FINISHED"}
try:
    bpy.ops.import_scene.photohull(filepath=str(folder.parent / "report.json"))
except RuntimeError as fault:
    assert "no report.json" in str(fault), fault
else:
    raise AssertionError("a folder without a report was imported")
addon.unregister()
print("passed")
