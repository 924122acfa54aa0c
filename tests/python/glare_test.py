"""Glare from eyes."""

import math
import unittest

import numpy as np
import support

import deltalux as dl


class Glare(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.solution = dl.solve(dl.load(support.CORNELL), error=0.2)

    def test_the_lamp_is_seen_and_the_picture_has_its_shape(self):
        found = self.solution.glare((0.278, 0.273, -0.8), (0, 0.2, 1), up=(0, 1, 0), size=64, samples=2)
        self.assertEqual([lamp["name"] for lamp in found.luminaires], ["lamp"])
        self.assertTrue(math.isfinite(found.ugr))
        self.assertEqual(found.picture.shape, (64, 64, 3))
        self.assertGreater(found.illuminance, 0)
        self.assertGreaterEqual(found.dgp, 0)

    def test_many_eyes_are_rated_as_one_is(self):
        away = self.solution.ugr([(0.278, 0.273, 0.1)] * 2, [(0, -1, 0.01), (0, 1, 0.5)])
        self.assertEqual(away[0], -math.inf)
        self.assertTrue(math.isfinite(away[1]))

    def test_mistakes(self):
        for call in (
            lambda: self.solution.glare((0, 0), (0, 0, 1)),
            lambda: self.solution.glare((0, 0, 0), (0, 0, 0)),
            lambda: self.solution.glare((0, 0, 0), (0, 0, 1), size=0),
            lambda: self.solution.ugr([(0, 0, 0)], [(0, 0, 1), (0, 1, 0)]),
        ):
            with self.assertRaises(ValueError):
                call()

    def test_the_standards_spacing_is_the_librarys(self):
        self.assertAlmostEqual(dl.en12464_spacing(7, 3), 0.2 * 5 ** np.log10(3))


if __name__ == "__main__":
    unittest.main()
