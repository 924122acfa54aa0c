"""The package itself: its stubs, its errors, its command line, its version."""

import ast
import pathlib
import pickle
import re
import signal
import subprocess
import sys
import unittest

import support

import deltalux as dl
from deltalux import _core

FOLDER = pathlib.Path(dl.__file__).parent


class Stubs(unittest.TestCase):
    def test_stubs_name_what_the_compiled_part_has(self):
        tree = ast.parse((FOLDER / "_core.pyi").read_text())
        said, there = {}, {}
        for node in tree.body:
            if isinstance(node, ast.ClassDef):
                said[node.name] = {part.name for part in node.body if isinstance(part, ast.FunctionDef)} - {"__init__"}
            elif isinstance(node, ast.FunctionDef):
                said[node.name] = set()
        for name, thing in vars(_core).items():
            if isinstance(thing, type):
                there[name] = {n for n in vars(thing) if not n.startswith("_") or n == "__len__"}
            elif callable(thing):
                there[name] = set()
        self.assertEqual(said, there)

    def test_arguments_are_those_of_the_compiled_part(self):
        def signature(thing):
            return re.findall(r"(?:\(|, )(\w+): ", (thing.__doc__ or "").split("\n")[0])

        def arguments(node):
            return [a.arg for a in node.args.args]

        for node in ast.parse((FOLDER / "_core.pyi").read_text()).body:
            if isinstance(node, ast.FunctionDef):
                self.assertEqual(arguments(node), signature(getattr(_core, node.name)), node.name)
            elif isinstance(node, ast.ClassDef):
                for part in node.body:
                    if isinstance(part, ast.FunctionDef) and not part.decorator_list and part.name != "__len__":
                        there = signature(getattr(getattr(_core, node.name), part.name))
                        self.assertEqual(arguments(part), there, f"{node.name}.{part.name}")

    def test_it_is_typed_and_everything_said_is_there(self):
        self.assertTrue((FOLDER / "py.typed").exists())
        for name in dl.__all__:
            self.assertTrue(hasattr(dl, name), name)

    def test_everything_people_call_says_what_it_does(self):
        for name in dl.__all__:
            thing = getattr(dl, name)
            if not callable(thing):
                continue
            self.assertTrue(thing.__doc__, name)
            for method, value in vars(thing).items() if isinstance(thing, type) else ():
                if not method.startswith("_") and (callable(value) or isinstance(value, property)) and not issubclass(thing, tuple):
                    if thing is not dl.View:
                        self.assertTrue(getattr(thing, method).__doc__, f"{name}.{method}")

    def test_the_version_is_that_of_the_project(self):
        said = re.search(r"project\(deltalux VERSION ([0-9.]+)", (support.SOURCE / "CMakeLists.txt").read_text())[1]
        self.assertEqual(dl.__version__, said)
        self.assertEqual(support.command("--version").stdout, f"deltalux {said}\n")


class Errors(unittest.TestCase):
    def test_an_error_has_its_parts(self):
        error = pickle.loads(pickle.dumps(dl.InputError("is wrong", "mend it", "a.rad", 3)))
        self.assertEqual((error.file, error.line, error.message, error.hint), ("a.rad", 3, "is wrong", "mend it"))
        self.assertEqual(str(error), "a.rad:3: is wrong (mend it)")
        self.assertEqual(str(dl.InputError("is wrong")), "is wrong")
        self.assertIsInstance(error, ValueError)
        self.assertIsInstance(dl.OutputError("full"), OSError)


class CommandLine(unittest.TestCase):
    def test_exit_codes_are_those_of_the_program(self):
        with support.folder() as folder:
            for code, arguments in (
                (0, ("info", support.CORNELL)),
                (2, ("inform", support.CORNELL)),
                (3, ("info", folder / "none.rad")),
                (4, ("solve", support.CORNELL, "-o", folder / "none" / "c.dlx")),
            ):
                done = support.command(*arguments)
                self.assertEqual(done.returncode, code, done.stderr)

    def test_control_c_is_130(self):
        with support.folder() as folder:
            scene, words = support.SOURCE / "scenes/lodge/morning.rad", [sys.executable, "-m", "deltalux", "solve"]
            words += [scene, "-o", folder / "l.dlx", "--progress", "json"]
            with subprocess.Popen(words, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as running:
                running.stdout.readline()  # it has begun
                running.send_signal(signal.SIGINT)
                running.communicate(timeout=100)
            self.assertEqual(running.returncode, 130)
            self.assertEqual(list(folder.iterdir()), [])


if __name__ == "__main__":
    support.main()
