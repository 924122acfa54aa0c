"""Edits of a solved scene."""

from __future__ import annotations

import os
from types import TracebackType
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _core
from .scenes import Path, load

if TYPE_CHECKING:
    from .solution import Solution

Rgb = tuple[float, float, float]


class LightEdits:
    """A light in an edit block: the one of the name, and every "NAME.*"."""

    __slots__ = ("_edits", "name")

    def __init__(self, edits: _core.EditList, name: str) -> None:
        self._edits, self.name = edits, name

    def _states(self) -> list[_core.LightState]:
        states = self._edits.lights(self.name)
        if not states:
            self._edits.dim(self.name, 1.0)  # says what is nearest
        return states

    @property
    def rgb(self) -> Rgb:
        """Its dimming by channel: (1, 1, 1) as it was read. Of several lights that of the first; of one that is off,
        what it has when it is on. Assigning takes three numbers, or one for all."""
        return self._states()[0].rgb

    @rgb.setter
    def rgb(self, value: npt.ArrayLike) -> None:
        self._edits.colour(self.name, np.broadcast_to(np.asarray(value, float), 3))

    @property
    def scale(self) -> float:
        """Its dimming: the largest channel of rgb; 1 as it was read. Assigning dims each light to it, and keeps the
        light's colour."""
        return max(self._states()[0].rgb)

    @scale.setter
    def scale(self, value: float) -> None:
        # Parts after what they are parts of, whose name means them too.
        for light in sorted(self._states(), key=lambda light: len(light.name)):
            most = max(light.rgb)
            colour = [value * channel / most for channel in light.rgb] if most > 0 else [value] * 3
            self._edits.colour(light.name, np.asarray(colour, float))

    def dim(self, factor: float) -> None:
        """Multiplies its present dimming."""
        self._edits.dim(self.name, factor)

    @property
    def on(self) -> bool:
        """Whether it (of several, the first) is on. Off, a light keeps its dimming for when it is on again."""
        return self._states()[0].on

    @on.setter
    def on(self, value: bool) -> None:
        self._edits.switch(self.name, bool(value))

    def aim(self, direction: npt.ArrayLike) -> None:
        """Turns a light that has a direction (spots, measured lights, the sun) to shine in `direction`, (3,)."""
        self._edits.aim(self.name, np.asarray(direction, float))

    def move(self, offset: npt.ArrayLike) -> None:
        """Moves it by `offset`, (3,) in scene units; area lights with their surface."""
        self._edits.move_light(self.name, np.asarray(offset, float))


class MaterialEdits:
    """A material in an edit block."""

    __slots__ = ("_edits", "name")

    def __init__(self, edits: _core.EditList, name: str) -> None:
        self._edits, self.name = edits, name

    def _state(self) -> _core.MaterialState:
        state = self._edits.material(self.name)
        if state is None:
            self._edits.set_material(self.name, None, 0.0)  # says what is nearest
            raise AssertionError
        return state

    @property
    def reflectance(self) -> Rgb | None:
        """Diffuse, a mirror's, or of a metal without a diffuse part its gloss's; None of what is clear. Assigning takes
        three numbers in 0 to 1, or one for all."""
        return self._state().reflectance

    @reflectance.setter
    def reflectance(self, value: npt.ArrayLike) -> None:
        self._edits.set_material(self.name, np.broadcast_to(np.asarray(value, float), 3), None)

    @property
    def roughness(self) -> float | None:
        """Of its gloss, in 0 to 1; None where it has none."""
        return self._state().roughness

    @roughness.setter
    def roughness(self, value: float) -> None:
        self._edits.set_material(self.name, None, value)


class Edits:
    """What ``with solution.edit() as e:`` gives.

    Edits are tried one by one, where they are written: InputError names what is not there, with near misses, or cannot
    be. They are applied, and the solution updated once, when the block is left; after an exception in it, none is.
    """

    def __init__(self, solution: Solution, progress: Any = None) -> None:
        self._solution, self._progress = solution, progress
        self._list: _core.EditList | None = None
        #: What the update (or the last frame) did, with the keys of the command line's reports ("steps"); None before,
        #: and where there was nothing to do.
        self.report: dict[str, Any] | None = None

    def __enter__(self) -> Edits:
        self._list = self._solution._core.edit()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        edits, self._list = self._edits, None
        if error is not None:
            self._solution._core.take_back(edits)
        elif len(edits) > 0:
            self.report = self._solution._update(edits, self._progress)

    @property
    def _edits(self) -> _core.EditList:
        if self._list is None:
            raise RuntimeError("edits are made in a block: with solution.edit() as e: ...")
        return self._list

    def move(
        self,
        name: str,
        *,
        translate: npt.ArrayLike | None = None,
        rotate: tuple[Any, ...] | None = None,
        matrix: npt.ArrayLike | None = None,
    ) -> None:
        """Moves an object, all below it, and the lights named after it, from where they are now.

        rotate: (axis, degrees) or (axis, degrees, about): by the right hand about an axis (3,) through the point `about`
        (3,), the origin without it.  translate: (3,) in scene units, after that.  matrix: (4,4), rows first, affine; by
        itself. All in the coordinates of the scene's files.
        """
        if (translate is None and rotate is None) == (matrix is None):
            raise ValueError("move takes a matrix, or else translate, rotate or both")
        if matrix is not None:
            return self._edits.transform(name, np.asarray(matrix, float))
        if rotate is not None:
            if len(rotate) not in (2, 3):
                raise ValueError("rotate is (axis, degrees) or (axis, degrees, about)")
            axis, degrees, about = (*rotate, (0.0, 0.0, 0.0))[:3]
            self._edits.rotate(name, np.asarray(axis, float), degrees, np.asarray(about, float))
        if translate is not None:
            self._edits.translate(name, np.asarray(translate, float))

    def add(self, name: str, part: _core.Scene | Path, matrix: npt.ArrayLike | None = None) -> None:
        """Puts all of a scene but its sky, sun and views into this one, as the object `name`.

        part: a Scene, or a file that load() reads.  matrix: (4,4), from its coordinates to these; without it they are
        the same.
        """
        file = "" if isinstance(part, _core.Scene) else os.fspath(part)
        scene = part if isinstance(part, _core.Scene) else load(part)
        placed = np.eye(4) if matrix is None else np.asarray(matrix, float)
        self._edits.add(name, scene, placed, os.fsencode(file))

    def remove(self, name: str) -> None:
        """Takes an object away, and all below it."""
        self._edits.remove(name)

    def sky(
        self, sky: str, when: str, where: tuple[float, float], *, north: float = 0.0, ground: float = 0.2
    ) -> None:
        """Puts the sun and the sky of a time and place over the scene, in place of its own.

        sky: "cie:TYPE", "cie:TYPE,LUX" or "perez:DIRECT_NORMAL,DIFFUSE" in W/m2.  when: "2026-06-21T09:00+02:00".
        where: latitude and longitude, degrees north and east.  north: of true north, clockwise from the scene's, degrees.
        ground: its reflectance.
        """
        self._edits.sky(sky, when, where[0], where[1], north, ground)

    def light(self, name: str) -> LightEdits:
        """The light of that name: .scale, .rgb, .on, .aim(), .move(), .dim()."""
        light = LightEdits(self._edits, name)
        light._states()
        return light

    def material(self, name: str) -> MaterialEdits:
        """The material of that name: .reflectance, .roughness."""
        material = MaterialEdits(self._edits, name)
        material._state()
        return material

    def frame(self, milliseconds: float) -> dict[str, Any]:
        """Shows the edits so far, as far as that fits into so much time: a frame of a drag.

        The solution is readable then; "deferred" and "stale_w" of the report say what waits. Leaving the block does the
        rest: the solution is then what one update of all edits had made of it.
        """
        if not milliseconds > 0:
            raise ValueError("a frame takes more than 0 ms")
        self.report = self._solution._frame(self._edits, milliseconds)
        return self.report
