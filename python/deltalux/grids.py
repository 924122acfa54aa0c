"""Measuring grids: where illuminance is asked for, and what it comes to."""

from __future__ import annotations

import math
import os
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _core
from .errors import InputError
from .scenes import Path

if TYPE_CHECKING:
    from .mesh import Mesh
    from .solution import Solution

Array = npt.NDArray[np.float64]


class GridStats(NamedTuple):
    """Illuminance over a grid [lux], and its uniformity as EN 12464-1 has it."""

    Em: float  #: mean
    Emin: float
    Emax: float
    U0: float  #: Emin / Em; nan where all is dark
    Ud: float  #: Emin / Emax; nan where all is dark


class SensorGrid:
    """Points (N,3) and unit normals (N,3), float64, in the coordinates of the scene's files."""

    def __init__(self, points: npt.ArrayLike, normals: npt.ArrayLike) -> None:
        """normals: (N,3), or one (3,) for all; of any length. Raises ValueError: shapes, not finite, no direction."""
        self.points = np.array(points, float)
        given = np.asarray(normals, float)
        if self.points.ndim != 2 or self.points.shape[1] != 3:
            raise ValueError(f"points: an array of shape (N, 3) is wanted, this one has {self.points.shape}")
        if given.shape not in ((3,), self.points.shape):
            raise ValueError(f"normals: shape {given.shape}; one for each of {len(self.points)} points, or one for all")
        lengths = np.linalg.norm(given, axis=-1, keepdims=True)
        if not np.all(np.isfinite(self.points)) or not np.all(np.isfinite(given)):
            raise ValueError("points and normals are finite")
        if not np.all(lengths > 0):
            raise ValueError("normals have a direction")
        self.normals = np.array(np.broadcast_to(given / lengths, self.points.shape))

    def __len__(self) -> int:
        return len(self.points)

    @classmethod
    def from_pts(cls, file: Path) -> SensorGrid:
        """Reads points as Radiance's programs and honeybee write them: "x y z nx ny nz" a line, separated by blanks, tabs
        or commas; blank lines and those that start with # are skipped. Raises InputError with the line."""
        name, rows = os.fspath(file), []
        try:
            with open(file, encoding="utf-8-sig") as lines:
                for number, line in enumerate(lines, 1):
                    text = line.strip()
                    if text and not text.startswith("#"):
                        rows.append(_row(text, name, number))
        except (OSError, UnicodeDecodeError) as error:
            reason = error.strerror if isinstance(error, OSError) else "is no text"
            raise InputError(f"cannot be read: {reason}", "", name) from None
        if not rows:
            raise InputError("has no points", "a line for each: x y z nx ny nz", name)
        table = np.array(rows)
        return cls(table[:, :3], table[:, 3:])

    @classmethod
    def from_rectangle(
        cls,
        corner: npt.ArrayLike,
        u: npt.ArrayLike,
        v: npt.ArrayLike,
        *,
        spacing: float | None = None,
        border: float = 0.0,
        metres_per_unit: float = 1.0,
    ) -> SensorGrid:
        """Points in the middle of equal cells of a rectangle, rows along u; they look along u x v.

        corner, u, v: (3,), the edges at right angles.  spacing: at most that far apart, in scene units; None: as
        EN 12464-1 says, 0.2 m 5^log10(d / 1 m), at most 10 m, d the longer side, or the shorter where the ratio is 2 or
        more, and the nearest whole number of cells.  border: a strip that is left out along all edges, in scene units.
        metres_per_unit: of the scene, for None.  Raises InputError: more than a million points.
        """
        c, along, across = (_vector(x, name) for x, name in ((corner, "corner"), (u, "u"), (v, "v")))
        lengths = np.array([np.linalg.norm(along), np.linalg.norm(across)])
        if not np.all(lengths > 0) or abs(along @ across) > 1e-6 * lengths.prod():
            raise ValueError("u and v are edges of a rectangle: of some length, at right angles")
        if not 0 <= border < lengths.min() / 2:
            raise ValueError("border: not negative, and less than half of the shorter edge")
        if not metres_per_unit > 0:
            raise ValueError("metres_per_unit is above 0")
        inset = border / lengths
        corner = c + inset[0] * along + inset[1] * across
        sides = (1 - 2 * inset[0]) * along, (1 - 2 * inset[1]) * across
        points = _core.rectangle_grid(corner, *sides, metres_per_unit, _metres(spacing, metres_per_unit))
        return cls(points, np.cross(along, across))

    @classmethod
    def from_surface(
        cls, solution: Solution, name: str, *, spacing: float, facing: npt.ArrayLike | None = None
    ) -> SensorGrid:
        """Points on an object of a solution's scene, `spacing` scene units apart, where they are seen from `facing`.

        facing: a direction (3,), the scene's up without it. Along it the points lie on a square grid, each on the
        object's nearest side that looks there within 60 degrees; they look along that side's normal. Raises InputError:
        no such object (near misses), or nothing of it looks there.
        """
        mesh = solution.mesh()
        direction = _vector(mesh.up if facing is None else facing, "facing")
        if not np.any(direction):
            raise ValueError("facing: a direction of some length")
        direction = direction / np.linalg.norm(direction)
        corners, normals = _sides_of(mesh, name)
        looks = normals @ direction > 0.5
        if not looks.any():
            raise InputError(f"no side of {name!r} looks along {direction.tolist()}", "say where to by `facing`")
        return cls(*_seen_from(direction, corners[looks], normals[looks], spacing))

    def stats(self, lux: npt.ArrayLike) -> GridStats:
        """Em, Emin, Emax [lux], U0, Ud of illuminances (N,) at the points."""
        E = np.asarray(lux, float)
        if E.shape != (len(self.points),) or len(E) == 0:
            raise ValueError(f"lux: one for each of {len(self.points)} points is wanted, this array has {E.shape}")
        mean, least, most = float(E.mean()), float(E.min()), float(E.max())
        return GridStats(mean, least, most, least / mean if mean > 0 else math.nan, least / most if most > 0 else math.nan)


def en12464_spacing(width: float, height: float) -> float:
    """Grid spacing [m] of EN 12464-1 for an area of width x height [m]."""
    return _core.grid_spacing(width, height)


def _row(text: str, file: str, line: int) -> list[float]:
    fields = text.replace(",", " ").split()
    if len(fields) != 6:
        raise InputError(f"has {len(fields)} fields", "x y z nx ny nz", file, line)
    try:
        numbers = [float(field) for field in fields]
    except ValueError:
        raise InputError("has a field that is no number", "x y z nx ny nz", file, line) from None
    if not all(map(math.isfinite, numbers)):
        raise InputError("has a number that is not finite", "", file, line)
    if not any(numbers[3:]):
        raise InputError("the normal nx ny nz has no direction", "give the direction that the sensor looks in", file, line)
    return numbers


def _vector(value: npt.ArrayLike, name: str) -> Array:
    vector = np.asarray(value, float)
    if vector.shape != (3,) or not np.all(np.isfinite(vector)):
        raise ValueError(f"{name}: three finite numbers")
    return vector


def _metres(spacing: float | None, metres_per_unit: float) -> float:
    """As the core takes it: 0 stands for the standard's."""
    if spacing is None:
        return 0.0
    if not (math.isfinite(spacing) and spacing > 0):
        raise ValueError("spacing is above 0")
    return spacing * metres_per_unit


def _sides_of(mesh: Mesh, name: str) -> tuple[Array, Array]:
    """Triangles (T,3,3) and unit normals (T,3) of the object and of all below it."""
    parts = {o for o in mesh.objects if o == name or o.startswith((name + ".", name + "/")) or o.endswith("/" + name)}
    if not parts:
        near = ", ".join(_core.near_misses(name, mesh.objects))
        raise InputError(f"there is no object {name!r}", f"nearest: {near}" if near else "the scene has none")
    corners = [s.positions[s.triangles] for s in mesh.surfaces if s.object in parts]
    triangles = np.concatenate([*corners, np.empty((0, 3, 3), np.float32)]).astype(float) + mesh.origin
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    lengths = np.linalg.norm(normals, axis=1)
    kept = lengths > 0
    return triangles[kept], normals[kept] / lengths[kept, None]


def _seen_from(direction: Array, corners: Array, normals: Array, spacing: float) -> tuple[Array, Array]:
    """Points of a square grid across `direction`, on the triangles nearest to where it leads, and their normals."""
    least = np.eye(3)[np.argmin(np.abs(direction))]
    u = np.cross(least, direction)
    u /= np.linalg.norm(u)
    v = np.cross(direction, u)
    flat = corners @ np.stack([u, v], axis=1)  # (T,3,2)
    low, high = flat.min(axis=(0, 1)), flat.max(axis=(0, 1))
    edges = (high[0] - low[0]) * u, (high[1] - low[1]) * v
    places = _core.rectangle_grid(low[0] * u + low[1] * v, *edges, 1.0, _metres(spacing, 1.0)) @ np.stack([u, v], axis=1)
    depth, best = np.full(len(places), -math.inf), np.full(len(places), -1)
    for t, (a, b, c) in enumerate(flat):
        near = np.flatnonzero(np.all((places >= flat[t].min(axis=0)) & (places <= flat[t].max(axis=0)), axis=1))
        if len(near) == 0:
            continue
        shares = np.linalg.solve(np.stack([b - a, c - a], axis=1), (places[near] - a).T)  # barycentric
        inside = (shares.min(axis=0) >= -1e-9) & (shares.sum(axis=0) <= 1 + 1e-9)
        at = corners[t, 0] @ direction + shares.T @ ((corners[t, 1:] - corners[t, 0]) @ direction)
        wins = inside & (at > depth[near])
        depth[near[wins]], best[near[wins]] = at[wins], t
    hit = best >= 0
    points = places[hit] @ np.stack([u, v]) + depth[hit, None] * direction
    return points, normals[best[hit]]
