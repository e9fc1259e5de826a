"""The wheel: CMake builds the module, or where WEARWELL_BUILD names a build that has it, only installs it."""

import os
import pathlib
import re
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

here = os.path.dirname(os.path.abspath(__file__))
project = os.path.dirname(here)
with open(os.path.join(project, "CMakeLists.txt"), encoding="utf-8") as file:
    version = re.search(r"project\(wearwell VERSION ([0-9.]+)", file.read())[1]


class CMakeBuild(build_ext):
    def build_extension(self, ext):
        target = pathlib.Path(self.get_ext_fullpath(ext.name)).resolve().parents[2]
        build = os.environ.get("WEARWELL_BUILD")
        if not build:
            build = os.path.join(project, "build", "wheel-build")
            subprocess.check_call([
                "cmake", "-S", project, "-B", build, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DWEARWELL_BUILD_TESTS=OFF",
                "-DWEARWELL_BUILD_BENCH=OFF", "-DWEARWELL_BUILD_PYTHON=ON", f"-DPython_EXECUTABLE={sys.executable}"])
            subprocess.check_call(["cmake", "--build", build, "--target", "wearwell_python"])
        subprocess.check_call(["cmake", "--install", build, "--component", "python", "--prefix", str(target)])


setup(version=version, ext_modules=[Extension("wearwell._impl._core", sources=[])], cmdclass={"build_ext": CMakeBuild})
