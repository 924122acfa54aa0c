"""Tests of tools/check_docs on a made-up checkout: sound pages pass, each offence is named where it stands."""

import importlib.machinery
import importlib.util
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
TOOL = pathlib.Path(__file__).resolve().parents[2] / "tools" / "check_docs"
loader = importlib.machinery.SourceFileLoader("check_docs", str(TOOL))
check_docs = importlib.util.module_from_spec(importlib.util.spec_from_loader("check_docs", loader))
loader.exec_module(check_docs)


class CheckDocs(unittest.TestCase):
    def check(self, readme, **files):
        files = {"README.md": readme, "docs/page.md": "# Lines & links\n\n## `Twice`\n\n## Twice\n", **files}
        with tempfile.TemporaryDirectory() as folder:
            root = pathlib.Path(folder)
            for name, text in files.items():
                (root / name).parent.mkdir(parents=True, exist_ok=True)
                (root / name).write_text(text, encoding="utf-8")
            return check_docs.check(root)

    def test_accepts_links_to_what_exists(self):
        readme = "# Top\n[a](docs/page.md), [b](docs), [c](#top), ![d](docs/page.md 'title')\n\n[e]: docs/page.md\n"
        self.assertEqual(self.check(readme), ([], 5))

    def test_names_a_missing_file(self):
        offences = ["README.md:2: docs/none.md: no such file"]
        self.assertEqual(self.check("# Top\n[a](docs/none.md)\n"), (offences, 1))
        self.assertEqual(self.check("# Top\n[a]: docs/none.md\n"), (offences, 1))

    def test_reads_links_whose_text_is_wrapped(self):
        self.assertEqual(self.check("see [a\nb](none.md)\n")[0], ["README.md:2: none.md: no such file"])

    def test_links_are_relative_to_their_page(self):
        pages = {"docs/other.md": "[a](page.md) [b](../README.md) [c](docs/page.md)\n"}
        self.assertEqual(self.check("", **pages)[0], ["docs/other.md:1: docs/page.md: no such file"])

    def test_names_a_missing_heading(self):
        found = "[a](docs/page.md#lines--links) [b](docs/page.md#twice) [c](docs/page.md#twice-1)\n"
        self.assertEqual(self.check(found), ([], 3))
        self.assertEqual(self.check("[a](docs/page.md#twice-2)\n")[0], ["README.md:1: docs/page.md#twice-2: no such heading"])

    def test_refuses_links_out_of_the_checkout(self):
        self.assertEqual(self.check("[a](../..)\n")[0], ["README.md:1: ../..: leads out of the checkout"])

    def test_reads_neither_code_nor_other_sites(self):
        readme = "`[a](none.md)` [b](https://example.org/none.md)\n\n    [c](none.md)\n\n```\n# [d](none.md)\n```\n"
        self.assertEqual(self.check(readme), ([], 0))

    def test_headings_in_code_are_none(self):
        self.assertEqual(self.check("```\n# top\n```\n[a](#top)\n")[0], ["README.md:4: #top: no such heading"])

    def test_names_a_heading_without_its_blank(self):
        self.assertEqual(self.check("#Top\n")[0], ["README.md:1: a heading needs a blank after its #"])

    def test_skips_builds(self):
        self.assertEqual(self.check("", **{"build/h/page.md": "[a](none.md)\n"}), ([], 0))

    def test_contributing_stays_short(self):
        self.assertEqual(self.check("", **{"CONTRIBUTING.md": "word " * 699}), ([], 0))
        offences, _ = self.check("", **{"CONTRIBUTING.md": "word " * 700})
        self.assertEqual(len(offences), 1)
        self.assertIn("700 words", offences[0])


if __name__ == "__main__":
    unittest.main()
