"""Views and pictures in files."""

from __future__ import annotations

import os

import numpy as np
import numpy.typing as npt

from . import _core
from .scenes import Path


def load_view(file: Path) -> _core.View:
    """Reads a Radiance view file (.vf): its last line that holds a view. Raises InputError."""
    return _core.load_view(os.fsencode(file))


def save_image(path: Path, radiance: npt.ArrayLike, *, ev: float | None = None, efficacy: float = 179.0) -> None:
    """Writes radiance (h, w, 3) [W/(sr m2)], atomically: .exr (32-bit float), .hdr (RGBE) or, tone-mapped, .png.

    ev: exposure of a .png in stops; at 0 a radiance of 1 counts as 1. None: chosen from the picture.  efficacy: of the
    scene [lm/W], which an .exr says. Raises OutputError, and ValueError: shape, another kind of file.
    """
    _core.save_image(os.fsencode(path), np.asarray(radiance, np.float32), ev, efficacy)


def load_image(file: Path) -> npt.NDArray[np.float32]:
    """Reads a .exr or .hdr: radiance (h, w, 3) [W/(sr m2)], rows from the top. Raises InputError."""
    return _core.load_image(os.fsencode(file))
