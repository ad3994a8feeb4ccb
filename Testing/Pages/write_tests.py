"""Writes a test of each block of C++ in the pages: it compiles, and runs without an error.

    write_tests.py TESTS.cxx PAGE...

A block is the body of a test of the fixture in PageFixture.h, whose members stand for what a page
says in words; a whole program is called; what draws is only compiled. Headers are those of the classes that are named.
"""
import pathlib
import re
import sys

# By the fixture's members: the block goes on from something with this name.
GIVEN = {"reader": "Reader", "marked": "Marked", "deformation": "Deformation", "turn": "Turn",
         "motion": "Motion"}


def blocks(page):
    text = pathlib.Path(page).read_text(encoding="utf-8")
    return re.findall(r"^```cpp\n(.*?)^```$", text, re.MULTILINE | re.DOTALL)


def test(name, block):
    """The function that runs a block."""
    code = re.sub(r"^#include .*\n", "", block, flags=re.MULTILINE).strip()
    head = f"TEST_F(Pages, {name})\n{{\n"
    if "int main()" in code:
        program = code.replace("int main()", f"int Program{name}()")
        return f"{program}\n\n{head}  EXPECT_EQ(Program{name}(), 0);\n}}\n"
    if re.search(r"\brepresentation\b", code):
        # It cannot be made without a library that renders.
        return ("#ifdef CARTAN_HAVE_WIDGETS\n#include <vtkBoxRepresentation.h>\n"
                f"void Compile{name}(vtkBoxRepresentation* representation)\n{{\n{code}\n}}\n#endif\n")
    given = "".join(f"  const auto& {word} = this->{member};\n" for word, member in GIVEN.items()
                    if re.search(rf"\b{word}\b", code) and f"> {word};" not in code)
    return f"{head}{given}{code}\n}}\n"


def main(output, pages):
    tests = [(re.sub(r"\W", "", pathlib.Path(page).stem) + str(number), block)
             for page in pages for number, block in enumerate(blocks(page))]
    classes = {name for _, block in tests for name in re.findall(r"\bvtk[A-Z]\w+", block)}
    headers = sorted((classes | {"vtkPointData"}) - {"vtkBoxRepresentation"})
    text = "// Written by write_tests.py.\n#include \"PageFixture.h\"\n\n"
    text += "".join(f"#include <{name}.h>\n" for name in headers) + "\n#include <iostream>\n\n"
    text += "\n".join(test(*entry) for entry in tests)
    pathlib.Path(output).write_text(text, encoding="utf-8")


main(sys.argv[1], sys.argv[2:])
