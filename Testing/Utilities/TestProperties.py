"""ParaView shows what the classes report: each result is a property of a proxy."""
import pathlib
import re
import unittest
import xml.etree.ElementTree

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent

# Outputs, texts of PrintSelf, and what VTK has of its own.
NOT_RESULTS = {"GetFormsTable", "GetChangeTable", "GetSpectrumTable", "GetErrorTable",
               "GetBitTable", "GetCorrespondences", "GetBase", "GetLandmarkTable",
               "GetCarried", "GetVolumeMesh",
               "GetModeAsString", "GetRegionSourceAsString",
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
        for source in sorted((ROOT / "Filters").glob("vtk*.cxx")):
            header = source.with_suffix(".h")
            shown = by_class.get(header.stem)
            expected = results(header)
            count += len(expected)
            if expected:
                self.assertIsNotNone(shown, header.stem + " has no proxy")
                self.assertEqual(expected - shown, set(), header.stem)
        self.assertGreater(count, 20)  # the headers are read at all


def proxies(root):
    """All proxies of a file, those that properties offer too."""
    for group in root.iter("ProxyGroup"):
        yield from (child for child in group if "Proxy" in child.tag)


class Panels(unittest.TestCase):
    """What users see of filters and properties."""

    def test_every_property_is_documented(self):
        count = 0
        for path in sorted((ROOT / "Plugin").glob("*.xml")):
            for proxy in proxies(xml.etree.ElementTree.parse(path)):
                for element in proxy:
                    if not element.tag.endswith("Property") or element.get("is_internal") == "1":
                        continue
                    count += 1
                    name = "%s: %s.%s" % (path.name, proxy.get("name"), element.get("name"))
                    text = " ".join((element.findtext("Documentation") or "").split())
                    self.assertGreater(len(text), 10, name + " is not documented")
                    self.assertTrue(text.endswith("."), name + ": " + text)
        self.assertGreater(count, 100)

    def test_results_do_not_look_editable(self):
        """Numbers that are reported are shown as such: others' fields take what is typed."""
        count = 0
        for path in sorted((ROOT / "Plugin").glob("*.xml")):
            for proxy in proxies(xml.etree.ElementTree.parse(path)):
                for element in proxy:
                    if (element.tag in ("IntVectorProperty", "DoubleVectorProperty")
                            and element.get("information_only") == "1"
                            and element.get("number_of_elements") == "1"
                            and element.get("panel_visibility") == "default"):
                        count += 1
                        self.assertEqual(element.get("panel_widget"), "cartan_measure",
                                         "%s.%s" % (proxy.get("name"), element.get("name")))
        self.assertGreater(count, 20)

    def test_every_filter_has_an_icon(self):
        plugin = ROOT / "Plugin"
        listed = {"Icons/" + path.name for path in (plugin / "Icons").glob("*.svg")}
        used = set()
        for path in sorted(plugin.glob("*.xml")):
            for proxy in proxies(xml.etree.ElementTree.parse(path)):
                for menu in proxy.iter("ShowInMenu"):
                    icon = menu.get("icon", "")
                    self.assertEqual(icon, ":/Cartan/Icons/%s.svg" % proxy.get("name"), path.name)
                    used.add(icon[len(":/Cartan/"):])
        self.assertEqual(used, listed)
        for name in listed:
            root = xml.etree.ElementTree.parse(plugin / name).getroot()
            self.assertEqual(root.get("viewBox"), "0 0 24 24", name)
            self.assertGreater(len(root), 1, name)


if __name__ == "__main__":
    unittest.main()
