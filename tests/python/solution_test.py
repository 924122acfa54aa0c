"""What is read from solutions: the same numbers as the command line's, in any thread, and interruptible."""

import functools
import os
import signal
import threading
import time
import unittest

import numpy as np
import support

import deltalux as dl

POINTS = np.array([(0.3, 0, 0.3), (0.45, 0, 0.1), (0.2, 0.165, 0.2), (0.28, 0.27, 0.28)])
NORMALS = np.array([(0, 1, 0), (0, 3, 0), (0, 1, 0), (0.6, 0, 0.8)])


@functools.cache
def cornell():
    return dl.solve(dl.load(support.CORNELL), error=0.1, by_light=True)


def write_points(file):
    rows = [",".join(map(repr, (*p, *n))) for p, n in zip(POINTS.tolist(), NORMALS.tolist())]
    file.write_text("x,y,z,nx,ny,nz\n" + "\n".join(rows) + "\n")
    return file


class AsTheCommandLine(unittest.TestCase):
    def test_lux_and_irradiance_are_those_of_probe(self):
        E, errors = cornell().irradiance(POINTS, NORMALS, errors=True)
        lux = cornell().lux(POINTS, NORMALS)
        self.assertEqual((E.shape, errors.shape, lux.shape), ((4, 3), (4, 3), (4,)))
        with support.folder() as folder:
            cornell().save(folder / "c.dlx")
            points = write_points(folder / "p.csv")
            done = support.command("probe", folder / "c.dlx", "--points", points, "-o", folder / "o.csv")
            self.assertEqual(done.returncode, 0, done.stderr)
            found = support.table(folder / "o.csv")
            scene = support.command(
                "probe", support.CORNELL, "--error", "0.1", "--by-light", "--points", points, "-o", folder / "a.csv"
            )
            self.assertEqual(scene.returncode, 0, scene.stderr)
            columns = support.table(folder / "a.csv")
        np.testing.assert_allclose(E, np.transpose([found[c] for c in ("E_r", "E_g", "E_b")]), rtol=1e-6)  # 7 digits
        np.testing.assert_allclose(errors, np.transpose([found[c] for c in ("se_r", "se_g", "se_b")]), rtol=1e-3)
        np.testing.assert_allclose(lux, found["lux"], rtol=1e-6)
        A, names = cornell().by_light(POINTS, NORMALS)
        self.assertEqual((A.shape, names), ((4, 1), ["lamp"]))
        np.testing.assert_allclose(A[:, 0], columns["lux_lamp"], rtol=1e-6)
        self.assertGreater(lux.min(), 1)

    def test_a_picture_is_that_of_render(self):
        picture = cornell().render(support.CORNELL_VIEW, size=(40, 30), samples=2)
        with support.folder() as folder:
            cornell().save(folder / "c.dlx")
            done = support.command(
                *("render", folder / "c.dlx", "--view", support.CORNELL_VIEW),
                *("--size", "40x30", "--samples", "2", "-o", folder / "c.exr"),
            )
            self.assertEqual(done.returncode, 0, done.stderr)
            written = dl.load_image(folder / "c.exr")
            dl.save_image(folder / "d.exr", picture)
            np.testing.assert_array_equal(dl.load_image(folder / "d.exr"), picture)
            dl.save_image(folder / "d.png", picture, ev=1)
            self.assertTrue((folder / "d.png").read_bytes().startswith(b"\x89PNG"))
        self.assertEqual((picture.dtype, picture.shape), (np.float32, (30, 30, 3)))
        np.testing.assert_array_equal(picture, written)
        self.assertGreater(picture.mean(), 0.01)

    def test_views_have_names_files_and_values(self):
        file = dl.load_view(support.CORNELL_VIEW)
        by_file = cornell().render(support.CORNELL_VIEW, size=(8, 8), samples=1)
        np.testing.assert_array_equal(cornell().render(file, size=(8, 8), samples=1), by_file)
        same = dl.View(file.position, file.direction, file.up, file.horizontal, file.vertical)
        np.testing.assert_array_equal(cornell().render(same, size=(8, 8), samples=1), by_file)
        with self.assertRaisesRegex(dl.InputError, "there is no view or view file 'front'"):
            cornell().render("front")
        with self.assertRaisesRegex(ValueError, "along each other"):
            dl.View((0, 0, 0), (0, 0, 1))
        with self.assertRaisesRegex(ValueError, "size"):
            cornell().render(file, size=(0, 8))


class Solutions(unittest.TestCase):
    def test_a_file_gives_the_same_back(self):
        with support.folder() as folder:
            cornell().save(folder / "c.dlx")
            back = dl.open(folder / "c.dlx")
            np.testing.assert_array_equal(back.lux(POINTS, NORMALS), cornell().lux(POINTS, NORMALS))
            self.assertEqual((back.error, back.groups), (0.1, {"lamp": ["lamp"]}))
            (folder / "bad.dlx").write_text("no solution")
            with self.assertRaises(dl.InputError) as caught:
                dl.open(folder / "bad.dlx")
            self.assertEqual(caught.exception.file, str(folder / "bad.dlx"))
        with self.assertRaises(dl.OutputError):
            cornell().save("/nonexistent/c.dlx")
        with self.assertRaisesRegex(ValueError, r"\.dlx"):
            cornell().save("c.exr")

    def test_threads_do_not_decide(self):
        scene = dl.load_dict(support.room())
        one, two = (dl.solve(scene, 0.2, threads=n).lux([(1, 1, 0.7)], (0, 0, 1)) for n in (1, 2))
        np.testing.assert_array_equal(one, two)

    def test_seeds_decide_what_is_random(self):
        data = support.room()
        data["materials"]["wood"] = {"reflectance": 0.3, "specular": 0.4, "roughness": 0.1}
        light = [dl.solve(dl.load_dict(data), 0.2, seed=seed).mesh().irradiance.sum() for seed in (1, 1, 2)]
        self.assertEqual(light[0], light[1])
        self.assertNotEqual(light[0], light[2])
        one, two = (cornell().lux(POINTS, NORMALS, seed=seed)[3] for seed in (1, 2))  # in the air
        self.assertNotEqual(one, two)

    def test_settings_are_heard(self):
        scene = dl.load_dict(support.room())
        coarse, fine = (dl.solve(scene, error).report["counts"]["lines"] for error in (0.3, 0.05))
        self.assertGreater(fine, coarse)
        paper = dl.solve(scene, 0.3, method="paper").report["counts"]
        self.assertGreater(paper["links"], 0)
        self.assertTrue(dl.solve(scene, 0.3).converged)
        hurried = dl.solve(dl.load(support.CORNELL), 0.02, seconds=0.3)
        self.assertFalse(hurried.converged)

    def test_settings_that_are_wrong_are_refused(self):
        scene = dl.load_dict(support.room())
        for options, words in (
            ({"error": 0}, "error"),
            ({"error": 1.5}, "error"),
            ({"method": "mesh"}, "'lines' or 'paper'"),
            ({"method": "paper", "by_light": True}, "by_light"),
            ({"seconds": 0}, "seconds"),
            ({"threads": 0}, "threads"),
            ({"particles": 0}, "particles"),
            ({"groups": {"all": "lamps*"}}, "nearest: lamp"),
        ):
            with self.subTest(options), self.assertRaisesRegex(ValueError, words):
                dl.solve(scene, **options)

    def test_groups_are_dimmed_together(self):
        solution = support.solved(groups={"both": ["lamp", "sp*"]})
        self.assertEqual(solution.groups, {"both": ["spot", "lamp"]})
        A, names = solution.by_light([(1, 1, 0.7)], (0, 0, 1))
        self.assertEqual(names, ["both"])
        np.testing.assert_allclose(A[:, 0], solution.lux([(1, 1, 0.7)], (0, 0, 1)), rtol=0.05)
        with self.assertRaisesRegex(ValueError, "by_light=True"):
            support.solved().by_light([(1, 1, 0.7)], (0, 0, 1))

    def test_columns_add_up(self):
        solution = support.solved(by_light=True)
        points = [(1, 1, 0.7), (2.4, 2.4, 0)]
        A, names = solution.by_light(points, (0, 0, 1))
        weights = np.array([{"spot": 0.25, "lamp": 0.5}[name] for name in names])
        with solution.edit() as e:
            for name, weight in zip(names, weights):
                e.light(name).scale = weight
        self.assertEqual(e.report["rays"], 0)
        np.testing.assert_allclose(A @ weights, solution.lux(points, (0, 0, 1)), rtol=0.05)

    def test_points_that_are_none_are_refused(self):
        for points, normals, words in (
            ([(0, 0)], (0, 1, 0), r"points: .*\(N, 3\).*\(1, 2\)"),
            ([(0, 0, np.inf)], (0, 1, 0), r"points\[0\] is not finite"),
            (POINTS, NORMALS[:2], "4 and 2 rows"),
            (POINTS, NORMALS * 0, r"normals\[0\] has no direction"),
        ):
            with self.subTest(words), self.assertRaisesRegex(ValueError, words):
                cornell().lux(points, normals)
        self.assertEqual(cornell().lux(np.empty((0, 3)), (0, 1, 0)).shape, (0,))


class LongCalls(unittest.TestCase):
    def test_progress_is_told(self):
        told = []
        dl.solve(dl.load(support.CORNELL), 0.05, progress=lambda phase, fraction: told.append((phase, fraction)))
        self.assertTrue(told)
        self.assertTrue(all(isinstance(phase, str) and 0 <= fraction <= 1 for phase, fraction in told))

    def test_what_progress_raises_ends_the_call(self):
        def stop(phase, fraction):
            raise StopIteration("enough")

        begin = time.monotonic()
        with self.assertRaisesRegex(StopIteration, "enough"):
            dl.solve(dl.load(support.CORNELL), 0.02, progress=stop)
        self.assertLess(time.monotonic() - begin, 30)

    def interrupted(self, work):
        """Calls work() and sends SIGINT meanwhile."""
        timer = threading.Timer(0.3, lambda: os.kill(os.getpid(), signal.SIGINT))
        timer.start()
        begin = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            work()
        timer.join()
        self.assertLess(time.monotonic() - begin, 30)

    def test_control_c_ends_a_solve(self):
        scene = dl.load(support.CORNELL)
        self.interrupted(lambda: dl.solve(scene, 0.02))
        self.assertGreater(dl.solve(scene, 0.3).lux(POINTS, NORMALS).min(), 1)  # and nothing is left behind

    def test_an_update_that_was_interrupted_can_be_finished(self):
        solution = dl.solve(dl.load(support.CORNELL), 0.02)
        number = solution.mesh().version
        # While it runs, however long it takes to get there.
        edit = solution.edit(progress=lambda phase, fraction: os.kill(os.getpid(), signal.SIGINT))
        with self.assertRaises(KeyboardInterrupt), edit as e:
            e.move("short_block", translate=(0.05, 0, 0))
        self.assertTrue(solution.unfinished)
        with self.assertRaisesRegex(RuntimeError, "finish"):
            solution.lux(POINTS, NORMALS)
        solution.finish()
        self.assertFalse(solution.unfinished)
        check = solution.check()
        self.assertTrue(check.mesh_identical and check.lines_identical)
        self.assertGreater(solution.mesh().version, number)

    def test_other_threads_run_meanwhile(self):
        solution, counted, ended = support.solved(), [0], threading.Event()

        def count():
            while not ended.is_set():
                counted[0] += 1
                time.sleep(0.001)

        thread = threading.Thread(target=count)
        thread.start()
        lux = []
        readers = [threading.Thread(target=lambda: lux.append(solution.lux([(1, 1, 0.7)], (0, 0, 1)))) for _ in range(4)]
        for reader in readers:
            reader.start()
        dl.solve(dl.load(support.CORNELL), 0.05)
        for reader in readers:
            reader.join()
        ended.set()
        thread.join()
        self.assertGreater(counted[0], 20)
        self.assertEqual(len({float(value[0]) for value in lux}), 1)


class Design(unittest.TestCase):
    def test_the_best_weights_are_found(self):
        A = np.array([(100.0, 10), (20, 200), (50, 50)])
        found = dl.design(A, A @ (0.3, 0.8))
        np.testing.assert_allclose(found.weights, (0.3, 0.8), atol=1e-9)
        np.testing.assert_allclose(found.reached, A @ found.weights)
        np.testing.assert_allclose(dl.design(A, (1e4, 1e4, 1e4)).weights, 1)

    def test_what_is_no_matrix_is_refused(self):
        for A, targets in (([1, 2], [1, 2]), ([[1.0]], [1, 2]), ([[-1.0]], [1]), ([[1.0]], [np.nan]), ([[]], [1])):
            with self.subTest(A=A), self.assertRaises(ValueError):
                dl.design(A, targets)


if __name__ == "__main__":
    support.main()
