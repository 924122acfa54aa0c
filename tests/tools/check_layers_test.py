"""Tests of tools/check_layers on small made-up checkouts: it must accept the good one and name each kind of offence."""

import contextlib
import importlib.machinery
import importlib.util
import io
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
TOOL = pathlib.Path(__file__).resolve().parents[2] / "tools" / "check_layers"
loader = importlib.machinery.SourceFileLoader("check_layers", str(TOOL))
check_layers = importlib.util.module_from_spec(importlib.util.spec_from_loader("check_layers", loader))
loader.exec_module(check_layers)

GOOD = {
    "include/deltalux/ids.hpp": "#include <cstdint>\n",
    "include/deltalux/scene.hpp": "#include <deltalux/ids.hpp>\n",
    "include/deltalux/io.hpp": "#include <deltalux/scene.hpp>\n",
    "src/base/check.hpp": "#include <cassert>\n",
    "src/tracing/ray_tracer.hpp": '#include "base/check.hpp"\n#include <deltalux/scene.hpp>\n#include <embree3/rtcore.h>\n',
    "src/tracing/embree.cpp": '#include "ray_tracer.hpp"\n#include "tracing/ray_tracer.hpp"\n',
    "src/hierarchy/element.hpp": "#include <deltalux/ids.hpp>\n",
    "src/render/reference/path.cpp": '#include "tracing/ray_tracer.hpp"\n#include <fmt/format.h>\n',
    "apps/cli/main.cpp": '#include "options.hpp"\n#include <deltalux/io.hpp>\n#include <iostream>\n',
    "apps/cli/options.hpp": "#include <string>\n",
    "python/bindings/bind.hpp": "#include <pybind11/pybind11.h>\n",
    "python/bindings/module.cpp": '#include "bind.hpp"\n#include <deltalux/io.hpp>\n',
}


class CheckLayers(unittest.TestCase):
    def offences(self, changes={}):
        """Offences of the good checkout with the files of `changes` (path -> text) added or replaced."""
        with tempfile.TemporaryDirectory() as folder:
            for path, text in {**GOOD, **changes}.items():
                file = pathlib.Path(folder, path)
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text(text, encoding="utf-8")
            return check_layers.check(folder)[0]

    def assert_offence(self, path, text, *words):
        """The last line of `text`, and nothing else, must be an offence whose message holds the words."""
        offences = self.offences({path: text})
        self.assertEqual(len(offences), 1, offences)
        self.assertTrue(offences[0].startswith(f"{path}:{len(text.splitlines())}: "), offences[0])
        for word in words:
            self.assertIn(word, offences[0])

    def test_accepts_the_good_checkout(self):
        self.assertEqual(self.offences(), [])

    def test_layer_below(self):
        self.assert_offence("src/base/bad.cpp", '#include "base/check.hpp"\n#include <deltalux/scene.hpp>\n', "below")
        self.assert_offence("src/hierarchy/bad.cpp", "#include <deltalux/io.hpp>\n", "hierarchy includes io")

    def test_siblings(self):
        self.assert_offence("src/hierarchy/bad.cpp", '#include "tracing/ray_tracer.hpp"\n', "sibling")
        self.assert_offence("src/tracing/bad.hpp", '# include  "../hierarchy/element.hpp"\n', "sibling")
        self.assert_offence("src/render/bad.hpp", "#include <deltalux/io.hpp>\n", "sibling")

    def test_an_angle_bracket_is_no_way_round(self):
        self.assert_offence("src/hierarchy/bad.cpp", "#include <tracing/ray_tracer.hpp>\n", "sibling")

    def test_apps_see_public_headers_only(self):
        self.assert_offence("apps/cli/bad.cpp", '#include "../../src/base/check.hpp"\n', "internal")
        self.assert_offence("apps/cli/bad.cpp", '#include "base/check.hpp"\n', "internal")
        self.assert_offence("python/bindings/bad.cpp", '#include "base/check.hpp"\n', "internal")

    def test_public_headers_include_public_headers_only(self):
        self.assert_offence("include/deltalux/view.hpp", '#include "base/check.hpp"\n', "internal")
        self.assert_offence("include/deltalux/view.hpp", "#include <deltalux/io.hpp>\n", "below")

    def test_unlisted_files(self):
        self.assert_offence("include/deltalux/novelty.hpp", "\n", "PUBLIC in tools/check_layers")
        self.assert_offence("src/novelty/bad.hpp", "\n", "ROWS in tools/check_layers")
        self.assert_offence("src/bad.cpp", "\n", "move it into src/<layer>/")

    def test_missing_file(self):
        self.assert_offence("src/base/bad.cpp", '#include "base/gone.hpp"\n', "is no file here")
        self.assert_offence("src/base/bad.cpp", "#include <deltalux/gone.hpp>\n", "is no file here")

    def test_third_party_homes(self):
        self.assert_offence("src/io/bad.cpp", "#include <embree3/rtcore.h>\n", "src/tracing/")
        self.assert_offence("src/base/bad.cpp", "#include <iostream>\n", "does not print")
        self.assert_offence("src/paper/bad.cpp", "#include <Eigen/Dense>\n", "tests/")

    def test_exceptions_excuse_one_pair_and_must_be_used(self):
        bad = {"src/hierarchy/bad.cpp": '#include "tracing/ray_tracer.hpp"\n'}
        check_layers.EXCEPTIONS.append(("src/hierarchy/bad.cpp", "src/tracing/ray_tracer.hpp", "made up"))
        try:
            self.assertEqual(self.offences(bad), [])
            self.assertEqual(len(self.offences({"src/hierarchy/worse.cpp": bad["src/hierarchy/bad.cpp"], **bad})), 1)
            self.assertIn("is not needed", self.offences()[0])
        finally:
            check_layers.EXCEPTIONS.pop()

    def test_a_folder_without_sources_is_not_clean(self):
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stderr(io.StringIO()):
            self.assertEqual(check_layers.main([folder]), 2)


if __name__ == "__main__":
    unittest.main()
