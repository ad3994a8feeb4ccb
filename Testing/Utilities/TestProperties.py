"""ParaView shows what the classes report: each result is a property of a proxy."""
import pathlib
import re
import unittest
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent

# Outputs, texts of PrintSelf, and what VTK has of its own.
NOT_RESULTS = {"GetFormsTable", "GetChangeTable", "GetModeAsString", "GetRegionSourceAsString",
               "GetOrientation", "GetProblem", "GetMTime", "GetErrorCode"}


def results(header):
    """The getters of a class that have no setter."""
    text = header.read_text(encoding="utf-8")
    getters = set(re.findall(r"\bGet\w+(?=\(\))", text))
    getters |= {"Get" + name for name in re.findall(r"vtkGet\w*Macro\((\w+)", text)}
    setters = set(re.findall(r"\bSet\w+(?=\()", text))
    setters |= {"Set" + name for name in re.findall(r"vtkSet\w*Macro\((\w+)", text)}
    return {name for name in getters
            if "S" + name[1:] not in setters and name not in NOT_RESULTS}


def commands():
    """The commands of all properties, by class; those of base proxies are theirs too."""
    proxies = {}
    for path in (ROOT / "Plugin").glob("*.xml"):
        for group in xml.etree.ElementTree.parse(path).iter("ProxyGroup"):
            for proxy in group:
                own = {element.get("command") for element in proxy.iter() if element.get("command")}
                base = (proxy.get("base_proxygroup"), proxy.get("base_proxyname"))
                proxies[group.get("name"), proxy.get("name")] = (proxy.get("class"), base, own)
    by_class = {}
    for class_name, base, own in proxies.values():
        found = by_class.setdefault(class_name, set())
        found |= own
        while base in proxies:
            found |= proxies[base][2]
            base = proxies[base][1]
    return by_class


class Properties(unittest.TestCase):
    def test_every_result_is_a_property(self):
        by_class = commands()
        count = 0
        for header in sorted((ROOT / "Filters").glob("vtk*.h")):
            shown = by_class.get(header.stem)
            expected = results(header)
            count += len(expected)
            if expected:
                self.assertIsNotNone(shown, header.stem + " has no proxy")
                self.assertEqual(expected - shown, set(), header.stem)
        self.assertGreater(count, 20)  # the headers are read at all


if __name__ == "__main__":
    unittest.main()
