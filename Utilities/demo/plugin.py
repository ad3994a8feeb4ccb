# SPDX-License-Identifier: BSD-3-Clause
"""Finds the plugin of a build folder."""
import glob
import os

from paraview.simple import LoadPlugin


def plugin_path(build):
    pattern = os.path.join(build, "lib*", "**", "CartanPlugin.so")
    found = glob.glob(pattern, recursive=True)
    if not found:
        raise SystemExit(f"No plugin in {build}: build it first (Utilities/demo.sh does).")
    return found[0]


def load_plugin(build, names):
    """Loads it; `names`, the caller's globals(), get its filters."""
    LoadPlugin(plugin_path(build), remote=False, ns=names)
