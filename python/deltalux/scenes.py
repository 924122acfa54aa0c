"""Scenes from files and from plain data."""

from __future__ import annotations

import difflib
import math
import os
import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from . import _core
from .errors import InputError, SceneWarning

Path = str | os.PathLike[str]
Triple = tuple[float, float, float]

SUN_RADIUS = 0.2667  # of the sun's disc, in degrees


def load(
    *files: Path,
    metres_per_unit: float = 1.0,
    efficacy: float = 179.0,
    luminaires: Iterable[tuple[Path, npt.ArrayLike]] = (),
) -> _core.Scene:
    """Reads a scene: one .gltf, .glb, .obj, .xml (Mitsuba) or .pbrt file, or .rad files that make one, in order.

    metres_per_unit: length of the unit of files; glTF is in metres, and takes none.
    efficacy: lm/W that turn a glTF scene's candela, lux and cd/m2 into watts; other formats hold watts, and take none.
    luminaires: (file, (x, y, z)) each: IES LM-63 lights, hung there and aimed against the scene's up.

    Raises InputError: file, line, what to do. What was ignored is a SceneWarning, and stands in ``scene.warnings``.
    """
    if not files:
        raise TypeError("load() takes at least one file")
    gltf = os.fspath(files[0]).lower().endswith((".gltf", ".glb"))
    if gltf and metres_per_unit != 1:
        raise ValueError("metres_per_unit: glTF scenes are in metres")
    if not gltf and efficacy != 179:
        raise ValueError("efficacy: only glTF scenes hold photometric values")
    for name, value in (("metres_per_unit", metres_per_unit), ("efficacy", efficacy)):
        if not (math.isfinite(value) and value > 0):
            raise ValueError(f"{name} is above 0")
    hung = [(os.fsencode(file), np.asarray(position, float)) for file, position in luminaires]
    scene = _core.load([os.fsencode(file) for file in files], metres_per_unit, efficacy, hung)
    _warn(scene)
    return scene


def _warn(scene: _core.Scene) -> None:
    for text in scene.warnings:
        warnings.warn(text, SceneWarning, stacklevel=3)


class _Fields:
    """A dictionary whose every key has a meaning; messages say where it stands."""

    def __init__(self, value: Any, where: str) -> None:
        if not isinstance(value, Mapping):
            raise InputError(f"{where} is a dictionary, not {type(value).__name__}")
        self.value, self.where, self.asked = value, where, set[str]()

    def fail(self, key: str, what: str, hint: str = "") -> InputError:
        return InputError(f"{self.where}[{key!r}] {what}", hint)

    def get(self, key: str) -> Any:
        self.asked.add(key)
        return self.value.get(key)

    def need(self, key: str, hint: str) -> Any:
        if self.get(key) is None:
            raise InputError(f"{self.where} has no {key!r}", hint)
        return self.value[key]

    def done(self) -> None:
        for key in self.value:
            if key not in self.asked:
                near = ", ".join(difflib.get_close_matches(str(key), self.asked, cutoff=0)[:3])
                raise InputError(f"{self.where} has an unknown key {key!r}", f"nearest: {near}" if near else "")

    def array(self, key: str, hint: str, dtype: type = float) -> npt.NDArray[Any]:
        value = self.need(key, hint)
        try:
            return np.asarray(value, dtype)
        except (TypeError, ValueError):
            raise self.fail(key, "holds something that is no number", hint) from None

    def number(self, key: str, default: float | None, low: float, high: float, hint: str) -> float:
        if default is not None and self.get(key) is None:
            return default
        value = self.array(key, hint)
        if value.shape != () or not low <= float(value) <= high:
            raise self.fail(key, f"is no number from {low:g} to {high:g}", hint)
        return float(value)

    def rgb(self, key: str, default: float | None, high: float, hint: str) -> Triple:
        """Three channels, or one number for all."""
        if default is not None and self.get(key) is None:
            return (default,) * 3
        value = self.array(key, hint)
        if value.shape not in ((), (3,)):
            raise self.fail(key, "is neither one number nor three", hint)
        if not np.all((value >= 0) & (value <= high)):
            raise self.fail(key, f"lies in 0 to {high:g}" if high < math.inf else "is not negative, and finite", hint)
        if not np.all(np.isfinite(value)):
            raise self.fail(key, "is not finite", hint)
        r, g, b = np.broadcast_to(value, 3).tolist()
        return r, g, b

    def vector(self, key: str, hint: str, direction: bool = False) -> Triple:
        value = self.array(key, hint)
        if value.shape != (3,) or not np.all(np.isfinite(value)):
            raise self.fail(key, "is no three finite numbers", hint)
        if direction and not np.any(value):
            raise self.fail(key, "has no length", hint)
        x, y, z = value.tolist()
        return x, y, z

    def flag(self, key: str) -> bool:
        value = self.get(key)
        if value is not None and not isinstance(value, (bool, np.bool_)):
            raise self.fail(key, "is True or False")
        return bool(value)

    def choice(self, key: str, default: str | None, choices: Iterable[str]) -> str:
        value = default if self.get(key) is None else self.value[key]
        if value not in choices:
            raise self.fail(key, f"is {value!r}" if value is not None else "is missing", f"one of {', '.join(choices)}")
        return value


def _named(data: _Fields, key: str) -> Iterable[tuple[str, Any, str]]:
    """(name, what has it, where it stands) of a dictionary of things by name."""
    things = data.get(key)
    if things is None:
        return
    if not isinstance(things, Mapping):
        raise InputError(f"{data.where}[{key!r}] is a dictionary of things by their names, not {type(things).__name__}")
    for name, thing in things.items():
        if not isinstance(name, str) or not name:
            raise InputError(f"{data.where}[{key!r}]: {name!r} is no name", "names are texts, not empty")
        yield name, thing, f"{data.where}[{key!r}][{name!r}]"


REFLECTANCE = "a share of light, one number or three (linear RGB)"


def _add_material(builder: _core.SceneBuilder, name: str, fields: _Fields) -> None:
    kind = fields.choice("kind", "opaque", ("opaque", "mirror", "glass", "dielectric"))
    emits = fields.get("emission") is not None
    if kind == "opaque":
        reflectance = fields.rgb("reflectance", 0.0 if emits else None, 1, REFLECTANCE)
        specular = fields.rgb("specular", 0.0, 1, REFLECTANCE)
        if max(a + b for a, b in zip(reflectance, specular)) > 1 + 1e-6:
            raise InputError(f"{fields.where} reflects more than it receives", "reflectance and specular: 1 together")
        builder.opaque(name, reflectance, specular, fields.number("roughness", 0, 0, 1, "0: a perfect mirror"))
    elif kind == "mirror":
        builder.mirror(name, fields.rgb("reflectance", None, 1, REFLECTANCE))
    elif kind == "glass":
        transmissivity = fields.rgb("transmissivity", None, 1, "of one passage through the pane")
        builder.glass(name, transmissivity, fields.number("ior", 1.52, 1, 10, "index of refraction"))
    else:
        transmission = fields.rgb("transmission", 1.0, 1, "of a unit of length")
        builder.dielectric(name, transmission, fields.number("ior", 1.5, 1, 10, "index of refraction"))
    both_sides = fields.flag("both_sides")
    if emits:
        builder.emission(fields.rgb("emission", None, math.inf, "radiance [W/(sr m2)]"), both_sides)
    elif both_sides:
        raise fields.fail("both_sides", "says where it emits, and it does not", "give it an emission")
    fields.done()


def _vertices(fields: _Fields) -> npt.NDArray[np.float64]:
    hint = "an array of shape (V, 3), in scene units"
    vertices = fields.array("vertices", hint)
    if vertices.ndim != 2 or vertices.shape[1] != 3 or len(vertices) < 3:
        raise fields.fail("vertices", f"has shape {vertices.shape}", hint)
    bad = np.flatnonzero(~np.isfinite(vertices).all(axis=1))
    if len(bad):
        raise fields.fail("vertices", f"is not finite in row {bad[0]}")
    return vertices


def _triangles(fields: _Fields, count: int) -> npt.NDArray[np.uint32]:
    hint = "an array of shape (T, 3) of rows of vertices, counter-clockwise seen from the front"
    triangles = np.asarray(fields.need("triangles", hint))
    if triangles.ndim != 2 or triangles.shape[1] != 3 or not np.issubdtype(triangles.dtype, np.integer):
        raise fields.fail("triangles", f"has shape {triangles.shape} and type {triangles.dtype}", hint)
    bad = np.flatnonzero(((triangles < 0) | (triangles >= count)).any(axis=1))
    if len(bad):
        raise fields.fail(
            "triangles", f"names a vertex out of range in row {bad[0]}: {triangles[bad[0]].tolist()}", f"there are {count}"
        )
    return triangles.astype(np.uint32)


def _normals(fields: _Fields, count: int) -> npt.NDArray[np.float64] | None:
    if fields.get("normals") is None:
        return None
    hint = "one for each vertex, of some length"
    normals = fields.array("normals", hint)
    if normals.shape != (count, 3):
        raise fields.fail("normals", f"has shape {normals.shape}, not {(count, 3)}", hint)
    if not np.all(np.isfinite(normals)) or not np.all(np.any(normals, axis=1)):
        raise fields.fail("normals", "has a row without direction", hint)
    return normals


def _add_shapes(builder: _core.SceneBuilder, data: _Fields, key: str, materials: Sequence[str]) -> None:
    for name, things, where in _named(data, key):
        several = isinstance(things, (list, tuple))
        for i, thing in enumerate(things if several else [things]):
            fields = _Fields(thing, f"{where}[{i}]" if several else where)
            material = fields.need("material", "the name of one of the materials")
            if material not in materials:
                near = ", ".join(difflib.get_close_matches(str(material), materials, cutoff=0)[:3])
                raise fields.fail("material", f"is {material!r}, and no material is", f"nearest: {near}" if near else "")
            vertices = _vertices(fields)
            if key == "polygons":
                made, hint = builder.polygon(name, material, vertices), "its vertices lie in one plane, in order"
            else:
                triangles, normals = _triangles(fields, len(vertices)), _normals(fields, len(vertices))
                made, hint = builder.mesh(name, material, vertices, triangles, normals), "no triangle has an area"
            fields.done()
            if not made:
                raise InputError(f"{fields.where} is no surface: it has no area, or no plane", hint)


INTENSITY = "radiant intensity [W/sr], one number or three (linear RGB)"
PLACE = "(x, y, z) in scene units"


def _add_light(builder: _core.SceneBuilder, name: str, fields: _Fields) -> None:
    def point() -> None:
        builder.point(name, fields.vector("position", PLACE), fields.rgb("intensity", None, math.inf, INTENSITY))

    def lambert() -> None:
        direction = fields.vector("direction", "in which it shines", direction=True)
        intensity = fields.rgb("intensity", None, math.inf, INTENSITY)
        builder.lambert(name, fields.vector("position", PLACE), direction, intensity)

    def spot() -> None:
        direction = fields.vector("direction", "in which it shines", direction=True)
        intensity = fields.rgb("intensity", None, math.inf, INTENSITY)
        outer = fields.number("outer", 45, 0, 90, "half the angle of its cone [degrees]")
        inner = fields.number("inner", 0, 0, outer, "half the angle within which it does not fall off [degrees]")
        position = fields.vector("position", PLACE)
        builder.spot(name, position, direction, intensity, math.radians(inner), math.radians(outer))

    def ies() -> None:
        file = fields.need("file", "an IES LM-63 file")
        if not isinstance(file, (str, os.PathLike)):
            raise fields.fail("file", "is no name of a file")
        builder.measured(name, os.fsencode(file), fields.vector("position", PLACE))

    def sun() -> None:
        radius = fields.number("radius", SUN_RADIUS, 1e-3, 90, "of its disc [degrees]")
        irradiance = fields.rgb("irradiance", None, math.inf, "across the beam [W/m2]")
        builder.sun(name, fields.vector("towards", "the direction to it", True), irradiance, math.radians(radius))

    def sky() -> None:
        radiance = fields.rgb("radiance", None, math.inf, "[W/(sr m2)]; of a CIE sky, at the zenith")
        cie, sun = fields.get("cie"), (0.0, 0.0, 1.0)
        if cie is not None:
            if cie not in range(1, 16):
                raise fields.fail("cie", f"is {cie!r}", "a CIE standard general sky, 1 to 15")
            sun = fields.vector("sun", "the direction to the sun, on which a CIE sky depends", direction=True)
        builder.sky(name, radiance, None if cie is None else int(cie), sun)

    kinds: dict[str, Callable[[], None]] = {
        "point": point, "lambert": lambert, "spot": spot, "ies": ies, "sun": sun, "sky": sky,
    }  # fmt: skip
    kinds[fields.choice("kind", None, kinds)]()
    fields.done()


def _add_view(builder: _core.SceneBuilder, name: str, fields: _Fields, up: Triple) -> None:
    position, direction = fields.vector("position", PLACE), fields.vector("direction", "of sight", direction=True)
    own_up = up if fields.get("up") is None else fields.vector("up", "of the picture", direction=True)
    parallel = fields.flag("parallel")
    most = math.inf if parallel else 179.999
    extent = "a full angle [degrees]" if not parallel else "in scene units"
    horizontal, vertical = (fields.number(key, 45, 1e-6, most, extent) for key in ("horizontal", "vertical"))
    try:
        builder.view(_core.View(position, direction, own_up, horizontal, vertical, parallel, name))
    except ValueError as error:
        raise InputError(f"{fields.where}: {error}") from None
    fields.done()


def load_dict(data: Mapping[str, Any]) -> _core.Scene:
    """A scene from plain data; arrays are anything that NumPy takes. docs/python.md has an example.

    metres_per_unit: length of its unit; 1.  efficacy: lm/W by which its light is told; 179.  up: (0, 0, 1).
    materials: by name; {"kind", ...}:
        "opaque" (the default): reflectance, specular, roughness;  "mirror": reflectance;
        "glass", a thin pane: transmissivity of a passage, ior;  "dielectric", a body: transmission of a unit, ior.
        All may have emission, radiance [W/(sr m2)] of the front, or of both_sides. Surfaces that emit are lights, of
        their object's name.
    meshes: by the name of their object, one or a list: {"vertices": (V,3), "triangles": (T,3) integers, "material",
        "normals": (V,3) for smooth shading}.
    polygons: the same: {"vertices": (V,3) in order around, counter-clockwise seen from the front, "material"}.
    lights: by name; {"kind", ...}: "point": position, intensity [W/sr];  "lambert": the same, direction;
        "spot": the same, and outer and inner half angles [degrees] of its cone;  "ies": file, position;
        "sun": towards (where it is), irradiance across its beam [W/m2], radius of its disc [degrees];
        "sky", of the upper half: radiance [W/(sr m2)], everywhere or, of the sky cie (1 to 15; sun: towards it), at the
        zenith.
    views: by name; {"position", "direction", "up", "horizontal", "vertical", "parallel"} as View has them.

    Names with dots are parts: "table.leg" is moved with "table". Reflectances lie in 0 to 1; one number is grey.
    Raises InputError, whose message says what stands where.
    """
    fields = _Fields(data, "scene")
    up = (0.0, 0.0, 1.0) if fields.get("up") is None else fields.vector("up", "a direction", direction=True)
    metres = fields.number("metres_per_unit", 1, 1e-9, 1e9, "length of the unit [m]")
    builder = _core.SceneBuilder(metres, fields.number("efficacy", 179, 1e-9, 1e9, "[lm/W]"), up)
    materials = []
    for name, thing, where in _named(fields, "materials"):
        _add_material(builder, name, _Fields(thing, where))
        materials.append(name)
    for key in ("meshes", "polygons"):
        _add_shapes(builder, fields, key, materials)
    for name, thing, where in _named(fields, "lights"):
        _add_light(builder, name, _Fields(thing, where))
    for name, thing, where in _named(fields, "views"):
        _add_view(builder, name, _Fields(thing, where), up)
    fields.done()
    scene = builder.finish()
    _warn(scene)
    return scene
