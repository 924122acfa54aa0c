"""The examples run, say what they should, and README.md shows the shortest as it stands."""

import os
import pathlib
import re
import subprocess
import sys
import unittest

import support

EXAMPLES = pathlib.Path(__file__).resolve().parents[2] / "examples" / "python"


class Examples(unittest.TestCase):
    def run_example(self, name):
        with support.folder() as folder:
            (folder / "scenes").symlink_to(support.SOURCE / "scenes")
            done = subprocess.run(
                [sys.executable, EXAMPLES / name], cwd=folder, capture_output=True, text=True, check=False, env=os.environ
            )
            self.assertEqual(done.returncode, 0, done.stderr)
            return done.stdout, [file.name for file in folder.glob("*.png")]

    def numbers(self, pattern, text):
        found = re.findall(pattern, text)
        self.assertTrue(found, text)
        return [float(number) for number in found]

    def test_ten_lines(self):
        said, pictures = self.run_example("ten_lines.py")
        self.assertRegex(said, r"dimmed in [0-9.]+ s by 0 rays\nfloor: [1-9]\d* lux\nblock: [1-9]\d* lux\n")
        self.assertEqual(pictures, ["cornell.png"])
        code = (EXAMPLES / "ten_lines.py").read_text()
        self.assertIn(f"```python\n{code}```", (support.SOURCE / "README.md").read_text(), "README.md has another program")

    def test_grid(self):
        said, pictures = self.run_example("grid.py")
        desk, plane = self.numbers(r"Em (\d+) lux", said)
        self.assertTrue(100 < plane < desk < 2000, said)
        self.assertEqual(pictures, ["office.png"])

    def test_dimming_study(self):
        said, _ = self.run_example("dimming_study.py")
        self.assertTrue(all(0 <= weight <= 1 for weight in self.numbers(r"lamp\.\w+: ([0-9.]+)", said)))
        self.assertAlmostEqual(self.numbers(r"desk: (\d+) lux", said)[0], 300, delta=30)
        self.assertIn("\n0 rays; ", said)
        self.assertLess(self.numbers(r"by ([0-9.]+)% at most", said)[0], 5)

    def test_drag_study(self):
        said, _ = self.run_example("drag_study.py")
        self.assertEqual(len(self.numbers(r"Em (\d+) lux", said)), 5)
        self.assertEqual(len(self.numbers(r"frame: (\d+) things", said)), 4)
        self.assertIn("mesh as by a fresh solve: True; lines: True", said)

    def test_every_example_is_tested(self):
        tested = {name.removeprefix("test_") + ".py" for name in dir(self) if name.startswith("test_")}
        self.assertEqual({file.name for file in EXAMPLES.glob("*.py")} - tested, {"office.py"})


if __name__ == "__main__":
    support.main()
