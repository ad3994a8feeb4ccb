# SPDX-License-Identifier: BSD-3-Clause
"""Prints how long each filter is silent at most, and so how long an abort waits, on a scanned
surface of 416,002 points; and whether its progress ever runs back.

Run it with pvpython and the variables of the tests, CARTAN_MESH_DIR and PYTHONPATH. Times
are those of the processor, so that other programs do not count; tasks of every_filter.py
restrict it: progress.py PoissonDeformation "SurfaceMorph Linear".
"""
import sys
import time

import every_filter
import scan


class Watch:
    """Listens to a filter's progress."""

    def __init__(self, name, filter):
        self.name, self.longest, self.at, self.back, self.value = name, 0.0, 0.0, 0, 0.0
        self.filter = filter
        filter.AddObserver("ProgressEvent", self.hear)
        self.begin = self.last = time.process_time()
        filter.Update()
        self.hear()
        print(f"{name:34s} {time.process_time() - self.begin:8.1f} s, longest silence "
              f"{self.longest:5.2f} s after {100 * self.at:3.0f} %"
              f"{', runs back ' + str(self.back) + ' times' if self.back else ''}", flush=True)

    def hear(self, *_):
        now, value = time.process_time(), self.filter.GetProgress()
        if now - self.last > self.longest:
            self.longest, self.at = now - self.last, self.value
        self.back += value < self.value - 1e-9
        self.last, self.value = now, value


def update_inputs(filter):
    """What is before the filter is not its own time."""
    for port in range(filter.GetNumberOfInputPorts()):
        for connection in range(filter.GetNumberOfInputConnections(port)):
            filter.GetInputAlgorithm(port, connection).Update()


def main():
    surface = scan.armadillo(2).GetOutput()
    print(f"{surface.GetNumberOfPoints()} points")
    for task in sys.argv[1:] or every_filter.TASKS:
        filter = every_filter.make(task, surface)
        update_inputs(filter)
        Watch(task, filter)


main()
