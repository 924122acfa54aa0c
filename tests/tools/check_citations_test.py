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

PAPERS = """| Tag | Source |
|---|---|
| GD01 | Granier, Drettakis |
| Radiance | the manual |
| KHR_* | extensions |
| LM-63 | luminaires |
| glTF 2.0 | scenes |
"""


class CheckCitations(unittest.TestCase):
    def check(self, source):
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            (root / "docs").mkdir()
            (root / "src").mkdir()
            (root / "docs" / "papers.md").write_text(PAPERS, encoding="utf-8")
            (root / "docs" / "particles.md").write_text("Particles\n", encoding="utf-8")
            (root / "src" / "kernel.cpp").write_text(source, encoding="utf-8")
            return check_citations.check(root)

    def assert_missing(self, bracket, source):
        self.assertEqual(
            self.check(f"// as in [{bracket}]\n")[0], [f"src/kernel.cpp:1: [{source}]: add it to docs/papers.md"])

    def test_accepts_listed_sources(self):
        self.assertEqual(self.check("f();  // [GD01 (7)], as [GD01] has it\n"), ([], 2))

    def test_names_the_unlisted_source(self):
        offences, count = self.check("f();\ng();  // [GD01 (7)] by way of [XY99 2.1]\n")
        self.assertEqual(offences, ["src/kernel.cpp:2: [XY99]: add it to docs/papers.md"])
        self.assertEqual(count, 2)

    def test_reads_several_in_one_bracket(self):
        self.assert_missing("GD01 5, XY99: a title", "XY99")
        self.assert_missing("GD01 5; Radiance, color.c; XY99 2", "XY99")

    def test_reads_comments_only(self):
        self.assertEqual(self.check('double b = values[Index07];\nf("[XY99]");\n'), ([], 0))

    def test_accepts_specifications_by_their_rows(self):
        source = "// [Radiance, gensky(1)] [KHR_lights_punctual; LM-63, 2002]\n/// [glTF 2.0, 3.7.2]\n"
        self.assertEqual(self.check(source), ([], 4))

    def test_names_unlisted_specifications(self):
        self.assert_missing("CIE 171 case 5.2", "CIE 171 case 5.2")
        self.assert_missing("EXT_lights_ies", "EXT_lights_ies")
        self.assert_missing("LM-79", "LM-79")
        self.assert_missing("ISO 15469", "ISO 15469")

    def test_names_authors_and_years_that_are_no_tags(self):
        self.assert_missing("Haines & Wallace 1991", "Haines & Wallace 1991")
        self.assert_missing("Newell", "Newell")

    def test_looks_for_documents_in_docs(self):
        self.assertEqual(self.check("// [particles.md]\n"), ([], 1))
        self.assert_missing("conventions.md", "conventions.md")
        self.assert_missing("algorithm 4, quantum", "algorithm 4, quantum")

    def test_reads_brackets_over_several_lines_of_a_comment(self):
        offences, count = self.check("// as it is done [GD01 5;\n// XY99 2]\nint a;  // [GD01\nint b;  // 2]\n")
        self.assertEqual(offences, ["src/kernel.cpp:1: [XY99]: add it to docs/papers.md"])
        self.assertEqual(count, 2)

    def test_takes_intervals_indices_units_and_usage_for_no_citations(self):
        for bracket in ("0, 1", "i", "x,y,z", "W/m2", "W/(sr m2)", "kcd/m2", "lm/W", "scene units", "W, gray", "1/sr",
                        "LEAST MOST", "FLUX.csv", "v0,v1", "16 numbers, row-major", "MiB"):
            self.assertEqual(self.check(f"// [{bracket}]\n"), ([], 0), bracket)


if __name__ == "__main__":
    unittest.main()
