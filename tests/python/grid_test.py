"""Measuring grids."""

import math
import unittest

import numpy as np
import support

import deltalux as dl

SensorGrid = dl.SensorGrid


class Files(unittest.TestCase):
    def read(self, text):
        with support.folder() as folder:
            file = folder / "p.pts"
            file.write_text(text)
            return SensorGrid.from_pts(file)

    def test_points_of_radiance_and_honeybee_are_read(self):
        grid = self.read("# sensors\n0 1.5 .75 0 0 1\n\n  1,2,3,0,-2,0\r\n-1e-1\t0\t0\t3\t4\t0\n")
        np.testing.assert_array_equal(grid.points, [(0, 1.5, 0.75), (1, 2, 3), (-0.1, 0, 0)])
        np.testing.assert_allclose(grid.normals, [(0, 0, 1), (0, -1, 0), (0.6, 0.8, 0)])

    def test_a_mistake_has_its_line(self):
        for text, line, words in (
            ("0 0 0 0 0 1\n0 0 0 0 0\n", 2, "5 fields"),
            ("#\n0 0 zero 0 0 1\n", 2, "no number"),
            ("0 0 0 0 0 0\n", 1, "no direction"),
            ("0 0 nan 0 0 1\n", 1, "not finite"),
            ("# nothing\n", 0, "no points"),
        ):
            with self.subTest(text), self.assertRaisesRegex(dl.InputError, words) as caught:
                self.read(text)
            self.assertEqual(caught.exception.line, line)
            self.assertTrue(caught.exception.file.endswith("p.pts"))
        with self.assertRaisesRegex(dl.InputError, "none.pts: cannot be read: No such file"):
            SensorGrid.from_pts("none.pts")


class Rectangles(unittest.TestCase):
    def test_points_are_centred_in_their_cells(self):
        grid = SensorGrid.from_rectangle((1, 2, 3), (2, 0, 0), (0, 1, 0), spacing=0.5)
        self.assertEqual(len(grid), 8)
        np.testing.assert_allclose(grid.points[0], (1.25, 2.25, 3))
        np.testing.assert_allclose(grid.points[3], (2.75, 2.25, 3))
        np.testing.assert_allclose(grid.points[4], (1.25, 2.75, 3))
        np.testing.assert_array_equal(grid.normals, np.tile((0, 0, 1), (8, 1)))

    def test_spacing_is_at_most_what_is_asked_for_and_the_border_is_left_out(self):
        grid = SensorGrid.from_rectangle((0, 0, 0), (6, 0, 0), (0, 0, 4), spacing=1.1, border=0.5)
        np.testing.assert_allclose(grid.points.min(axis=0), (1, 0, 1))
        np.testing.assert_allclose(grid.points.max(axis=0), (5, 0, 3))
        self.assertEqual(len(grid), 15)
        np.testing.assert_array_equal(grid.normals[0], (0, -1, 0))

    def test_the_standard_has_its_spacing(self):
        self.assertAlmostEqual(dl.en12464_spacing(1, 1), 0.2)
        self.assertAlmostEqual(dl.en12464_spacing(10, 8), 1.0)
        self.assertAlmostEqual(dl.en12464_spacing(100, 60), 5.0)
        self.assertAlmostEqual(dl.en12464_spacing(10, 1), 0.2)  # the shorter side: it is twice as long or more
        self.assertEqual(dl.en12464_spacing(1e4, 9e3), 10)
        metres = SensorGrid.from_rectangle((0, 0, 0), (10, 0, 0), (0, 8, 0))
        feet = SensorGrid.from_rectangle((0, 0, 0), (10 / 0.3048, 0, 0), (0, 8 / 0.3048, 0), metres_per_unit=0.3048)
        self.assertEqual((len(metres), len(feet)), (80, 80))

    def test_what_is_no_rectangle_is_refused(self):
        for options in (
            {"u": (0, 0, 0)},
            {"u": (1, 1, 0)},
            {"u": (1, 0)},
            {"border": 0.5},
            {"border": -1},
            {"spacing": 0},
            {"spacing": 1e-6},
            {"metres_per_unit": 0},
        ):
            with self.subTest(options), self.assertRaises(ValueError):
                SensorGrid.from_rectangle(**{"corner": (0, 0, 0), "u": (1, 0, 0), "v": (0, 1, 0), **options})


class Surfaces(unittest.TestCase):
    def test_points_lie_on_the_top_of_a_thing(self):
        solution = support.solved(error=0.3)
        grid = SensorGrid.from_surface(solution, "table", spacing=0.2)
        self.assertEqual(len(grid), 16)
        np.testing.assert_allclose(np.unique(grid.points[:, 0].round(6)), (0.7, 0.9, 1.1, 1.3))
        np.testing.assert_allclose(grid.points[:, 2], 0.7, atol=1e-6)
        np.testing.assert_allclose(grid.normals, np.tile((0, 0, 1), (16, 1)), atol=1e-6)
        self.assertGreater(grid.stats(solution.lux(grid.points, grid.normals)).Emin, 0)

    def test_a_wall_is_faced(self):
        data = support.room()
        data["polygons"]["room"], data["polygons"]["wall"] = data["polygons"]["room"][1:], data["polygons"]["room"][0]
        solution = support.solved(dl.load_dict(data), error=0.3)
        wall = SensorGrid.from_surface(solution, "wall", spacing=0.5, facing=(2, 0, 0))
        np.testing.assert_allclose(wall.points[:, 0], 0, atol=1e-6)
        np.testing.assert_allclose(wall.normals, np.tile((1, 0, 0), (24, 1)), atol=1e-6)
        self.assertGreater(wall.stats(solution.lux(wall.points, wall.normals)).Emin, 0)

    def test_the_nearest_side_counts_and_holes_are_left(self):
        data = support.room()
        data["polygons"]["table"] = [
            {"vertices": support.square(0.7, 0.4, 0.8, 1), "material": "wood"},
            {"vertices": support.square(0.3, 0.4, 0.8, 1), "material": "wood"},
            {"vertices": support.square(0.7, 0.4, 1.6, 1), "material": "wood"},
        ]
        grid = SensorGrid.from_surface(support.solved(dl.load_dict(data), error=0.3), "table", spacing=0.2)
        np.testing.assert_allclose(grid.points[:, 2], 0.7, atol=1e-6)
        self.assertEqual(len(grid), 8)

    def test_it_follows_its_thing(self):
        solution = support.solved(error=0.3)
        with solution.edit() as e:
            e.move("table", translate=(0.5, 0, 0.1))
        grid = SensorGrid.from_surface(solution, "table", spacing=0.4)
        np.testing.assert_allclose(grid.points.mean(axis=0), (1.5, 1, 0.8), atol=1e-6)

    def test_what_is_not_there_is_named(self):
        solution = support.solved(error=0.3)
        with self.assertRaisesRegex(dl.InputError, "there is no object 'tabel'.*table"):
            SensorGrid.from_surface(solution, "tabel", spacing=0.1)
        with self.assertRaisesRegex(dl.InputError, "no side of 'table' looks along"):
            SensorGrid.from_surface(solution, "table", spacing=0.1, facing=(1, 0, 0))


class Statistics(unittest.TestCase):
    def test_uniformity_is_that_of_the_standard(self):
        grid = SensorGrid(np.zeros((4, 3)), (0, 0, 2))
        stats = grid.stats([100, 200, 300, 400])
        self.assertEqual(stats, (250, 100, 400, 0.4, 0.25))
        self.assertEqual((stats.Em, stats.U0, stats.Ud), (250, 0.4, 0.25))
        self.assertTrue(math.isnan(grid.stats(np.zeros(4)).U0))
        with self.assertRaises(ValueError):
            grid.stats([1, 2])

    def test_a_grid_of_nothing_sound_is_refused(self):
        for points, normals in (
            (np.zeros(3), (0, 0, 1)),
            (np.zeros((2, 3)), np.ones((3, 3))),
            (np.zeros((2, 3)), (0, 0, 0)),
            ([(0, 0, math.nan)], (0, 0, 1)),
        ):
            with self.assertRaises(ValueError):
                SensorGrid(points, normals)


if __name__ == "__main__":
    support.main()
