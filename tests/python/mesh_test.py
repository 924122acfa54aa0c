"""Triangles with light on them: views of snapshots, read-only, numbered."""

import gc
import unittest

import numpy as np
import support

import deltalux as dl


class Meshes(unittest.TestCase):
    def test_arrays_are_read_only_views_that_keep_the_snapshot(self):
        surface = support.solved().mesh().surfaces[0]
        names = ("positions", "normals", "uv", "direct", "indirect", "particle", "triangles", "outlines")
        arrays = {name: getattr(surface, name) for name in names}
        twice = surface.positions
        self.assertEqual(twice.__array_interface__["data"], arrays["positions"].__array_interface__["data"])
        copies = {name: array.copy() for name, array in arrays.items()}
        del surface, twice
        gc.collect()
        for name, array in arrays.items():
            self.assertFalse(array.flags.writeable, name)
            self.assertFalse(array.flags.owndata, name)
            np.testing.assert_array_equal(array, copies[name])
            with self.assertRaises(ValueError):
                array[0] = 0
            with self.assertRaises(ValueError):
                array.setflags(write=True)

    def test_the_whole_is_its_parts(self):
        mesh = support.solved().mesh()
        self.assertEqual((mesh.vertices.shape, mesh.vertices.dtype), (mesh.normals.shape, np.float64))
        self.assertEqual(mesh.vertices.shape, mesh.irradiance.shape)
        self.assertLess(mesh.triangles.max(), len(mesh.vertices))
        a, b, c = (mesh.vertices[mesh.triangles[:, i]] for i in range(3))
        normals = np.cross(b - a, c - a)
        self.assertTrue(np.all(np.sum(normals * mesh.normals[mesh.triangles[:, 0]], axis=1) > 0))
        sizes = np.linalg.norm(normals, axis=1) / 2
        inside = 2 * 9 + 4 * 6  # of the room, and both sides of the table, and of the lamp
        self.assertGreaterEqual(sizes.sum(), inside)
        with self.assertRaises(ValueError):
            mesh.irradiance[0] = 1

    def test_irradiance_is_what_meters_read(self):
        solution = support.solved(error=0.05)
        mesh = solution.mesh()
        floor = [s for s in mesh.surfaces if s.object == "room" and s.positions[:, 2].max() == 0 and s.front][0]
        a, b, c = (floor.positions[floor.triangles[:, i]] for i in range(3))
        size = np.linalg.norm(np.cross(b - a, c - a), axis=1)
        E = (floor.direct + floor.indirect + floor.particle)[floor.triangles].mean(axis=1)
        mean = (size[:, None] * E).sum(axis=0) / size.sum()
        grid = dl.SensorGrid.from_rectangle((0, 0, 0), (3, 0, 0), (0, 3, 0), spacing=0.2)
        np.testing.assert_allclose(mean, solution.irradiance(grid.points, grid.normals).mean(axis=0), rtol=0.05)
        np.testing.assert_allclose(floor.albedo, 0.6, rtol=1e-6)

    def test_versions_say_what_changed(self):
        solution = support.solved(by_light=True)
        first = solution.mesh()
        self.assertEqual(solution.mesh().version, first.version)
        old = first.irradiance.copy()
        with solution.edit() as e:
            e.light("spot").scale = 0.5
        second = solution.mesh()
        shapes, lights = second.changed_since(first.version)
        self.assertGreater(second.version, first.version)
        self.assertEqual(shapes, [])
        self.assertTrue(lights)
        with solution.edit() as e:
            e.move("table", translate=(0, 0.2, 0))
        shapes, _ = solution.mesh().changed_since(second.version)
        self.assertIn("table", {s.object for s in shapes})
        np.testing.assert_array_equal(first.irradiance, old)  # a snapshot stays
        parts = [s.direct + s.indirect + s.particle for s in first.surfaces]
        np.testing.assert_array_equal(np.concatenate(parts), old)

    def test_caustic_textures_are_there(self):
        solution = dl.solve(dl.load(support.SOURCE / "scenes/cornell-caustic/cornell-caustic.rad"), 0.2)
        caustics = solution.mesh().caustics
        self.assertTrue(caustics)
        for c in caustics:
            self.assertEqual(c.texels.shape[2], 4)
            self.assertEqual(len(c.positions), len(c.texcoords))
            self.assertLess(c.triangles.max(), len(c.positions))
            self.assertTrue(np.all((c.texels[..., 3] == 0) | (c.texels[..., 3] == 1)))
            self.assertFalse(c.texels.flags.writeable)
        self.assertGreater(max(c.texels[..., :3].max() for c in caustics), 0)
        self.assertEqual(dl.solve(solution.scene, 0.2, caustic_textures=False).mesh().caustics, [])


if __name__ == "__main__":
    support.main()
