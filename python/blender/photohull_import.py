"""Blender add-on: imports a folder that `photohull reconstruct` wrote: the model with its texture, the volume, and the
cameras with their photographs behind the scene, upright and in metres.

Install it by Edit > Preferences > Add-ons > Install, then File > Import > photohull result (report.json).
"""
import json
import math
from pathlib import Path

import bpy
from bpy_extras.io_utils import ImportHelper
from mathutils import Matrix, Vector

bl_info = {
    "name": "photohull results",
    "author": "The photohull authors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "File > Import > photohull result (report.json)",
    "description": "Imports model, volume and cameras of a reconstruction",
    "category": "Import-Export",
}

METRES = {"mm": 0.001, "cm": 0.01, "m": 1.0, "inch": 0.0254}
SENSOR = 36.0  # mm; Blender wants a size, and only focal length by size counts
SMALLEST_VDB_VOXEL = 2e-5  # below, photohull writes volumes in thousandths of the scene's unit


def y_up_from_scene(up) -> Matrix:
    """The turn by which files with +Y up have the scene's axis `up` there; photohull writes glb files by the same."""
    axis = max(range(3), key=lambda i: (abs(up[i]), -i))
    sign = -1.0 if up[axis] < 0 else 1.0
    y, x = Vector((0, 0, 0)), Vector((0, 0, 0))
    y[axis] = sign
    x[1 if axis == 0 else 0] = -sign if axis == 0 else 1.0
    return Matrix((x, y, x.cross(y)))


def blender_from_scene(report) -> Matrix:
    """From the scene's coordinates to Blender's: +Z up, metres. A glb file comes to lie there by itself."""
    scale = METRES.get(report.get("options", {}).get("unit", ""), 1.0)
    z_up_from_y_up = Matrix(((1, 0, 0), (0, 0, -1), (0, 1, 0)))
    return (scale * (z_up_from_y_up @ y_up_from_scene(report["up_axis"]))).to_4x4()


def read_report(folder: Path) -> dict:
    try:
        report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    except OSError as fault:
        raise ValueError(f"{folder} has no report.json that can be read: {fault.strerror}") from fault
    except json.JSONDecodeError as fault:
        raise ValueError(f"{folder / 'report.json'} is no JSON: {fault}") from fault
    if "cameras" not in report or "up_axis" not in report:
        raise ValueError(f"{folder / 'report.json'} tells no cameras; reconstruct again")
    return report


def move_to(objects, collection) -> None:
    for thing in objects:
        for other in list(thing.users_collection):
            other.objects.unlink(thing)
        collection.objects.link(thing)


def imported(operator, path: Path) -> list:
    """The objects that an importer of Blender makes; none where it fails."""
    before = set(bpy.data.objects)
    try:
        operator(str(path))
    except RuntimeError as fault:
        print(f"{path} was not imported: {fault}")
        for thing in set(bpy.data.objects) - before:
            bpy.data.objects.remove(thing)
    return [thing for thing in bpy.data.objects if thing not in before]


def import_glb(path: str) -> None:
    """Blender 3.4's importer says numpy.bool, which NumPy has no more since 1.24, as Debian 12 has it."""
    try:
        import numpy
    except ImportError as fault:
        raise RuntimeError("Blender's importer of glTF files needs NumPy (Debian: python3-numpy)") from fault
    lacking = "bool" not in vars(numpy)
    if lacking:
        numpy.bool = bool
    try:
        bpy.ops.import_scene.gltf(filepath=path)
    finally:
        if lacking:
            del numpy.bool


def import_ply(path: str) -> None:
    if bpy.app.version >= (4, 0, 0):
        bpy.ops.wm.ply_import(filepath=path, forward_axis="Y", up_axis="Z")
    else:
        bpy.ops.import_mesh.ply(filepath=path)


def import_model(folder: Path, report: dict, collection) -> list:
    """The textured model, or else the one with colours at its vertices: Blender reads no compressed glb files."""
    made = []
    if "mesh.glb" in report["files"]:
        made = imported(import_glb, folder / "mesh.glb")
    if not made:
        made = imported(import_ply, folder / "mesh.ply")
        for thing in made:
            thing.matrix_world = blender_from_scene(report)
            show_vertex_colours(thing.data)
    move_to(made, collection)
    return made


def show_vertex_colours(mesh) -> None:
    if not mesh.color_attributes:
        return
    material = bpy.data.materials.new("photohull colours")
    material.use_nodes = True
    nodes = material.node_tree.nodes
    colour = nodes.new("ShaderNodeVertexColor")
    colour.layer_name = mesh.color_attributes[0].name
    material.node_tree.links.new(colour.outputs["Color"], nodes["Principled BSDF"].inputs["Base Color"])
    mesh.materials.append(material)


def import_volume(folder: Path, report: dict, collection):
    """The volume, hidden, for its level set `surface` shows as fog; a modifier Volume to Mesh makes a surface of it."""
    unit = 1.0
    while report["grid"]["voxel_size"] / unit < SMALLEST_VDB_VOXEL:
        unit /= 1000
    data = bpy.data.volumes.new("photohull volume")
    data.filepath = str(folder / "volume.vdb")
    thing = bpy.data.objects.new("photohull volume", data)
    thing.matrix_world = blender_from_scene(report) @ Matrix.Scale(unit, 4)
    thing.hide_render = True
    collection.objects.link(thing)
    thing.hide_set(True)
    return thing


def find_photograph(name: str, report: dict, folder: Path, photographs: Path | None) -> Path | None:
    """The file of a view: in the folder given, or where the report has it, as a path from the folder of the results,
    from those above it, or from where Blender runs."""
    listed = [Path(entry["path"]) for entry in report.get("inputs", []) if entry["kind"] == "photograph"]
    known = [path for path in listed if path.name == Path(name).name or path.as_posix().endswith("/" + name)]
    if photographs:
        return next((path for path in (photographs / name, photographs / Path(name).name) if path.is_file()), None)
    for path in known:
        for start in (Path.cwd(), folder, *folder.parents):
            if (start / path).is_file():
                return start / path
    return None


def set_lens(data, camera: dict) -> float:
    """Sets focal length and principal point, and returns the pixels' height by their width, which is the scene's matter."""
    (width, height), (fx, fy), (cx, cy) = camera["size"], camera["focal"], camera["principal"]
    aspect = fx / fy
    data.sensor_fit = "HORIZONTAL"
    data.sensor_width = SENSOR
    data.lens = fx * SENSOR / width
    data.shift_x = (width / 2 - (cx + 0.5)) / width  # the centre of the top-left pixel is (0, 0)
    data.shift_y = ((cy + 0.5) - height / 2) * aspect / width
    return aspect


def look_through(scene, thing) -> None:
    """Makes this camera the scene's, with its photograph's size and pixels."""
    width, height = thing["photohull_size"]
    aspect = thing["photohull_pixel_aspect"]
    scene.camera = thing
    scene.render.resolution_x, scene.render.resolution_y = int(width), int(height)
    scene.render.resolution_percentage = 100
    scene.render.pixel_aspect_x = max(1.0, 1 / aspect)
    scene.render.pixel_aspect_y = max(1.0, aspect)


def import_camera(camera: dict, report: dict, collection):
    to = blender_from_scene(report)
    scale = to.to_scale()[0]
    data = bpy.data.cameras.new(camera["name"])
    thing = bpy.data.objects.new(camera["name"], data)
    thing["photohull_pixel_aspect"] = set_lens(data, camera)
    thing["photohull_size"] = camera["size"]
    right, down, ahead = (Vector(row) for row in camera["rotation"])
    axes = Matrix((right, -down, -ahead)).transposed()  # Blender's cameras look along their -Z, with +Y up
    place = (to.to_3x3() @ axes * (1 / scale)).to_4x4()
    place.translation = to @ Vector(camera["centre"])
    thing.matrix_world = place
    distance = (place.translation - to @ middle_of(report)).length
    data.display_size = distance / 10
    data.clip_start, data.clip_end = distance / 1000, distance * 100
    collection.objects.link(thing)
    return thing


def middle_of(report: dict) -> Vector:
    return (Vector(report["box"]["min"]) + Vector(report["box"]["max"])) / 2


def set_background(thing, photograph: Path) -> None:
    background = thing.data.background_images.new()
    background.image = bpy.data.images.load(str(photograph), check_existing=True)
    background.frame_method = "STRETCH"
    background.display_depth = "BACK"
    background.alpha = 1.0
    thing.data.show_background_images = True


def import_result(folder, model=True, volume=True, cameras=True, photographs=None, scene=None) -> dict:
    """Imports the folder into a new collection. Returns its objects by "model", "volume" and "cameras", and "warnings"."""
    folder = Path(folder).resolve()
    report = read_report(folder)
    scene = scene or bpy.context.scene
    collection = bpy.data.collections.new(f"photohull {folder.name}")
    scene.collection.children.link(collection)
    made = {"model": [], "volume": None, "cameras": [], "warnings": []}
    if model:
        made["model"] = import_model(folder, report, collection)
    if volume and "volume.vdb" in report["files"]:
        made["volume"] = import_volume(folder, report, collection)
    if not cameras:
        return made
    below = bpy.data.collections.new("cameras")
    collection.children.link(below)
    missing = 0
    for camera in report["cameras"]:
        thing = import_camera(camera, report, below)
        made["cameras"].append(thing)
        if not math.isclose(camera["skew"], 0, abs_tol=0.01):
            made["warnings"].append(f"{camera['name']}: Blender's cameras have no skew; its {camera['skew']:.2f} is left out")
        photograph = find_photograph(camera["name"], report, folder, photographs and Path(photographs))
        if photograph:
            set_background(thing, photograph)
        else:
            missing += 1
    if missing:
        made["warnings"].append(f"{missing} of {len(report['cameras'])} photographs were not found; give their folder")
    main = [thing for thing, camera in zip(made["cameras"], report["cameras"]) if camera["name"] == report["preview_png_shows"]]
    look_through(scene, (main or made["cameras"])[0])
    return made


class ImportResult(bpy.types.Operator, ImportHelper):
    """Import what `photohull reconstruct` wrote"""

    bl_idname = "import_scene.photohull"
    bl_label = "Import photohull result"
    bl_options = {"REGISTER", "UNDO"}

    filename_ext = ".json"
    filter_glob: bpy.props.StringProperty(default="report.json", options={"HIDDEN"})
    model: bpy.props.BoolProperty(name="Model", default=True)
    volume: bpy.props.BoolProperty(name="Volume", default=True)
    cameras: bpy.props.BoolProperty(name="Cameras", default=True)
    photographs: bpy.props.StringProperty(
        name="Photographs", default="", description="Their folder, where they are no longer where the report has them")

    def execute(self, context):
        try:
            made = import_result(Path(self.filepath).parent, self.model, self.volume, self.cameras,
                                 self.photographs or None, context.scene)
        except ValueError as fault:
            self.report({"ERROR"}, str(fault))
            return {"CANCELLED"}
        for warning in made["warnings"]:
            self.report({"WARNING"}, warning)
        return {"FINISHED"}


class LookThrough(bpy.types.Operator):
    """Make the active camera the scene's, with the size of its photograph"""

    bl_idname = "view3d.photohull_look_through"
    bl_label = "Look through photohull camera"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        return context.object is not None and "photohull_size" in context.object

    def execute(self, context):
        look_through(context.scene, context.object)
        return {"FINISHED"}


def add_to_import_menu(self, _context):
    self.layout.operator(ImportResult.bl_idname, text="photohull result (report.json)")


def add_to_object_menu(self, context):
    if LookThrough.poll(context):
        self.layout.operator(LookThrough.bl_idname)


def register():
    for kind in (ImportResult, LookThrough):
        bpy.utils.register_class(kind)
    bpy.types.TOPBAR_MT_file_import.append(add_to_import_menu)
    bpy.types.VIEW3D_MT_object.append(add_to_object_menu)


def unregister():
    bpy.types.VIEW3D_MT_object.remove(add_to_object_menu)
    bpy.types.TOPBAR_MT_file_import.remove(add_to_import_menu)
    for kind in (LookThrough, ImportResult):
        bpy.utils.unregister_class(kind)


if __name__ == "__main__":
    register()
