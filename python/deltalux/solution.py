"""Solving, and what is read from a solution."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable, Mapping
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _core
from .editing import Edits
from .mesh import Mesh
from .scenes import Path

Array = npt.NDArray[np.float64]
Progress = Callable[[str, float], object]


class Check(NamedTuple):
    """A solution against one that was solved from scratch."""

    mesh_identical: bool  #: the patches
    lines_identical: bool  #: where lines go from them
    particles_identical: bool  #: where particles do
    median: float  #: relative difference of irradiance, over 2000 points spread evenly over lit surfaces
    p95: float  #: its 95th percentile
    max: float
    solve_s: float  #: of the solve from scratch [s]


class Glare(NamedTuple):
    """How much what an eye sees disturbs it: UGR of the luminaires, DGP of all that is bright (docs/glare.md)."""

    ugr: float  #: -inf where no luminaire is seen
    background: float  #: Lb [cd/m2]
    luminaires: list[dict[str, Any]]  #: those that disturb most first: name, luminance_cd_m2, solid_angle_sr, ...
    dgp: float
    illuminance: float  #: on the eye [lux]
    sources: list[dict[str, Any]]  #: of DGP, those that disturb most first
    picture: npt.NDArray[np.float32]  #: fisheye of 180 degrees, (size, size, 3): radiance [W/(sr m2)]


class Dimming(NamedTuple):
    """What design() finds."""

    weights: Array  #: (G,), in 0 to 1
    reached: Array  #: (N,), as the targets


class Solution:
    """The light of a scene: measured, shown, and updated when the scene changes. solve() and open() make one.

    Every method may be called from any thread: long ones let other threads run, calls that read go on side by side, and
    wait for those that change the solution. Ctrl-C ends a long call: KeyboardInterrupt. `progress(phase, fraction)` is
    called in the thread of the caller some times a second; what it raises ends the call, too.
    """

    def __init__(self, core: _core.Solution) -> None:
        self._core = core

    @property
    def version(self) -> int:
        """Counts from 1 with every update and frame: the same number, the same solution."""
        return self._core.version

    @property
    def scene(self) -> _core.Scene:
        """The scene as edits have made it: a copy."""
        return self._core.scene

    @property
    def error(self) -> float:
        """The relative error of irradiance that it was solved to."""
        return self._core.error

    @property
    def converged(self) -> bool:
        """Whether that is met everywhere: not so where `seconds` were up before."""
        return self._core.converged

    @property
    def report(self) -> dict[str, Any]:
        """What solving did: "time_s", "counts", "memory_bytes", "error", "energy" of the command line's reports."""
        report = json.loads(self._core.report())
        return {key: report[key] for key in ("time_s", "counts", "memory_bytes", "error", "energy")}

    @property
    def groups(self) -> dict[str, list[str]]:
        """Names of lights by the group whose light is kept apart; {"all": ...} where none is."""
        return dict(self._core.groups)

    def save(self, path: Path) -> None:
        """Writes it into a .dlx file, atomically. Raises OutputError."""
        if not os.fspath(path).lower().endswith(".dlx"):
            raise ValueError(f"{os.fspath(path)}: a solution's name ends in .dlx")
        self._core.save(os.fsencode(path))

    def lux(
        self, points: npt.ArrayLike, normals: npt.ArrayLike, *, seed: int = 1, progress: Progress | None = None
    ) -> Array:
        """Illuminance (N,) [lux] at points (N,3), on the sides that normals, (N,3) or one (3,), point to.

        As `deltalux probe`: a point on a surface (within 1 mm of it, facing along its normal) reads the solution there;
        any other is a light meter in the air and gathers what it sees. Coordinates are those of the scene's files,
        normals of any length. Raises ValueError: another shape, not finite.
        """
        return self._measure(points, normals, seed, progress)[2]

    def irradiance(
        self,
        points: npt.ArrayLike,
        normals: npt.ArrayLike,
        *,
        errors: bool = False,
        seed: int = 1,
        progress: Progress | None = None,
    ) -> Array | tuple[Array, Array]:
        """Irradiance (N,3) [W/m2], linear RGB, at points as lux() takes them; with `errors` also its standard errors
        (N,3) [W/m2]: those of measuring, not of the solution."""
        E, standard_errors, _ = self._measure(points, normals, seed, progress)
        return (E, standard_errors) if errors else E

    def _measure(self, points: Any, normals: Any, seed: int, progress: Any) -> tuple[Array, Array, Array]:
        return self._core.measure(*_meters(points, normals), seed, progress)

    def by_light(
        self, points: npt.ArrayLike, normals: npt.ArrayLike, *, seed: int = 1, progress: Progress | None = None
    ) -> tuple[Array, list[str]]:
        """What each group of lights brings at scale 1, all others off: A (N,G) [lux], and the groups' names.

        Light is linear in the lamps: dimmed by w (G,), the points have A @ w. Raises ValueError where the scene was not
        solved by_light.
        """
        if not self._core.by_light:
            raise ValueError("this solution does not keep its lights apart: solve(scene, by_light=True)")
        A = self._core.measure_by_light(*_meters(points, normals), seed, progress)
        return A, list(self.groups)

    def render(
        self,
        view: _core.View | Path,
        *,
        size: tuple[int, int] = (640, 640),
        samples: int = 16,
        seed: int = 1,
        progress: Progress | None = None,
    ) -> npt.NDArray[np.float32]:
        """Radiance (h, w, 3) [W/(sr m2)], linear RGB, rows from the top: the picture that `deltalux render` writes.

        view: a View, the name of a view of the scene, or a .vf file.  size: (width, height) that the picture fits into;
        it keeps the view's shape.  samples: camera rays per pixel. Raises InputError with near misses.
        """
        return self._core.render(view, size, samples, seed, progress)

    def glare(
        self,
        position: npt.ArrayLike,
        direction: npt.ArrayLike,
        *,
        up: npt.ArrayLike | None = None,
        threshold: float = 2000.0,
        task: npt.ArrayLike | None = None,
        size: int = 512,
        samples: int = 16,
        seed: int = 1,
        progress: Progress | None = None,
    ) -> Glare:
        """Glare from an eye at `position` (3,) that looks along `direction` (3,), as `deltalux glare` has it.

        up: the scene's without it.  threshold: sources of DGP are brighter [cd/m2].  task: a place (3,) that is looked at:
        they are five times as bright as it is, instead.  size, samples: of the fisheye picture.
        """
        given = [None if x is None else np.asarray(x, float) for x in (up, task)]
        text, picture = _core.glare(
            self._core,
            np.asarray(position, float),
            np.asarray(direction, float),
            given[0],
            threshold,
            given[1],
            size,
            samples,
            seed,
            progress,
        )
        found = json.loads(text)
        unified, daylight = found["ugr"][0], found["dgp"]
        ugr = unified["ugr"]
        if ugr is None:
            ugr = np.inf if unified["luminaires"] else -np.inf
        return Glare(
            ugr,
            unified["background_cd_m2"],
            unified["luminaires"],
            daylight["dgp"],
            daylight["illuminance_lux"],
            daylight["sources"],
            picture,
        )

    def ugr(
        self,
        positions: npt.ArrayLike,
        directions: npt.ArrayLike,
        *,
        seed: int = 1,
        progress: Progress | None = None,
    ) -> Array:
        """UGR (N,) of eyes at `positions` (N,3) that look along `directions` (N,3); -inf where no luminaire is seen."""
        return _core.ugr(self._core, np.asarray(positions, float), np.asarray(directions, float), seed, progress)[0]

    def mesh(self) -> Mesh:
        """The solution as triangles with light on them, as it is now: a snapshot that later updates do not change."""
        return Mesh(self._core.mesh())

    def edit(self, *, progress: Progress | None = None) -> Edits:
        """A block of edits, ``with solution.edit() as e:``, and one update at its end (see Edits)."""
        return Edits(self, progress)

    def _update(self, edits: _core.EditList, progress: Any) -> dict[str, Any]:
        return json.loads(self._core.update(edits, progress))["steps"][0]

    def _frame(self, edits: _core.EditList, milliseconds: float) -> dict[str, Any]:
        return json.loads(self._core.frame(edits, milliseconds))["steps"][0]

    @property
    def unfinished(self) -> bool:
        """Whether an update was interrupted: edits are made, their light is not. Reading raises RuntimeError then."""
        return self._core.unfinished

    def finish(self, *, progress: Progress | None = None) -> None:
        """After an interrupted update: solves the scene as it is from scratch. Does nothing otherwise."""
        self._core.finish(progress)

    def check(self, *, progress: Progress | None = None) -> Check:
        """Solves the scene as it is now from scratch, too, and says what differs."""
        found = json.loads(self._core.check(progress))["check"]
        differences = found.pop("irradiance_rel_diff")
        return Check(**found, **differences)


def _meters(points: npt.ArrayLike, normals: npt.ArrayLike) -> tuple[Array, Array]:
    p, n = np.asarray(points, float), np.asarray(normals, float)
    return p, np.broadcast_to(n, p.shape) if n.shape == (3,) and p.shape[1:] == (3,) else n


def solve(
    scene: _core.Scene,
    error: float = 0.05,
    *,
    progress: Progress | None = None,
    by_light: bool = False,
    groups: Mapping[str, str | Iterable[str]] | None = None,
    method: str = "lines",
    threads: int | None = None,
    seed: int = 1,
    seconds: float | None = None,
    particles: int | None = None,
    diffuse_only: bool = False,
    caustic_textures: bool = True,
) -> Solution:
    """The light of a scene, to a target relative error of irradiance: all else follows from it and the scene.

    progress: called as progress(phase, fraction) some times a second.  by_light: keeps the light of each lamp, of each
    sun and of the skies apart (Solution.by_light).  groups: {name: pattern, or patterns}, lights that are dimmed
    together, by their names, in which * stands for anything; implies by_light.  method: "lines", or "paper".  threads:
    at most so many, here and in what is done with the solution; None: all.  seed: the same seed, the same solution, for
    any number of threads.  seconds: ends after about so long with what fits (Solution.converged).  particles: about how
    many carry light over mirrors, gloss and glass; None: as the error wants.  diffuse_only: no gloss, no mirrors.
    caustic_textures: False shows the light of particles on the mesh alone.

    Raises ValueError, InputError (a group's pattern that names no light), KeyboardInterrupt.
    """
    if not 1e-4 <= error <= 0.999:
        raise ValueError("error: a fraction from 0.0001 to 0.999")
    if seconds is not None and not seconds > 0:
        raise ValueError("seconds: above 0, or None")
    if particles is not None and not 1 <= particles <= 1 << 28:
        raise ValueError("particles: at least 1, or None")
    if method == "paper" and (by_light or groups):
        raise ValueError("by_light, groups: light is kept apart by the method 'lines' alone")
    patterns = []
    for group, named in (groups or {}).items():
        patterns += [(group, pattern) for pattern in ([named] if isinstance(named, str) else named)]
    return Solution(
        _core.solve(
            scene,
            error,
            progress,
            by_light or bool(patterns),
            patterns,
            method,
            _threads(threads),
            seed,
            seconds or 0.0,
            particles or 0,
            diffuse_only,
            caustic_textures,
        )
    )


def open(path: Path, *, threads: int | None = None) -> Solution:
    """Reads a solution from a .dlx file, exactly as it was. Raises InputError: no solution, damaged, another version."""
    return Solution(_core.open(os.fsencode(path), _threads(threads)))


def _threads(threads: int | None) -> int:
    if threads is not None and not 1 <= threads <= 4096:
        raise ValueError("threads: 1 to 4096, or None for all")
    return threads or 0


def design(A: npt.ArrayLike, targets: npt.ArrayLike) -> Dimming:
    """What groups of lights are to be dimmed to for illuminances that are wanted.

    A: (N,G), as Solution.by_light has it.  targets: (N,), in its unit. The weights in 0 to 1 have the least sum of
    squared differences between A @ weights, which is `reached`, and the targets: the exact optimum. Light that stays, such
    as daylight, is subtracted from the targets first. Raises ValueError: shapes, A negative, not finite.
    """
    return Dimming(*_core.design(np.asarray(A, float), np.asarray(targets, float)))
