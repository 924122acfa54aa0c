"""Edit blocks: all or nothing, one update, what a fresh solve gives."""

import unittest

import numpy as np
import support

import deltalux as dl

TABLE, FLOOR, UP = (1, 1, 0.7), (2.5, 2.5, 0), (0, 0, 1)


def lux(solution):
    return solution.lux([TABLE, FLOOR], UP)


class Blocks(unittest.TestCase):
    def test_all_edits_make_one_update_that_is_a_fresh_solve(self):
        solution, version = support.solved(), 1
        before = lux(solution)
        with solution.edit() as e:
            e.move("table", translate=(0.4, 0.2, 0))
            e.move("table", rotate=((0, 0, 1), 90, (1.4, 1.2, 0)))
            e.light("spot").scale = 2
            e.material("white").reflectance = 0.5
            self.assertEqual(solution.version, version)
            np.testing.assert_array_equal(lux(solution), before)
        self.assertEqual(solution.version, version + 1)
        self.assertGreater(e.report["rays"], 0)
        self.assertGreater(e.report["time_s"]["total"], 0)
        check = solution.check()
        self.assertTrue(check.mesh_identical and check.lines_identical and check.particles_identical)
        self.assertLess(check.p95, 0.02)
        self.assertNotEqual(lux(solution)[1], before[1])

    def test_a_translation_a_rotation_and_a_matrix_are_what_they_say(self):
        quarter = [(0, -1, 0, 3), (1, 0, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1)]  # about z, then by (3, 0, 0)
        places = []
        for how in ({"rotate": ((0, 0, 2), 90), "translate": (3, 0, 0)}, {"matrix": quarter}):
            solution = support.solved(error=0.3)
            with solution.edit() as e:
                e.move("table", **how)
            table = [s for s in solution.mesh().surfaces if s.object == "table" and s.front]
            places.append(np.concatenate([s.positions for s in table]))
        np.testing.assert_allclose(places[0].min(axis=0), (1.6, 0.6, 0.7), atol=1e-6)
        np.testing.assert_allclose(places[0].max(axis=0), (2.4, 1.4, 0.7), atol=1e-6)
        np.testing.assert_allclose(places[1].mean(axis=0), places[0].mean(axis=0), atol=0.05)

    def test_a_sky_is_an_edit(self):
        solution = support.solved()
        before = lux(solution)
        with solution.edit() as e:
            e.sky("cie:12", "2026-06-21T12:00+02:00", (47.4, 8.5))
        self.assertTrue(solution.check().lines_identical)
        self.assertTrue((lux(solution) >= before * 0.9).all())
        for wrong in ({"sky": "cie:16"}, {"when": "noon"}, {"where": (91, 0)}):
            given = {"sky": "cie:1", "when": "2026-06-21T12:00", "where": (0, 0), **wrong}
            with self.assertRaises(ValueError), solution.edit() as e:
                e.sky(**given)

    def test_an_exception_applies_nothing(self):
        solution = support.solved()
        before = lux(solution)
        with self.assertRaises(ZeroDivisionError), solution.edit() as e:
            e.move("table", translate=(0.4, 0, 0))
            raise ZeroDivisionError
        self.assertEqual((solution.version, e.report), (1, None))
        with self.assertRaisesRegex(dl.InputError, "there is no object 'tabel'.*nearest: table"), solution.edit() as e:
            e.light("lamp").on = False
            e.move("tabel", translate=(1, 0, 0))
        np.testing.assert_array_equal(lux(solution), before)
        with solution.edit() as e:
            pass
        self.assertEqual((solution.version, e.report), (1, None))
        with self.assertRaisesRegex(RuntimeError, "block"):
            e.move("table", translate=(1, 0, 0))

    def test_what_cannot_be_is_refused_where_it_is_said(self):
        solution = support.solved()
        with solution.edit() as e:
            for edit, words in (
                (lambda: e.light("lmap"), "nearest: lamp"),
                (lambda: e.material("wod"), "nearest: wood"),
                (lambda: e.remove("chair"), "there is no object 'chair'"),
                (lambda: e.move("table"), "move takes"),
                (lambda: e.move("table", translate=(1, 0, 0), matrix=np.eye(4)), "move takes"),
                (lambda: e.move("table", matrix=np.zeros((4, 4))), "affine"),
                (lambda: e.move("table", matrix=np.eye(3)), r"\(4, 4\)"),
                (lambda: e.move("table", rotate=((0, 0, 0), 10)), "axis"),
                (lambda: e.move("table", translate=(1, 0)), "three numbers"),
                (lambda: e.light("lamp").aim((0, 0, -1)), "no aim"),
                (lambda: e.add("table", dl.load_dict(support.room())), "already"),
                (lambda: e.frame(0), "more than 0 ms"),
            ):
                with self.subTest(words), self.assertRaisesRegex(ValueError, words):
                    edit()
            with self.assertRaisesRegex(ValueError, "0 to 1"):
                e.material("wood").reflectance = 2
            with self.assertRaisesRegex(ValueError, "no gloss"):
                e.material("wood").roughness = 0.1
            with self.assertRaises(AttributeError):
                e.light("lamp").scael = 0.5
        self.assertEqual(solution.version, 1)

    def test_blocks_do_not_overlap(self):
        solution = support.solved()
        with self.assertRaisesRegex(RuntimeError, "overlap"), solution.edit() as outer:
            outer.light("lamp").scale = 0.5
            with solution.edit() as inner:
                inner.light("lamp").scale = 0.25
        with solution.edit() as e:
            self.assertEqual(e.light("lamp").scale, 0.25)


class Lights(unittest.TestCase):
    def test_dimming_is_linear_and_traces_no_ray(self):
        solution = support.solved()
        whole = lux(solution)
        with solution.edit() as e:
            for name in ("lamp", "spot"):
                e.light(name).scale = 0.5
        self.assertEqual(e.report["rays"], 0)
        np.testing.assert_allclose(lux(solution), 0.5 * whole, rtol=0.02)
        with solution.edit() as e:
            e.light("lamp").scale *= 2
            e.light("spot").dim(2)
            self.assertEqual((e.light("lamp").scale, e.light("spot").scale), (1, 1))
        np.testing.assert_allclose(lux(solution), whole, rtol=1e-5)

    def test_scale_keeps_colour_and_off_keeps_both(self):
        solution = support.solved()
        with solution.edit() as e:
            lamp = e.light("lamp")
            lamp.rgb = (1, 0.5, 0.25)
            lamp.scale = 0.5
            self.assertEqual(lamp.rgb, (0.5, 0.25, 0.125))
            lamp.on = False
            self.assertEqual((lamp.on, lamp.scale), (False, 0.5))
            e.light("spot").on = False
        np.testing.assert_array_equal(lux(solution), 0)
        with solution.edit() as e:
            e.light("lamp").on = True
        E = solution.irradiance([TABLE], UP)[0]
        self.assertGreater(E[0], E[1])
        self.assertGreater(E[1], E[2])

    def test_parts_of_a_lamp_are_dimmed_with_it(self):
        data = support.room()
        data["polygons"]["lamp.small"] = {"vertices": support.square(1.9, 0.1, 0.5, 0.5)[::-1], "material": "glow"}
        solution = support.solved(dl.load_dict(data))
        with solution.edit() as e:
            e.light("lamp.small").rgb = (0.2, 0.4, 0.2)
            e.light("lamp").scale = 0.5
            self.assertEqual(e.light("lamp").rgb, (0.5, 0.5, 0.5))
            np.testing.assert_allclose(e.light("lamp.small").rgb, (0.25, 0.5, 0.25), rtol=1e-6)

    def test_spots_are_aimed_and_moved(self):
        solution = support.solved(dl.load_dict(support.room()), diffuse_only=True)
        with solution.edit() as e:
            e.light("lamp").on = False
        dark, lit = lux(solution)
        self.assertLess(dark, lit)
        with solution.edit() as e:
            e.light("spot").aim((-1.5, -1.5, -1.1))
        self.assertGreater(lux(solution)[0], dark)
        with solution.edit() as e:
            e.light("spot").aim((0, 0, -1))
            e.light("spot").move((-1.5, -1.5, 0))
        table, floor = lux(solution)
        self.assertGreater(table, floor)


class Objects(unittest.TestCase):
    def test_things_are_removed_and_added(self):
        solution = support.solved()
        before = lux(solution)
        with solution.edit() as e:
            e.remove("table")
        self.assertLess(solution.lux([(1, 1, 0)], UP)[0], 1e6)
        self.assertNotIn("table", {s.object for s in solution.mesh().surfaces})
        table = dl.load_dict(
            {
                "materials": {"wood": {"reflectance": (0.5, 0.3, 0.2)}},
                "polygons": {"top": {"vertices": support.square(0, 0.8), "material": "wood"}},
            }
        )
        place = np.eye(4)
        place[:3, 3] = TABLE
        with solution.edit() as e:
            e.add("bench", table, place)
            e.move("bench", translate=(0, 0, 0))
        self.assertIn("bench.top", solution.scene.objects)
        np.testing.assert_allclose(lux(solution), before, rtol=0.15)

    def test_a_file_is_added(self):
        solution = support.solved()
        with support.folder() as folder:
            (folder / "ball.rad").write_text("void plastic grey 0 0 5 .5 .5 .5 0 0\ngrey sphere ball 0 0 4 0 0 0 .2\n")
            with solution.edit() as e:
                e.add("toy", folder / "ball.rad")
                e.move("toy", translate=(1, 1, 1))
        self.assertIn("toy.ball", {s.object for s in solution.mesh().surfaces})
        self.assertTrue(solution.check().mesh_identical)

    def test_a_solution_from_a_file_is_edited_as_well(self):
        solution = support.solved(by_light=True)
        with support.folder() as folder:
            solution.save(folder / "s.dlx")
            back = dl.open(folder / "s.dlx")
        for s in (solution, back):
            with s.edit() as e:
                e.move("table", translate=(0.3, 0, 0))
        # The same lines; what is summed over them may be in another order.
        np.testing.assert_allclose(lux(back), lux(solution), rtol=1e-6)
        self.assertTrue(solution.check().lines_identical)


class Frames(unittest.TestCase):
    def test_a_drag_ends_where_one_update_does(self):
        dragged, moved = support.solved(), support.solved()
        with dragged.edit() as e:
            for _ in range(3):
                e.move("table", translate=(0.125, 0, 0))
                report = e.frame(20)
                self.assertIn("stale_w", report)
                self.assertTrue(np.all(np.isfinite(lux(dragged))))
        with moved.edit() as e:
            e.move("table", translate=(0.375, 0, 0))
        np.testing.assert_allclose(lux(dragged), lux(moved), rtol=1e-5)
        self.assertTrue(dragged.check().lines_identical)

    def test_an_exception_takes_frames_back(self):
        solution = support.solved()
        before = lux(solution)
        with self.assertRaises(ZeroDivisionError), solution.edit() as e:
            e.move("table", translate=(0.5, 0, 0))
            e.frame(20)
            raise ZeroDivisionError
        np.testing.assert_allclose(lux(solution), before, rtol=1e-5)
        self.assertTrue(solution.check().lines_identical)


if __name__ == "__main__":
    support.main()
