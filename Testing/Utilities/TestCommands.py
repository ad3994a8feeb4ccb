"""The commands in the pages can be given: programs, options, presets and tests exist.

They are in indented blocks and in code within a sentence. Those of ```sh in Python.md are run by
Testing/Python/TestPythonPage.py.
"""
import json
import pathlib
import re
import shlex
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted((ROOT / "Documentation").glob("*.md"))]

# Where options are read, if not in the script itself.
OPTIONS = {"Utilities/robustness.sh": ["Utilities/robustness.py"],
           "build/bin/CartanFuzz": ["Testing/Fuzz/Options.cxx"]}
PROGRAMS = {"clang-format-14", "clang-tidy-14", "cmake", "cpack", "ctest", "paraview", "pvpython",
            "python3"}
FOLDERS = ("Utilities/", "Testing/", "Documentation/", "Filters/", "Plugin/", "Python/", "CMake/",
           "Data/", "Packaging/", ".ci/")


def text_of(path):
    return (ROOT / path).read_text(encoding="utf-8")


def is_command(line):
    """Whether a line of code is one that a shell takes, and not a name or a piece of C++."""
    first = line.split(" ")[0]
    return bool(re.match(r"[A-Z_]+=\S", line) or first in PROGRAMS or first == "sudo"
                or first.startswith(("build/bin/", "build/benchmarks/bin/"))
                or (first.startswith(FOLDERS) and not set("*<") & set(first)))


def commands():
    """Pairs of a page and a command, as words."""
    for page in PAGES:
        prose = re.sub(r"^```.*?^```$", "", page.read_text(encoding="utf-8"),
                       flags=re.MULTILINE | re.DOTALL)
        code = [line.strip() for line in prose.splitlines() if line.startswith("    ")]
        code += re.findall(r"`([^`\n]+)`", prose)
        for line in filter(is_command, code):
            for command in re.split(r" && ", line):
                yield page.name, shlex.split(command, comments=True)


def test_names():
    """What ctest calls the tests, as far as the sources say."""
    names = {f"{path.parent.name.lower()}.{path.stem}"
             for path in (ROOT / "Testing").glob("[PU]*/*.py")}
    names |= {f"utility.{path.stem}" for path in (ROOT / "Testing/Utilities").glob("Test*.py")}
    names |= {f"gui.{path.stem}" for path in (ROOT / "Testing/Plugin").glob("*.xml")}
    for folder in (ROOT / "Testing").iterdir():
        lists = folder / "CMakeLists.txt"
        if lists.exists():
            text = lists.read_text(encoding="utf-8")
            names |= set(re.findall(r"add_test\(NAME ([\w.]+)", text))
            for suites in re.findall(r"foreach \(suite IN ITEMS ([\w ]+)\)", text):
                names |= {f"filter.{suite}On2Ranks" for suite in suites.split()}
    for source in (ROOT / "Testing/Cxx").glob("Test*.cxx"):
        label = "kernel" if source.name.startswith("TestKernel") else "filter"
        names |= {f"{label}.{suite}.{name}" for suite, name in re.findall(
            r"^TEST(?:_[FP])?\(\s*(\w+),\s*(\w+)\)", source.read_text(encoding="utf-8"), re.MULTILINE)}
    return names


PRESETS = json.loads(text_of("CMakePresets.json"))
KIND = {"--build": "buildPresets", "--workflow": "workflowPresets"}
TESTS = test_names()


class Commands(unittest.TestCase):
    def test_there_are_some(self):
        self.assertGreater(len(list(commands())), 60)
        self.assertGreater(len(TESTS), 700)

    def test_they_can_be_given(self):
        for page, words in commands():
            with self.subTest(page=page, command=shlex.join(words)):
                while words and re.match(r"[A-Z_]+=", words[0]):
                    words = words[1:]
                if words and words[0] != "sudo":
                    self.check(words)

    def check(self, words):
        for word in words:
            if word.startswith(FOLDERS) and not set("*<") & set(word):
                self.assertTrue((ROOT / word).exists(), f"there is no {word}")
        program = words[0]
        if program.startswith(("build/bin/", "build/benchmarks/bin/")):
            self.check_program(pathlib.Path(program).name)
        elif program.startswith("Utilities/") and (program.endswith(".sh") or len(words) > 1):
            self.assertTrue((ROOT / program).stat().st_mode & 0o100, "it cannot be run")
        elif not program.startswith(FOLDERS):
            self.assertIn(program, PROGRAMS)
        if program in ("cmake", "ctest"):
            self.check_preset(words)
        if program == "ctest" and "-R" in words:
            pattern = words[words.index("-R") + 1]
            self.assertTrue(any(re.search(pattern, name) for name in TESTS), "no test matches")
        if program.endswith(".sh") or program in OPTIONS:
            self.check_options(program, words[1:])

    def check_program(self, name):
        lists = "".join(path.read_text(encoding="utf-8")
                        for path in (ROOT / "Testing").glob("*/CMakeLists.txt"))
        benchmark = ROOT / "Testing/Benchmarks" / (name.replace("Cartan", "", 1) + ".cxx")
        self.assertTrue(benchmark.exists() or re.search(rf"\b{name}\b", lists), "nothing builds it")

    def check_preset(self, words):
        if "--preset" not in words:
            return
        kind = "testPresets" if words[0] == "ctest" else next(
            (KIND[word] for word in words if word in KIND), "configurePresets")
        self.assertIn(words[words.index("--preset") + 1], [one["name"] for one in PRESETS[kind]])

    def check_options(self, program, words):
        places = [*OPTIONS.get(program, []), *([program] if program.endswith(".sh") else [])]
        known = "".join(text_of(place) for place in places)
        for option in (word for word in words if word.startswith("--")):
            self.assertRegex(known, rf"{option}\b", f"{program} has no {option}")
        if program == "Utilities/check.sh":
            self.assertLessEqual(set(words), set(re.search(r"stages=\((packages[^)]*)\)",
                                                           known).group(1).split()))


unittest.main()
