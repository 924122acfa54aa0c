"""Tests of tools/check_types on a made-up checkout: one definition passes, a second and a stray type are named."""

import importlib.machinery
import importlib.util
import pathlib
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
TOOL = pathlib.Path(__file__).resolve().parents[2] / "tools" / "check_types"
loader = importlib.machinery.SourceFileLoader("check_types", str(TOOL))
check_types = importlib.util.module_from_spec(importlib.util.spec_from_loader("check_types", loader))
loader.exec_module(check_types)


def within(namespace, text):
    return f"namespace {namespace} {{\n{text}\n}}\n"


class CheckTypes(unittest.TestCase):
    def check(self, files):
        with tempfile.TemporaryDirectory() as folder:
            for name, text in files.items():
                path = pathlib.Path(folder) / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_text(text, encoding="utf-8")
            return check_types.check(folder)

    def test_accepts_one_name_in_two_layers(self):
        walls = "struct Walls {\n  int u;\n};"
        offences, count = self.check({
            "src/hierarchy/patch.hpp": within("deltalux::hierarchy", walls),
            "src/caustics/walls.hpp": within("deltalux::caustics", walls),
        })
        self.assertEqual((offences, count), ([], 2))

    def test_names_the_second_definition(self):
        offences, _ = self.check({
            "src/io/a.cpp": within("deltalux::io", "class Reader { int a; };"),
            "src/io/b.cpp": within("deltalux::io", "// another\nclass Reader final : public Base<int> { };"),
        })
        self.assertEqual(
            offences, ["src/io/b.cpp:3: deltalux::io::Reader is defined at src/io/a.cpp:2, too: rename one of them"])

    def test_sees_through_nested_namespaces_and_enumerations(self):
        offences, _ = self.check({
            "src/io/a.hpp": within("deltalux", within("io", "enum class Kind : int { A, B };")),
            "src/io/b.hpp": within("deltalux::io", "union Kind { int a; };"),
        })
        self.assertEqual(len(offences), 1)
        self.assertIn("deltalux::io::Kind is defined at src/io/a.hpp:3", offences[0])

    def test_leaves_types_of_one_file_alone(self):
        private = within("deltalux::io", within("", "struct Reader { int a; };"))
        self.assertEqual(self.check({"src/io/a.cpp": private, "src/io/b.cpp": private}), ([], 2))

    def test_takes_declarations_for_no_definitions(self):
        uses = "struct Reader;\nfriend class Reader;\ntemplate <class Reader> void f(struct Reader&) { struct Here {}; }"
        offences, count = self.check({
            "src/io/a.cpp": within("deltalux::io", "struct Reader { struct Line { int a; }; Line line; };"),
            "src/io/b.cpp": within("deltalux::io", uses),
        })
        self.assertEqual((offences, count), ([], 2))

    def test_tells_nested_types_apart_by_their_owner(self):
        offences, _ = self.check({
            "src/io/a.cpp": within("deltalux::io", "struct A { struct Line {}; };\nstruct B { struct Line {}; };"),
            "src/io/b.cpp": within("deltalux::io", "struct B::Line { };"),
        })
        self.assertEqual(len(offences), 1)
        self.assertIn("src/io/b.cpp:2: deltalux::io::B::Line", offences[0])

    def test_names_a_type_outside_its_layer(self):
        offences, _ = self.check({"src/particles/a.hpp": within("deltalux", "struct Stray {\n};")})
        self.assertEqual(
            offences, ["src/particles/a.hpp:2: deltalux::Stray stands outside deltalux::particles: move it there"])

    def test_lets_a_layer_define_what_is_public(self):
        offences, _ = self.check({
            "include/deltalux/engine.hpp": within("deltalux", "class Engine { struct State; };"),
            "src/engine/state.hpp": within("deltalux", "struct Engine::State { struct Part {}; };"),
            "src/base/box.hpp": within("deltalux", "struct Box {};"),
        })
        self.assertEqual(offences, [])


if __name__ == "__main__":
    unittest.main()
