"""The checks of the source tree find what they are there to find."""

import tempfile
import textwrap
import unittest
from pathlib import Path

import check_includes
import check_sizes
from source_tree import without_comments


def faults_of(check, files):
    """Runs a check over a tree of the given files."""
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        for name, text in files.items():
            (root / name).parent.mkdir(parents=True, exist_ok=True)
            (root / name).write_text(textwrap.dedent(text), encoding="utf-8")
        return check(root)[0]


class Includes(unittest.TestCase):
    def check(self, files):
        return faults_of(check_includes.check, files)

    def test_downward_include_is_right(self):
        self.assertEqual(self.check({"core/learn/a.h": '#include "core/field/b.h"\n',
                                     "core/field/b.h": "#include <Eigen/Core>\n"}), [])

    def test_upward_include_is_named(self):
        faults = self.check({"core/base/a.h": '#include "core/shape/b.h"\n', "core/shape/b.h": ""})
        self.assertEqual(len(faults), 1)
        self.assertIn("core/base/a.h:1", faults[0])
        self.assertIn("lies above core/base", faults[0])

    def test_codec_must_not_know_the_wire(self):
        faults = self.check({"api/codec/a.cpp": '\n#include "api/job.h"\n', "api/job.h": ""})
        self.assertIn("api/codec/a.cpp:2", faults[0])

    def test_product_must_not_include_tests(self):
        faults = self.check({"server/a.cpp": '#include "tests/support/b.h"\n',
                             "tests/support/b.h": ""})
        self.assertIn("no part of the product", faults[0])

    def test_each_library_has_its_owner(self):
        for path, header in [("core/denoise.cpp", "nanoflann.hpp"), ("api/codec/ply.cpp", "draco/x.h"),
                             ("api/job.cpp", "httplib.h"), ("server/app.cpp", "sqlite3.h"),
                             ("core/a.cpp", "nlohmann/json.hpp"), ("api/a.cpp", "thread"),
                             ("core/learn/a.cpp", "iostream")]:
            faults = self.check({path: f"#include <{header}>\n"})
            self.assertEqual(len(faults), 1, f"{path} includes {header}")
            self.assertIn(header, faults[0])

    def test_owners_may(self):
        self.assertEqual(self.check({"core/shape/spatial_index.cpp": "#include <nanoflann.hpp>\n",
                                     "api/codec/draco_write.cpp": "#include <draco/a.h>\n"}), [])

    def test_comments_do_not_count(self):
        self.assertEqual(self.check({"core/a.cpp": '// #include <iostream>\n/* std::cout */\n'}), [])

    def test_missing_file_is_named(self):
        self.assertIn("not a file", self.check({"core/a.cpp": '#include "b.h"\n'})[0])

    def test_core_is_silent(self):
        for code in ["std::cout << 1;", "printf(\"x\");", "getenv(\"X\");", "std::jthread t;"]:
            faults = self.check({"core/a.cpp": f"void f() {{ {code} }}\n"})
            self.assertEqual(len(faults), 1, code)

    def test_transport_must_not_know_the_service(self):
        faults = self.check({"server/http/a.cpp": '#include "server/jobs/b.h"\n',
                             "server/jobs/b.h": ""})
        self.assertIn("lies above server/http", faults[0])

    def test_circle_of_folders_is_named(self):
        faults = self.check({"server/a/x.h": '#include "server/b/y.h"\n',
                             "server/b/y.h": '#include "server/a/z.h"\n', "server/a/z.h": ""})
        self.assertIn("server/a -> server/b -> server/a", faults[0])

    def test_a_layer_and_its_parts_are_one(self):
        self.assertEqual(self.check({"server/a/x.h": '#include "server/log.h"\n', "server/log.h": "",
                                     "server/app.cpp": '#include "server/a/x.h"\n'}), [])


def long_function(lines):
    return "int f(int x) {\n" + "    ++x;\n" * (lines - 2) + "}\n"


class Sizes(unittest.TestCase):
    def check(self, files):
        return faults_of(check_sizes.check, files)

    def names(self, code):
        return [(name, last - first + 1)
                for name, first, last in check_sizes.cpp_functions(textwrap.dedent(code))]

    def test_sixty_lines_are_right_and_sixty_one_are_not(self):
        self.assertEqual(self.check({"core/a.cpp": long_function(60)}), [])
        self.assertIn("int f has 61 lines", self.check({"core/a.cpp": long_function(61)})[0])

    def test_file_of_401_lines(self):
        self.assertEqual(self.check({"core/a.h": "\n" * 400}), [])
        self.assertIn("401 lines", self.check({"core/a.h": "\n" * 401})[0])

    def test_long_python_function(self):
        self.assertIn("61 lines", self.check({"a.py": "def f():\n" + "    pass\n" * 60})[0])

    def test_signature_counts_and_scopes_do_not(self):
        code = """\
            namespace lpf {
            class A : public B {
            public:
                A(int x) : x_(x), y_{1, 2} {}
                int f(int a,
                      int b) const override {
                    return a;
                }
            private:
                int x_ = 0;
            };
            }
            """
        self.assertEqual(self.names(code), [("A", 1), ("int f", 4)])

    def test_lambdas_belong_to_their_function(self):
        code = """\
            void f() {
                const auto g = [](int x) {
                    return x;
                };
            }
            """
        self.assertEqual(self.names(code), [("void f", 5)])

    def test_values_in_braces_are_no_function(self):
        self.assertEqual(self.names("const int a[] = {1, 2};\nconst Limits l{f(1), {2}};\n"), [])

    def test_braces_in_text_do_not_count(self):
        code = 'void f() {\n    g("}", \'}\', R"(})");  // }\n    h();\n}\n'
        self.assertEqual(self.names(code), [("void f", 4)])

    def test_path_of_a_machine(self):
        home = "/".join(["", "home", "somebody", "x"])
        self.assertIn("one machine", self.check({"README.md": f"see {home}\n"})[0])
        self.assertEqual(self.check({"README.md": "see ~/home/x and a/work/b\n"}), [])


class Comments(unittest.TestCase):
    def test_lines_stay_in_place(self):
        text = "a /* b\nc */ d // e\nf\n"
        self.assertEqual(without_comments(text).split(), ["a", "d", "f"])
        self.assertEqual(without_comments(text).count("\n"), 3)


if __name__ == "__main__":
    unittest.main()
