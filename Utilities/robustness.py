#!/usr/bin/env pvpython
# SPDX-License-Identifier: BSD-3-Clause
"""Runs every filter on every mesh of libcgal-demo, as it comes and after Prepare
Surface, and prints the tables of Documentation/Robustness.md:

    Utilities/robustness.sh [BUILD] [--points N] [--mesh NAME]... [--task FILTER]...

Each mesh has a process of its own, which a crash or a filter that takes more than a
minute of processor time ends; it then goes on with the next filter.
"""
import argparse
import collections
import glob
import json
import os
import signal
import subprocess
import sys

import numpy
from vtkmodules.util.numpy_support import vtk_to_numpy

import every_filter

TASKS = list(every_filter.TASKS)
SECONDS = 60


def is_finite(output):
    """Whether points and arrays are, but for those that say NaN where nothing is."""
    documented = ("AreaRatio", "EdgeLengthRatio", "LocalVolume", "LocalVolumeRatio")
    arrays = [output.GetPoints().GetData()]
    arrays += [output.GetPointData().GetArray(i)
               for i in range(output.GetPointData().GetNumberOfArrays())]
    return all(numpy.isfinite(vtk_to_numpy(array)).all()
               for array in arrays if array and array.GetName() not in documented)


def execute(task, filter, surface):
    """A result and what was said."""
    messages = collections.defaultdict(list)

    def observe(event):
        def note(_, __, text):
            messages[event].append(text.split("): ", 1)[-1].strip())
        note.CallDataType = "string0"
        return note
    filter.AddObserver("ErrorEvent", observe("error"))
    filter.AddObserver("WarningEvent", observe("warning"))
    filter.Update()
    if messages["error"]:
        return "refused", messages["error"][0]
    output = filter.GetOutput()
    if (output.GetNumberOfPoints() != surface.GetNumberOfPoints()
            and task not in every_filter.OTHER_POINTS):
        return "wrong", "a partial output"
    if not is_finite(output):
        return "wrong", "not finite"
    return "processed", " ".join(messages["warning"])


def work(path, done):
    """One JSON line per state and task, as soon as it is known."""
    import vtkcartan
    from cartan_testing import read_off

    def say(*words):
        print(json.dumps(words), flush=True)

    surface = read_off(path)
    for state in ("before", "after"):
        if state == "after":
            prepare = vtkcartan.vtkPrepareSurface()
            prepare.SetInputData(surface)
            prepare.AddObserver("ErrorEvent", lambda *_: None)
            prepare.Update()
            surface = prepare.GetOutput()
        for task in TASKS:
            if [state, task] in done:
                continue
            say("begin", state, task)
            signal.setitimer(signal.ITIMER_PROF, SECONDS)
            if surface.GetNumberOfPolys() == 0:
                result = "refused", "no triangles"
            else:
                result = execute(task, every_filter.make(task, surface), surface)
            signal.setitimer(signal.ITIMER_PROF, 0)
            say("end", state, task, surface.GetNumberOfPoints(), *result)


def watch(path):
    """All results of a mesh, by state and task."""
    results = {}
    running = True
    while running:
        done = json.dumps([list(key) for key in results])
        child = subprocess.run([sys.executable if "pvpython" in sys.executable else "pvpython",
                                __file__, "--work", path, "--done", done]
                               + [word for task in TASKS for word in ("--task", task)],
                               stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True,
                               check=False)
        begun = None
        for line in child.stdout.splitlines():
            if not line.startswith("["):
                continue
            words = json.loads(line)
            if words[0] == "begin":
                begun = tuple(words[1:3])
            else:
                results[begun] = words[4:]
                begun = None
        running = begun is not None
        if running:
            slow = child.returncode in (-signal.SIGPROF, 128 + signal.SIGPROF)
            text = f"more than {SECONDS} s" if slow else f"crash, exit code {child.returncode}"
            results[begun] = ["wrong", text]
    return results


def print_tables(results):
    """`results` by mesh, state and task."""
    print("| filter | before: processed | refused | wrong | after: processed | refused | wrong |")
    print("|---|---|---|---|---|---|---|")
    for task in TASKS:
        cells = [task]
        for state in ("before", "after"):
            count = collections.Counter(
                of_mesh.get((state, task), ["wrong"])[0] for of_mesh in results.values())
            cells += [str(count[kind]) for kind in ("processed", "refused", "wrong")]
        print("| " + " | ".join(cells) + " |")
    print("\n| mesh | state | filter | result | reason |\n|---|---|---|---|---|")
    for mesh, of_mesh in results.items():
        for state in ("before", "after"):
            groups = collections.defaultdict(list)
            for task in TASKS:
                kind, text = of_mesh.get((state, task), ["wrong", "not run"])
                if kind != "processed":
                    groups[kind, text].append(task)
            for (kind, text), tasks in groups.items():
                names = "all" if len(tasks) == len(TASKS) else ", ".join(tasks)
                print(f"| {mesh} | {state} | {names} | {kind} | {text} |")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--points", type=int, default=0, help="only meshes of at most so many")
    parser.add_argument("--mesh", action="append", help="only this mesh, such as camel")
    parser.add_argument("--task", action="append", help="only this filter, such as LeastSquaresMesh")
    parser.add_argument("--work", help=argparse.SUPPRESS)
    parser.add_argument("--done", help=argparse.SUPPRESS)
    options = parser.parse_args()
    TASKS[:] = options.task or TASKS
    if options.work:
        work(options.work, json.loads(options.done))
        return
    results = {}
    for path in sorted(glob.glob(os.path.join(os.environ["CARTAN_MESH_DIR"], "*.off"))):
        mesh = os.path.splitext(os.path.basename(path))[0]
        with open(path, encoding="ascii", errors="replace") as file:
            words = [word for line in file.read(2000).splitlines()
                     for word in line.split("#")[0].split()]
        numbers = [int(word) for word in words if word.lstrip("-").isdigit()]
        if (options.mesh and mesh not in options.mesh) or (
                options.points and numbers and numbers[0] > options.points):
            continue
        results[mesh] = watch(path)
        count = collections.Counter(result[0] for result in results[mesh].values())
        print(f"{mesh}: {dict(count)}", file=sys.stderr, flush=True)
    print_tables(results)
    after = [result[0] for of_mesh in results.values() for key, result in of_mesh.items()
             if key[0] == "after"]
    print(f"\n{len(results)} meshes; after preparation {after.count('processed')} of "
          f"{len(after)} runs processed, {after.count('refused')} refused, "
          f"{after.count('wrong')} wrong")


if __name__ == "__main__":
    main()
