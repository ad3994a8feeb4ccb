# SPDX-License-Identifier: BSD-3-Clause
"""Opens the state that demo.py saved, as a user would, and bends the first
surface further. Run by Utilities/demo.sh in pvpython; the argument is the build
folder."""
import os
import sys

from paraview.simple import *

from plugin import load_plugin, plugin_path
from poses import POSES


def main(build):
    load_plugin(build, globals())
    state = os.path.join(build, "demo", "demo.pvsm")
    LoadState(state)
    names = [name for name, _ in GetSources()]
    if len(set(names)) < len(names):
        raise SystemExit(f"{state} has filters of one name.")
    for pose in POSES:
        bent = FindSource(f"{pose.title} deformed")
        if bent is None:
            raise SystemExit(f"{state} has no surface {pose.title}.")
        bounds = [bent.GetDataInformation().GetBounds()]
        bent.Motion.Angle = 0.5 * bent.Motion.Angle
        bent.UpdatePipeline()
        bounds.append(bent.GetDataInformation().GetBounds())
        if bounds[0] == bounds[1] or bounds[1][0] > bounds[1][1]:
            raise SystemExit(f"{pose.title} in {state} does not move.")
    print(f"The state opens in ParaView with its {len(POSES)} surfaces, which follow their handles:\n"
          f"  paraview --plugin-search-paths={os.path.dirname(plugin_path(build))} "
          f"--plugins=CartanPlugin --state={state}")


if __name__ == "__main__":
    main(sys.argv[1])
