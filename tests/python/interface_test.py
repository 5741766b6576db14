"""The stubs and the help of the package are in step with what it does."""

import ast
import builtins
import inspect
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import sweepscope
from sweepscope import _engine, _options

STUB = Path(sweepscope.__file__).with_name("__init__.pyi")


def stubbed():
    """Classes and functions of the stub by name."""
    tree = ast.parse(STUB.read_text())
    return {node.name: node for node in tree.body if isinstance(node, (ast.FunctionDef, ast.ClassDef))}


def parameters_of_stub(function):
    """Names of the positional parameters and of the keyword-only ones, with their defaults as text."""
    args = function.args
    names = [arg.arg for arg in args.args]
    defaults = [None] * (len(names) - len(args.defaults)) + [ast.unparse(d) for d in args.defaults]
    by_keyword = {
        arg.arg: ast.unparse(default) for arg, default in zip(args.kwonlyargs, args.kw_defaults)
    }
    return list(zip(names, defaults)), by_keyword


def parameters_of(function):
    """The same of the function itself."""
    positional, by_keyword = [], {}
    for parameter in inspect.signature(function).parameters.values():
        default = None if parameter.default is inspect.Parameter.empty else repr(parameter.default)
        if parameter.kind is inspect.Parameter.KEYWORD_ONLY:
            by_keyword[parameter.name] = ast.unparse(ast.parse(default, mode="eval"))
        elif parameter.kind is inspect.Parameter.POSITIONAL_OR_KEYWORD:
            positional.append((parameter.name, default))
    return positional, by_keyword


class Stubs(unittest.TestCase):
    def test_they_name_all_that_the_package_exports_and_nothing_else(self):
        self.assertEqual(sorted([*sweepscope.__all__, "map", "open"]), sorted(stubbed()))
        self.assertTrue(STUB.with_name("py.typed").exists())

    def test_a_star_import_hides_no_builtin(self):
        self.assertEqual(set(sweepscope.__all__) & set(dir(builtins)), set())
        self.assertEqual(sweepscope.open.__module__, "sweepscope._recording")

    def test_functions_have_the_same_parameters_and_defaults(self):
        for name, node in stubbed().items():
            if isinstance(node, ast.FunctionDef):
                self.assertEqual(parameters_of_stub(node), parameters_of(getattr(sweepscope, name)), name)

    def test_so_have_the_methods_and_each_member_exists(self):
        for name, node in stubbed().items():
            described = getattr(sweepscope, name)
            if not isinstance(node, ast.ClassDef):
                continue
            for method in (item for item in node.body if isinstance(item, ast.FunctionDef)):
                here = getattr(described, method.name)
                if isinstance(here, property):
                    continue
                positional, by_keyword = parameters_of_stub(method)
                expected = parameters_of(here)
                self.assertEqual(len(positional), len(expected[0]), f"{name}.{method.name}")
                self.assertEqual((positional[1:], by_keyword), (expected[0][1:], expected[1]))

    def test_recordings_have_no_method_or_property_without_a_stub(self):
        described = {item.name for item in stubbed()["Recording"].body if isinstance(item, ast.FunctionDef)}
        public = {name for name in vars(sweepscope.Recording) if not name.startswith("_")}
        self.assertEqual(described, public)

    def test_every_option_of_the_engine_is_a_keyword_with_its_help(self):
        for function, options in (
            (sweepscope.estimate, _engine.estimate_options()),
            (sweepscope.compare, _engine.look_options()),
            (sweepscope.simulate, _engine.simulation_options()),
        ):
            for option in options:
                self.assertIn(_options.keyword_of(option["name"]), inspect.signature(function).parameters)
                self.assertIn(option["help"], function.__doc__)

    def test_everything_public_has_a_docstring(self):
        for name in sweepscope.__all__:
            self.assertTrue(getattr(sweepscope, name).__doc__, name)

    def test_mypy_accepts_the_first_example(self):
        if subprocess.run([sys.executable, "-m", "mypy", "--version"], capture_output=True).returncode != 0:
            self.skipTest("mypy is not installed")
        with tempfile.TemporaryDirectory() as folder:
            example = Path(folder) / "example.py"
            example.write_text(
                "import sweepscope\n"
                "found = sweepscope.open('room.bag', window_s=(0, 4)).estimate(range=(19, 29, 1))\n"
                "assert found.offset_ms is not None\n"
                "print(sweepscope.map('room.bag', found.offset_ms).xyz_m.min(axis=0))\n"
            )
            done = subprocess.run([sys.executable, "-m", "mypy", example], capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stdout)


if __name__ == "__main__":
    unittest.main()
