"""Tests of tools/check_constants on a made-up checkout: tagged and tuned ones pass; bare ones and too many are named."""

import importlib.machinery
import importlib.util
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
TOOL = pathlib.Path(__file__).resolve().parents[2] / "tools" / "check_constants"
loader = importlib.machinery.SourceFileLoader("check_constants", str(TOOL))
check_constants = importlib.util.module_from_spec(importlib.util.spec_from_loader("check_constants", loader))
loader.exec_module(check_constants)


class CheckConstants(unittest.TestCase):
    def check(self, files, most=4):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in files.items():
                path = pathlib.Path(folder) / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text, encoding="utf-8")
            bound, check_constants.MOST = check_constants.MOST, most
            try:
                return check_constants.check(folder)
            finally:
                check_constants.MOST = bound

    def assert_offence(self, files, start, *words, **settings):
        offences = self.check(files, **settings)[0]
        self.assertEqual(len(offences), 1, offences)
        self.assertTrue(offences[0].startswith(start), offences[0])
        for word in words:
            self.assertIn(word, offences[0])

    def test_accepts_tagged_and_tuned_ones(self):
        offences, tuned, tagged = self.check({
            "src/io/tuning.hpp": "/// Steps. Fewer: coarse.\nconstexpr int kSteps = 8, kMost{16};\n",
            "src/io/a.cpp": "constexpr double kTiny = 1e-9;  // of the size [rounding]\n"
                            "static constexpr std::array<int, 2> kTable{1,\n    2};  // [PSM93, table 1] [defined]\n"
                            "inline constexpr std::uint32_t kNone = 0xffffffffu, kSome = 1;  // [sentinel]\n",
        })
        self.assertEqual((offences, sum(tuned.values()), tagged), ([], 2, 4))

    def test_names_bare_ones_wherever_they_stand(self):
        for text in ("constexpr double kShare = 0.7;\n", "struct A { static constexpr int kShare{7}; };\n",
                     "void f() { constexpr float kShare = 0.5f * kPi; }\n", "inline constexpr long kShare[] = {7};\n",
                     "constexpr auto kShare = 0.5;\n", "constexpr float kShare = 0x1p-5f;  // of the light [1/sr]\n",
                     "constexpr auto f() { return 1; }\nconstexpr unsigned kShare = static_cast<unsigned>(7);\n"):
            self.assert_offence({"src/io/a.cpp": text}, f"src/io/a.cpp:{text.count(chr(10))}: kShare", "src/io/tuning.hpp")

    def test_names_every_declarator(self):
        self.assert_offence({"src/io/a.cpp": "\nconstexpr int kA = f(1, 2), kB = 2;  // two\n"}, "src/io/a.cpp:2: kA, kB: ")

    def test_takes_others_for_no_numbers(self):
        offences = self.check({
            "src/io/a.cpp": 'constexpr const char* kHint = "1";\nconstexpr std::string_view kTag = "kB = 2";\n'
                            "// constexpr int kOld = 3;\nconstexpr bool kReads = 1 > 0;\nconstexpr int other = 2;\n"
                            "constexpr std::size_t kEach = tuning::kRays;\nconstexpr auto kGet = [](int i) { return i + 1; };\n",
        })[0]
        self.assertEqual(offences, [])

    def test_reads_a_tag_only_at_the_end_and_of_its_own_line(self):
        self.assert_offence({"src/io/a.cpp": "constexpr int kA = 1;  // [limit] of faces\n"}, "src/io/a.cpp:1: kA")
        self.assert_offence({"src/io/a.cpp": "constexpr int kA = 1;\nconstexpr int kB = 1;  // [limit]\n"},
                            "src/io/a.cpp:1: kA")
        self.assert_offence({"src/io/a.cpp": "constexpr int kA = 1;  // [harmless]\n"}, "src/io/a.cpp:1: kA")

    def test_knows_no_other_tags(self):
        self.assert_offence({"src/io/a.cpp": "constexpr int kA = 1, kB = 2;  // [tuned]\n"}, "src/io/a.cpp:1: kA, kB",
                            "move it to src/io/tuning.hpp")

    def test_names_too_many(self):
        files = {"src/io/tuning.hpp": "/// A.\nconstexpr int kA = 1, kB = 2;\n", "src/base/tuning.hpp": "/// C.\nconstexpr int kC = 3;\n"}
        self.assertEqual(self.check(files, most=3)[0], [])
        self.assert_offence(files, "src/io/tuning.hpp:1: ", "3 tuned constants, 2 at most", most=2)

    def test_asks_tuned_ones_for_a_reason(self):
        self.assert_offence({"src/io/tuning.hpp": "#pragma once\n\nconstexpr int kA = 1;\n"}, "src/io/tuning.hpp:3: kA", "breaks")
        self.assert_offence({"src/io/tuning.hpp": "/// A.\nconstexpr int kA = 1;  // [limit]\n"}, "src/io/tuning.hpp:2: kA",
                            "not tuned")
        self.assertEqual(self.check({"src/io/tuning.hpp": "/// Both.\nconstexpr int kA = 1;\nconstexpr float kB = 1;\n"})[0], [])


if __name__ == "__main__":
    unittest.main()
