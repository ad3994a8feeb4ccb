"""The filters run in a pvserver that a client is connected to."""
import os
import shutil
import socket
import subprocess
import sys

import cartan_testing
from paraview import simple

from plugin_testing import check, check_close, mark_ends, open_bar, refresh


def free_port():
    with socket.socket() as probe:
        probe.bind(("localhost", 0))
        return probe.getsockname()[1]


def find_pvserver():
    """The one beside this program, or the one in the path."""
    beside = os.path.join(os.path.dirname(sys.executable or ""), "pvserver")
    return beside if os.path.exists(beside) else shutil.which("pvserver")


def use_filters():
    bar = open_bar("TestServer")
    bent = simple.RotationInvariantDeformation(Input=mark_ends(bar), Motion="Box")
    bent.Motion.Rotation = [0, 90, 0]
    bent.Motion.Position = [2, 0, 3]
    refresh(bent)
    check(bent.NumberOfFreePoints > 100, "free points")
    check_close(bent.GetDataInformation().GetBounds()[4], -2.0, "the lowest point", 1e-4)
    check_close(bent.Motion.ReferenceBounds, bent.ActiveHandleBounds, "the box is the handle's")

    query = simple.SelectionQuerySource(ElementType="Point Data", QueryString="(id < 10)")
    marked = simple.MarkHandle(Input=bent, HandleArrayName="Other", Selection=query)
    refresh(marked)
    check(marked.NumberOfMarkedPoints == 10, "a query: %d" % marked.NumberOfMarkedPoints)
    check(list(marked.GetProperty("MarkedPointIds")) == list(range(10)), "the marked points")

    change = simple.VolumeChange(Input=bent, Reference=bar)
    refresh(change)
    check(change.RelativeVolumeChange < -1e-3, "volume")


port = free_port()
server = subprocess.Popen([find_pvserver(), "--server-port=%d" % port],
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
try:
    # The server is ready once it has said where it listens.
    while b"Accepting connection" not in server.stdout.readline():
        check(server.poll() is None, "pvserver does not start")
    simple.Connect("localhost", port)
    for remote in (True, False):
        simple.LoadPlugin(cartan_testing.plugin_path(), remote=remote)
    use_filters()
except BaseException:
    server.kill()
    raise
# The server leaves with its client, which still has to tell it so.
