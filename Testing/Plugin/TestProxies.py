"""Every proxy can be made, is documented, and starts with the class's own defaults."""
import vtkcartan
from paraview import servermanager, simple
from vtkmodules.vtkCommonExecutionModel import vtkAlgorithm

from plugin_testing import check, load_plugin

MOTIONS = ["Axis and Angle", "Box", "Matrix"]

# Not the class's defaults: Mode makes a kind of motion what it is, the class has no
# matrix until it is given one, and a link takes the active handle's box to ReferenceBounds.
PRESET = {"Mode", "Matrix", "ReferenceBounds"}


def properties(proxy):
    iterator = servermanager.vtkSMPropertyIterator()
    iterator.SetProxy(proxy.SMProxy)
    iterator.Begin()
    while not iterator.IsAtEnd():
        yield iterator.GetKey(), iterator.GetProperty()
        iterator.Next()


def values(smproperty):
    return [smproperty.GetElement(i) for i in range(smproperty.GetNumberOfElements())]


def check_documented(proxy):
    name = proxy.SMProxy.GetXMLName()
    documentation = proxy.SMProxy.GetDocumentation()
    check(documentation.GetShortHelp() and documentation.GetLongHelp()
          and documentation.GetDescription(), name + " is not documented")
    for key, smproperty in properties(proxy):
        if not smproperty.GetIsInternal():
            text = smproperty.GetDocumentation()
            check(text and text.GetDescription().strip(), "%s.%s is not documented" % (name, key))
            check(smproperty.GetXMLLabel().replace(" ", "") == key,
                  "%s.%s is labeled %s: Python would find it under that name"
                  % (name, key, smproperty.GetXMLLabel()))


def settable(proxy):
    """The vector properties that set a value of the algorithm, with what gets it."""
    for key, smproperty in properties(proxy):
        command = smproperty.GetCommand() or ""
        if (key not in PRESET and command.startswith("Set")
                and smproperty.IsA("vtkSMVectorProperty") and smproperty.GetNumberOfElements()):
            yield key, smproperty, command.replace("Set", "Get", 1)


def as_list(value):
    return list(value) if isinstance(value, tuple) else [value]


def check_defaults(proxy, algorithm):
    """The proxy's values are those of a new object of the class, by its getters."""
    for key, smproperty, get in settable(proxy):
        default = as_list(getattr(algorithm, get)())
        check(values(smproperty) == default, "%s.%s is %s, not %s" % (
            proxy.SMProxy.GetXMLName(), key, values(smproperty), default))


def another(smproperty, value):
    if isinstance(value, str):
        return value + "2"
    enumeration = smproperty.FindDomain("vtkSMEnumerationDomain")
    if enumeration:
        entries = [enumeration.GetEntryValue(i) for i in range(enumeration.GetNumberOfEntries())]
        return next(entry for entry in entries if entry != value)
    if smproperty.FindDomain("vtkSMBooleanDomain"):
        return 1 - value
    is_int = isinstance(value, int)
    step = 1 if is_int else 0.5
    domain = smproperty.FindDomain("vtkSMIntRangeDomain" if is_int else "vtkSMDoubleRangeDomain")
    is_last = (domain and domain.GetMaximumExists(0) and value + step > domain.GetMaximum(0))
    return value - step if is_last else value + step


def check_settable(proxy):
    """Another value of each property arrives at the algorithm."""
    for key, smproperty, get in settable(proxy):
        before = values(smproperty)
        after = [another(smproperty, value) for value in before]
        for i, value in enumerate(after):
            smproperty.SetElement(i, value)
        proxy.UpdateVTKObjects()
        arrived = as_list(getattr(proxy.GetClientSideObject(), get)())
        check(arrived == after, "%s.%s = %s arrives as %s" % (
            proxy.SMProxy.GetXMLName(), key, after, arrived))
        for i, value in enumerate(before):
            smproperty.SetElement(i, value)
        proxy.UpdateVTKObjects()


def filters_of_category(category):
    """The names of the filters that the menu shows in a category."""
    definitions = servermanager.ProxyManager().GetProxyDefinitionManager()
    iterator = definitions.NewSingleGroupIterator("filters")
    iterator.InitTraversal()
    while not iterator.IsDoneWithTraversal():
        hints = iterator.GetProxyHints()
        menu = hints and hints.FindNestedElementByName("ShowInMenu")
        if menu and menu.GetAttribute("category") == category:
            yield iterator.GetProxyName()
        iterator.GoToNextItem()


def classes_of_filters():
    """The module's classes that are filters, without vtk before their names."""
    for name in dir(vtkcartan):
        algorithm = getattr(vtkcartan, name)
        if not (isinstance(algorithm, type) and issubclass(algorithm, vtkAlgorithm)):
            continue
        try:
            filter = algorithm()
        except TypeError:  # A base class.
            continue
        if filter.GetNumberOfInputPorts() and filter.GetNumberOfOutputPorts():
            yield name[len("vtk"):]


load_plugin()
load_plugin()  # A second time is harmless.

names = set(filters_of_category("Cartan"))
check(names == set(classes_of_filters()), "differ from the classes: %s"
      % (names ^ set(classes_of_filters())))

sphere = simple.Sphere()
forms = simple.OutputPort(simple.DiscreteForms(Input=sphere), 1)
for name in sorted(names):
    inputs = {"Forms": forms} if name == "FrameReconstruction" else {}
    for second in ("Reference", "Original", "Source"):
        prototype = servermanager.ProxyManager().GetPrototypeProxy("filters", name)
        port = prototype.GetProperty(second)
        if port and port.IsA("vtkSMInputProperty"):
            inputs[second] = sphere
    proxy = getattr(simple, name)(Input=sphere, **inputs)
    algorithm = proxy.GetClientSideObject()
    check(algorithm.GetClassName() == "vtk" + name, name + " makes another class")
    check_documented(proxy)
    check_defaults(proxy, getattr(vtkcartan, "vtk" + name)())
    check_settable(proxy)
    if proxy.GetProperty("Motion"):
        check(proxy.Motion.SMProxy.GetXMLName() == "Axis and Angle", "the default motion")
        for kind in MOTIONS:
            proxy.Motion = kind
            check_documented(proxy.Motion)
            check_defaults(proxy.Motion, vtkcartan.vtkHandleMotion())
            check_settable(proxy.Motion)
        proxy.Motion = "None"
        check(algorithm.GetActiveMotion() is None, "no motion")
