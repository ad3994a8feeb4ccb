"""Save Data writes compressed surfaces, and Open reads them, by the end of the name."""
import os

import cartan_testing
from paraview import simple
from vtkmodules.util.numpy_support import vtk_to_numpy

from plugin_testing import check, load_plugin

load_plugin()
sphere = simple.Sphere(ThetaResolution=40, PhiResolution=40)
path = cartan_testing.output_path("sphere.csf")
simple.SaveData(path, proxy=sphere)
check(os.path.getsize(path) < 20 * 1522, "%d bytes" % os.path.getsize(path))

opened = simple.OpenDataFile(path)
check(opened.SMProxy.GetXMLName() == "CompressedSurfaceReader", "the reader")
opened.UpdatePipeline()
before, after = (vtk_to_numpy(simple.servermanager.Fetch(proxy).GetPoints().GetData())
                 for proxy in (sphere, opened))
check(before.shape == after.shape, "as many points")
check(abs(before - after).max() < 0.01, "off by %g" % abs(before - after).max())

# The dialogs offer the files.
check("csf" in str(simple.servermanager.vtkSMProxyManager.GetProxyManager()
                   .GetReaderFactory().GetSupportedFileTypes(sphere.SMProxy.GetSession())),
      "offered by Open")
