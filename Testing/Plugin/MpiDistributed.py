"""On two ranks: a surface in pieces is refused, one on a single rank is deformed."""
from paraview import simple
from vtkmodules.vtkParallelCore import vtkMultiProcessController

from plugin_testing import Messages, check, load_plugin, mark_ends, open_bar, refresh

controller = vtkMultiProcessController.GetGlobalController()
check(controller.GetNumberOfProcesses() == 2, "this test wants two ranks")
load_plugin()

# The other rank reports the same errors. A programmable source runs everywhere.
simple.ProgrammableSource(Script="""
from vtkmodules.vtkCommonCore import vtkLogger
vtkLogger.SetStderrVerbosity(vtkLogger.VERBOSITY_OFF)
""").UpdatePipeline()


def check_refused(proxy):
    errors = Messages(proxy)
    proxy.UpdatePipeline()
    check(len(errors.texts) == 1 and "distributed over 2 ranks" in errors.texts[0], errors.texts)
    check("Aggregate Dataset" in errors.texts[0], "what to do")
    check(proxy.GetDataInformation().GetNumberOfPoints() == 0, "the output is not empty")


# Each rank makes its piece of the sphere.
sphere = simple.Sphere(ThetaResolution=32, PhiResolution=32)
check_refused(simple.DiscreteForms(Input=sphere))
marked = simple.MarkHandle(Input=sphere, RegionSource="All Points")
check_refused(marked)
check_refused(simple.CurvatureError(Input=sphere))

# The reader gives the whole bar to the first rank.
bent = simple.RotationInvariantDeformation(Input=mark_ends(open_bar("MpiDistributed")))
bent.Motion.Angle = 30
refresh(bent)
check(bent.NumberOfFreePoints > 100, "free points")
check(bent.GetDataInformation().GetNumberOfPoints() == 354, "the bar")
