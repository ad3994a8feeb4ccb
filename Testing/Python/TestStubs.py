# SPDX-License-Identifier: BSD-3-Clause
"""The type stubs of the package say what the package has."""
import ast
import inspect
import pathlib
import typing
import unittest

import vtkcartan
from vtkcartan import arrays, landmarks, vtkCartan

FOLDER = pathlib.Path(vtkcartan.__file__).parent


def run_stub(name):
    """The names that a stub defines; annotations stay texts until they are asked for."""
    source = (FOLDER / (name + ".pyi")).read_text(encoding="utf-8")
    names = {"__name__": "vtkcartan." + name, "__package__": "vtkcartan"}
    code = compile("from __future__ import annotations\n" + source, name, "exec")
    exec(code, names)
    return names


class Stubs(unittest.TestCase):
    def test_all_parse(self):
        stubs = sorted(FOLDER.glob("*.pyi"))
        self.assertGreaterEqual({stub.stem for stub in stubs},
                                {"__init__", "arrays", "compare", "landmarks", "vtkCartan"})
        for stub in stubs:
            ast.parse(stub.read_text(encoding="utf-8"), stub.name)
        self.assertTrue((FOLDER / "py.typed").exists())

    def test_classes_are_those_of_the_module(self):
        stub = run_stub("vtkCartan")
        for name, wrapped in vars(vtkCartan).items():
            if not inspect.isclass(wrapped):
                continue
            described = stub[name]
            self.assertEqual([base.__name__ for base in described.__bases__],
                             [base.__name__ for base in wrapped.__bases__], name)
            public = {entry for entry in vars(wrapped) if not entry.startswith("_")}
            self.assertEqual({entry for entry in {*vars(described), *described.__annotations__}
                              if not entry.startswith("_")}, public, name)

    def test_types_of_other_modules_are_known(self):
        stub = run_stub("vtkCartan")
        classes = [entry for entry in stub.values() if inspect.isclass(entry)
                   and entry.__module__ == "vtkcartan.vtkCartan"]
        self.assertGreater(len(classes), 25)
        for described in classes:
            # Enumerations are named without the class that they are in.
            known = {**stub, **vars(described)}
            for name, method in vars(described).items():
                method = getattr(method, "__func__", method)
                if inspect.isfunction(method):
                    typing.get_type_hints(method, known)

    def test_methods(self):
        motion = run_stub("vtkCartan")["vtkHandleMotion"]
        self.assertEqual(typing.get_type_hints(motion.SetAngle),
                         {"_arg": float, "return": type(None)})
        self.assertEqual(typing.get_type_hints(motion.GetProblem), {"return": str})

    def test_functions_take_what_their_stubs_say(self):
        for name, module, functions in (
                ("arrays", arrays, ("deform", "morph", "measure", "Deformer")),
                ("landmarks", landmarks, ("read_landmarks",))):
            stub = run_stub(name)
            for function in functions:
                self.assertEqual(*(
                    [(p.name, p.kind, p.default) for p in inspect.signature(f).parameters.values()]
                    for f in (getattr(module, function), stub[function])), function)


unittest.main()
