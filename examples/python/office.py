"""An office of 6 x 4 x 2.8 m from plain data: what the other examples measure, light and furnish."""

import numpy as np

import deltalux as dl


def box(low, high):
    """A box as a mesh that is seen from outside."""
    corners = np.array(np.meshgrid(*zip(low, high), indexing="ij")).reshape(3, -1).T  # row 4x + 2y + z
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return {"vertices": corners, "triangles": [t for a, b, c, d in sides for t in ((a, b, c), (a, c, d))]}


def room(low, high):
    """The six walls around a room, seen from inside."""
    shell = box(low, high)
    return {**shell, "triangles": [t[::-1] for t in shell["triangles"]]}


def panel(x, y):
    """A luminous square of 0.6 m under the ceiling."""
    square = [(-0.3, -0.3), (-0.3, 0.3), (0.3, 0.3), (0.3, -0.3)]
    return {"vertices": [(x + dx, y + dy, 2.78) for dx, dy in square], "material": "panel"}


def scene():
    return dl.load_dict(
        {
            "materials": {
                "wall": {"reflectance": 0.6},
                "wood": {"reflectance": (0.45, 0.3, 0.2)},
                "panel": {"emission": 2500 / 179},  # 2500 cd/m2
            },
            "meshes": {
                "room": {**room((0, 0, 0), (6, 4, 2.8)), "material": "wall"},
                "desk.top": {**box((1, 1.2, 0.7), (2.6, 2.0, 0.74)), "material": "wood"},
                "desk.side": {**box((1, 1.2, 0), (1.04, 2.0, 0.7)), "material": "wood"},
                "shelf": {**box((5.5, 0.5, 0), (5.9, 3.5, 1.8)), "material": "wood"},
            },
            "polygons": {
                "lamp.window": panel(1.0, 2.0),
                "lamp.middle": panel(3.0, 2.0),
                "lamp.door": panel(5.0, 2.0),
            },
            "views": {"door": {"position": (5.6, 3.8, 1.7), "direction": (-4, -2.2, -0.8), "horizontal": 75, "vertical": 55}},
        }
    )
