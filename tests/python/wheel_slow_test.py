"""The wheel, made by the words of docs/python.md in a virtual environment, and the examples run from it."""

import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import unittest

SOURCE = pathlib.Path(__file__).resolve().parents[2]


class Wheel(unittest.TestCase):
    def test_the_words_of_the_documentation_give_a_package_that_works(self):
        page = (SOURCE / "docs" / "python.md").read_text()
        words = re.search(r"```sh\n(.*?)```", page, re.DOTALL)[1]
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            checkout = folder / "checkout"
            made = shutil.ignore_patterns(".*", "__pycache__", "*.egg-info", "node_modules")
            at_top = shutil.ignore_patterns("build*", "out", "shared")  # further down they may be sources

            def hidden(of, names):
                return made(of, names) | (at_top(of, names) if pathlib.Path(of) == SOURCE else set())

            shutil.copytree(SOURCE, checkout, ignore=hidden, symlinks=True)
            environment = {k: v for k, v in os.environ.items() if k not in ("PYTHONPATH", "VIRTUAL_ENV")}
            environment["PIP_NO_INDEX"] = "1"  # offline

            def call(command, cwd):
                done = subprocess.run(command, cwd=cwd, env=environment, capture_output=True, text=True, check=False)
                self.assertEqual(done.returncode, 0, done.stdout[-4000:] + done.stderr[-4000:])
                return done.stdout

            call(["bash", "-euo", "pipefail", "-c", words], checkout)
            shutil.rmtree(checkout / "build", ignore_errors=True)  # what is installed needs none of it
            python = next(checkout.glob("*/bin/python3"))
            where = call([python, "-c", "import deltalux; print(deltalux.__file__)"], folder)
            self.assertTrue(pathlib.Path(where.strip()).is_relative_to(python.parents[1]), where)
            self.assertIn("lamp", call([python, "-m", "deltalux", "info", SOURCE / "scenes/cornell/cornell.rad"], folder))
            for example in ("ten_lines", "grid", "dimming_study", "drag_study"):
                call([python, SOURCE / "examples" / "python" / f"{example}.py"], checkout)


if __name__ == "__main__":
    unittest.main()
