"""On two ranks: a surface in pieces is refused, by one message of one rank; one on a single rank
is deformed."""
from paraview import simple
from vtkmodules.vtkParallelCore import vtkMultiProcessController

from plugin_testing import check, load_plugin, mark_ends, open_bar, refresh

controller = vtkMultiProcessController.GetGlobalController()
check(controller.GetNumberOfProcesses() == 2, "this test wants two ranks")
load_plugin()

refused = 0


def check_refused(proxy):
    """What the ranks print is counted outside, by RunOnRanks.py."""
    global refused
    proxy.UpdatePipeline()
    refused += 1
    check(proxy.GetDataInformation().GetNumberOfPoints() == 0, "the output is not empty")


# Each rank makes its piece of the sphere.
sphere = simple.Sphere(ThetaResolution=32, PhiResolution=32)
check_refused(simple.DiscreteForms(Input=sphere))
marked = simple.MarkHandle(Input=sphere, RegionSource="All Points")
check_refused(marked)
check_refused(simple.CurvatureError(Input=sphere))
surfaces = refused
# Pieces of another kind.
grid = simple.AppendDatasets(Input=[sphere])
check_refused(simple.CarryAlong(Input=grid, Rest=sphere, Deformed=sphere))

# The reader gives the whole bar to the first rank.
bent = simple.RotationInvariantDeformation(Input=mark_ends(open_bar("MpiDistributed")))
bent.Motion.Angle = 30
refresh(bent)
check(bent.NumberOfFreePoints > 100, "free points")
check(bent.GetDataInformation().GetNumberOfPoints() == 354, "the bar")

for count, text in ((surfaces, "The surface is distributed over 2 ranks"),
                    (refused - surfaces, "The mesh is distributed over 2 ranks"),
                    (refused, "gather it on one rank (Aggregate Dataset")):
    print("expected %d times: %s" % (count, text), flush=True)
