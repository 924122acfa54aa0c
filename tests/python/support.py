"""What the tests of the Python package share."""

import contextlib
import csv
import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

import deltalux as dl

SOURCE = pathlib.Path(__file__).resolve().parents[2]
CORNELL = SOURCE / "scenes" / "cornell" / "cornell.rad"
CORNELL_VIEW = SOURCE / "scenes" / "cornell" / "cornell.vf"


def command(*arguments, **options):
    """Runs python -m deltalux and waits."""
    words = [sys.executable, "-m", "deltalux", *map(str, arguments)]
    return subprocess.run(words, capture_output=True, text=True, check=False, **options)


@contextlib.contextmanager
def folder():
    with tempfile.TemporaryDirectory() as name:
        yield pathlib.Path(name)


def table(file):
    """Columns of numbers of a CSV, by name."""
    with open(file, encoding="utf-8") as lines:
        rows = list(csv.DictReader(lines))
    return {name: [float(row[name]) for row in rows] for name in rows[0]}


def square(z=0.0, size=2.0, x=0.0, y=0.0):
    """Corners of a horizontal square about (x, y, z) that faces up."""
    h = size / 2
    return [(x - h, y - h, z), (x + h, y - h, z), (x + h, y + h, z), (x - h, y + h, z)]


def room(**more):
    """A small room with a lamp, a table and a spot, as data for load_dict."""
    corners = [(x, y, z) for x in (0, 3) for y in (0, 3) for z in (0, 2)]
    sides = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    lamp = [(x, y, 1.95) for x, y in ((1.2, 1.2), (1.2, 1.8), (1.8, 1.8), (1.8, 1.2))]
    return {
        "materials": {
            "white": {"reflectance": 0.6},
            "wood": {"reflectance": (0.5, 0.3, 0.2)},
            "glow": {"emission": 20},
        },
        "polygons": {
            "room": [{"vertices": [corners[i] for i in side], "material": "white"} for side in sides],
            "table": {"vertices": square(0.7, 0.8, 1, 1), "material": "wood"},
            "lamp": {"vertices": lamp, "material": "glow"},
        },
        "lights": {
            "spot": {"kind": "spot", "position": (2.5, 2.5, 1.8), "direction": (0, 0, -1), "intensity": (3, 2, 1), "outer": 40}
        },
        **more,
    }


def solved(scene=None, **options):
    return dl.solve(scene or dl.load_dict(room()), **{"error": 0.2, **options})


def main():
    os.chdir(SOURCE)
    unittest.main(module="__main__", verbosity=1)
