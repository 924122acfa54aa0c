"""Physically based global illumination that is updated when the scene changes.

    import deltalux as dl

    solution = dl.solve(dl.load("room.rad"))
    with solution.edit() as e:
        e.move("desk", translate=(0.5, 0, 0))
    lux = solution.lux(points, normals)

Lengths are in scene units, and coordinates those of the scene's files; light is linear RGB, irradiance in W/m2, radiance
in W/(sr m2), illuminance in lux. Errors are exceptions: InputError (a file or a scene is wrong), OutputError (a file could
not be written), ValueError and TypeError (a call is). docs/python.md shows more.
"""

from ._core import Scene, SurfaceMesh, View, __version__
from .editing import Edits, LightEdits, MaterialEdits
from .errors import InputError, OutputError, SceneWarning
from .grids import GridStats, SensorGrid, en12464_spacing
from .images import load_image, load_view, save_image
from .mesh import Caustic, Mesh
from .scenes import load, load_dict
from .solution import Check, Dimming, Glare, Solution, design, open, solve

__all__ = [
    "Caustic",
    "Check",
    "Dimming",
    "Edits",
    "Glare",
    "GridStats",
    "InputError",
    "LightEdits",
    "MaterialEdits",
    "Mesh",
    "OutputError",
    "Scene",
    "SceneWarning",
    "SensorGrid",
    "Solution",
    "SurfaceMesh",
    "View",
    "__version__",
    "design",
    "en12464_spacing",
    "load",
    "load_dict",
    "load_image",
    "load_view",
    "open",
    "save_image",
    "solve",
]
