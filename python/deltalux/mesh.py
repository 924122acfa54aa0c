"""Triangles with light on them."""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from . import _core


class Caustic(NamedTuple):
    """A caustic texture, and the triangles that show it; arrays are read-only views of the snapshot."""

    surface: int  #: number of its surface in the scene
    front: bool
    texels: npt.NDArray[np.float32]  #: (h,w,4): E [W/m2], and 1; 0 in the fourth where nothing is shown
    positions: npt.NDArray[np.float32]  #: (V,3), relative to Mesh.origin
    texcoords: npt.NDArray[np.float32]  #: (V,2) in 0 to 1, texel centres at (i + 0.5) / size, the first row at 0
    triangles: npt.NDArray[np.uint32]  #: (T,3)


class Mesh:
    """A snapshot of a solution as triangles: what later updates do not change.

    Irradiance at a point is direct + indirect + particle of the triangles plus what the caustic textures show there.
    Snapshots of one solution are numbered, and share what is the same; each surface says in which it last changed.
    """

    def __init__(self, core: _core.MeshSnapshot) -> None:
        self._core = core

    @property
    def version(self) -> int:
        """The number of the snapshot."""
        return self._core.version

    @property
    def origin(self) -> npt.NDArray[np.float64]:
        """(3,): what is added to positions of surfaces for the coordinates of the scene's files; mostly 0."""
        return self._core.origin

    @property
    def up(self) -> npt.NDArray[np.float64]:
        """(3,): the scene's up, unit."""
        return self._core.up

    @property
    def objects(self) -> list[str]:
        """Names of all objects of the scene."""
        return self._core.objects

    @cached_property
    def surfaces(self) -> list[_core.SurfaceMesh]:
        """The sides of surfaces that are seen: their arrays are read-only views of the snapshot, without a copy."""
        return self._core.surfaces

    @cached_property
    def caustics(self) -> list[Caustic]:
        """All caustic textures."""
        return [Caustic(*caustic) for caustic in self._core.caustics]

    @cached_property
    def vertices(self) -> npt.NDArray[np.float64]:
        """(V,3): all vertices, surface after surface, in the coordinates of the scene's files; read-only."""
        return _read_only(self._joined([s.positions for s in self.surfaces], 3, np.float32) + self.origin)

    @cached_property
    def normals(self) -> npt.NDArray[np.float32]:
        """(V,3): unit, out of the side that they are of; read-only."""
        return _read_only(self._joined([s.normals for s in self.surfaces], 3, np.float32))

    @cached_property
    def irradiance(self) -> npt.NDArray[np.float32]:
        """(V,3) [W/m2], linear RGB: direct + indirect + particle; read-only. What caustic textures show is not in it."""
        return _read_only(self._joined([s.direct + s.indirect + s.particle for s in self.surfaces], 3, np.float32))

    @cached_property
    def triangles(self) -> npt.NDArray[np.uint32]:
        """(T,3): rows of vertices, counter-clockwise seen from the lit side; read-only."""
        firsts = np.cumsum([0] + [len(s.positions) for s in self.surfaces])
        shifted = [s.triangles + np.uint32(first) for s, first in zip(self.surfaces, firsts)]
        return _read_only(self._joined(shifted, 3, np.uint32))

    def changed_since(self, version: int) -> tuple[list[_core.SurfaceMesh], list[_core.SurfaceMesh]]:
        """Surfaces whose shape, and those whose light is another than in the snapshot of that number."""
        return (
            [s for s in self.surfaces if s.shape_version > version],
            [s for s in self.surfaces if s.light_version > version],
        )

    @staticmethod
    def _joined(parts: list[npt.NDArray], width: int, dtype: type) -> npt.NDArray:
        return np.concatenate([*parts, np.empty((0, width), dtype)])


def _read_only(array: npt.NDArray) -> npt.NDArray:
    array.setflags(write=False)
    return array
