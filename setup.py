"""What pyproject.toml cannot say: CMake compiles the package. Options for it stand in the environment's CMAKE_ARGS."""

import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent
OPTIONS = {
    "CMAKE_BUILD_TYPE": "Release",
    "DELTALUX_PYTHON": "ON",
    "DELTALUX_UNITY": "ON",
    "DELTALUX_TESTS": "OFF",
    "DELTALUX_BENCH": "OFF",
    "DELTALUX_VIEWER": "OFF",
    "Python3_EXECUTABLE": sys.executable,
}


class BuildByCMake(build_ext):
    def run(self):
        build = pathlib.Path(self.build_temp).resolve()
        generator = ["-G", "Ninja"] if shutil.which("ninja") else []
        options = [f"-D{name}={value}" for name, value in OPTIONS.items()]
        options += shlex.split(os.environ.get("CMAKE_ARGS", ""))
        self.call("cmake", "-S", ROOT, "-B", build, *generator, *options)
        self.call("cmake", "--build", build, "--target", "deltalux_python", "deltalux_cli")
        self.call("cmake", "--install", build, "--component", "python", "--strip", "--prefix", pathlib.Path(self.build_lib).resolve())

    @staticmethod
    def call(*command):
        subprocess.run([str(part) for part in command], check=True)


version = re.search(r"project\(deltalux VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text())[1]
setup(version=version, ext_modules=[Extension("deltalux._core", [])], cmdclass={"build_ext": BuildByCMake})
