"""Tests of tools/check_citations on a made-up checkout: listed sources pass, an unlisted one is named."""

import importlib.machinery
import importlib.util
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
TOOL = pathlib.Path(__file__).resolve().parents[2] / "tools" / "check_citations"
loader = importlib.machinery.SourceFileLoader("check_citations", str(TOOL))
check_citations = importlib.util.module_from_spec(importlib.util.spec_from_loader("check_citations", loader))
loader.exec_module(check_citations)

PAPERS = "| Tag | Source |\n|---|---|\n| GD01 | Granier, Drettakis |\n"


class CheckCitations(unittest.TestCase):
    def check(self, source):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "docs").mkdir()
            (root / "src").mkdir()
            (root / "docs" / "papers.md").write_text(PAPERS, encoding="utf-8")
            (root / "src" / "kernel.cpp").write_text(source, encoding="utf-8")
            return check_citations.check(root)

    def test_accepts_listed_sources(self):
        self.assertEqual(self.check("f();  // [GD01 (7)], as [GD01] has it\n"), ([], 2))

    def test_names_the_unlisted_source(self):
        offences, count = self.check("f();\ng();  // [GD01 (7)] by way of [XY99 2.1]\n")
        self.assertEqual(offences, ["src/kernel.cpp:2: [XY99]: add it to docs/papers.md"])
        self.assertEqual(count, 2)

    def test_reads_several_in_one_bracket(self):
        self.assertEqual(self.check("// [GD01 5, XY99: a title]\n")[0], ["src/kernel.cpp:1: [XY99]: add it to docs/papers.md"])

    def test_reads_comments_only(self):
        self.assertEqual(self.check("double b = values[Index07];\n"), ([], 0))


if __name__ == "__main__":
    unittest.main()
