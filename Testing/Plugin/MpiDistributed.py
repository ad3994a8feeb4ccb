"""On two ranks: a surface in pieces is deformed where it is, or gathered, deformed and handed back in
pieces; what cannot be gathered is refused by one message of one rank."""
from paraview import simple
from vtkmodules.vtkParallelCore import vtkMultiProcessController

from plugin_testing import check, check_close, load_plugin, mark_ends, open_bar, refresh

controller = vtkMultiProcessController.GetGlobalController()
check(controller.GetNumberOfProcesses() == 2, "this test wants two ranks")
load_plugin()


def points_of(proxy):
    proxy.UpdatePipeline()
    return proxy.GetDataInformation().GetNumberOfPoints()


# The reader gives the whole bar to the first rank: nothing is gathered.
marked = mark_ends(open_bar("MpiDistributed"))
bent = simple.RotationInvariantDeformation(Input=marked)
bent.Motion.Angle = 30
refresh(bent)
check(bent.NumberOfFreePoints > 100, "free points")
check(bent.GetDataInformation().GetNumberOfPoints() == 354, "the bar")
free = bent.NumberOfFreePoints
bounds = bent.GetDataInformation().GetBounds()

# The same in pieces.
grid = simple.RedistributeDataSet(Input=marked)
surface = simple.ExtractSurface(Input=grid)
in_pieces = simple.RotationInvariantDeformation(Input=surface)
in_pieces.Motion.Angle = 30
refresh(in_pieces)
check(in_pieces.NumberOfFreePoints == free, "free points of pieces")
check(points_of(in_pieces) == points_of(surface) > 354, "the bar in pieces")
for actual, expected in zip(in_pieces.GetDataInformation().GetBounds(), bounds):
    check_close(actual, expected, "bounds")

# A filter that gathers, also beyond the limit; and pieces of another kind.
gathered = simple.LaplacianDeformation(Input=surface)
gathered.Motion.Angle = 30
check(points_of(gathered) == points_of(surface), "the bar gathered")
gathered.GatherLimit = 300
check(points_of(gathered) == 0, "the output is not empty")
carried = simple.CarryAlong(Input=grid, Rest=marked, Deformed=bent)
check(points_of(carried) == 0, "the output is not empty")

for count, text in ((1, "it is gathered on the first, which works alone"),
                    (1, "more than GatherLimit (300)"),
                    (1, "The mesh is distributed over 2 ranks"),
                    (1, "gather it on one rank (Aggregate Dataset")):
    print("expected %d times: %s" % (count, text), flush=True)
