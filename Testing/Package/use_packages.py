"""Installs the Debian packages into a folder, uses them there and removes them again.

    use_packages.py PACKAGES ROOT

The programs of ParaView are copied into the folder, because they look for plugins relative to
themselves; everything else that they need is the system's.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile
import time

PACKAGES = {"libvtkcartan", "python3-vtkcartan", "paraview-plugin-cartan"}
PROGRAMS = ("paraview", "pvpython", "pvbatch", "pvserver")

# Runs in each program: the plugin is there by itself, and its filters work.
USE = """
import os, sys
from paraview import simple
%s
assert hasattr(simple, "MarkHandle"), "the plugin is not loaded"
sphere = simple.Sphere(ThetaResolution=16, PhiResolution=16)
marked = simple.MarkHandle(Input=sphere, RegionSource="All Points")
marked.UpdatePipeline()
marked.UpdatePropertyInformation()
assert marked.NumberOfMarkedPoints == 226, marked.NumberOfMarkedPoints
os.write(1, b"the plugin works\\n")
os._exit(0)
"""


def check(condition, what):
    """Fails the test with a sentence unless the condition holds."""
    if not condition:
        sys.exit("FAILED: " + what)


def output(*command, **options):
    """What a command prints."""
    done = subprocess.run([str(word) for word in command], text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, timeout=120, **options)
    check(done.returncode == 0, "%s:\n%s" % (" ".join(map(str, command)), done.stdout))
    return done.stdout


class Root:
    """A folder with a package database of its own."""

    def __init__(self, path):
        self.path = pathlib.Path(path).resolve()
        shutil.rmtree(self.path, ignore_errors=True)
        for folder in ("var/lib/dpkg/info", "var/lib/dpkg/updates", "usr/bin"):
            (self.path / folder).mkdir(parents=True)
        (self.path / "var/lib/dpkg/status").touch()
        for program in PROGRAMS:
            shutil.copy(shutil.which(program), self.path / "usr/bin" / program)
        self.before = self.files()

    def files(self):
        """All files but those of the database."""
        return {path.relative_to(self.path) for path in self.path.rglob("*")
                if not path.is_dir() and "var/lib/dpkg" not in str(path)}

    def dpkg(self, *arguments):
        # What the packages depend on is outside of the folder.
        return output("dpkg", "--root=%s" % self.path, "--force-depends", "--force-not-root",
                      "--force-script-chrootless", *arguments)

    def find(self, pattern):
        found = list(self.path.glob(pattern))
        check(len(found) == 1, "%s: %s" % (pattern, found))
        return found[0]


def check_control(packages):
    """The names, and what they depend on."""
    fields = {}
    for package in packages:
        name, depends = output("dpkg-deb", "--showformat=${Package}\n${Depends}", "--show",
                               package).split("\n")
        fields[name] = depends
    check(set(fields) == PACKAGES, "packages: %s" % sorted(fields))
    for name, depends in fields.items():
        check(name == "libvtkcartan" or "libvtkcartan (= " in depends, name + ": " + depends)
    check("python3-paraview" in fields["python3-vtkcartan"], "python3-paraview")
    for name in ("libvtkcartan", "paraview-plugin-cartan"):
        check("paraview (>= " in fields[name] and "paraview (<< " in fields[name],
              "%s fits one version of ParaView: %s" % (name, fields[name]))


def use_programs(root, folder):
    """All four programs load the plugin by themselves."""
    script = pathlib.Path(folder, "use.py")
    script.write_text(USE % "", encoding="utf-8")
    home = dict(os.environ, HOME=folder, XDG_CONFIG_HOME=folder)
    settings = pathlib.Path(folder, "ParaView")
    settings.mkdir()
    for name in ("ParaView5.11.0.ini", "ParaView5.11.ini"):
        (settings / name).write_text("[General]\nGeneralSettings.ShowWelcomeDialog=false\n")
    for command in (("pvpython", script), ("pvbatch", script), ("paraview", "--script=%s" % script)):
        text = output(root.path / "usr/bin" / command[0], *command[1:], env=home)
        check("the plugin works" in text, "%s: %s" % (command[0], text))

    port = 20000 + os.getpid() % 20000
    script.write_text(USE % ("simple.Connect('localhost', %d)" % port), encoding="utf-8")
    server = subprocess.Popen([root.path / "usr/bin/pvserver", "--server-port=%d" % port],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=home)
    try:
        time.sleep(3)
        text = output(root.path / "usr/bin/pvpython", script, env=home)
        check("the plugin works" in text, "pvserver: " + text)
    finally:
        server.kill()
        server.communicate()


def use_python(root):
    package = root.find("usr/lib/python3*/*-packages/vtkcartan")
    script = ("import numpy, vtkcartan; print(vtkcartan.__file__); p = numpy.eye(3);"
              "print(vtkcartan.deform(p, [[0, 1, 2]], {1: [0]}).sum())")
    text = output("pvpython", "-c", script, env=dict(os.environ, PYTHONPATH=str(package.parent)))
    check(str(package) in text and "3.0" in text, "python3-vtkcartan: " + text)


def use_cmake(root, folder):
    output("cmake", "-S", os.environ["CARTAN_CONSUMER"], "-B", os.path.join(folder, "consumer"),
           "-DCMAKE_PREFIX_PATH=%s" % (root.path / "usr"))


def main(folder, root):
    packages = sorted(pathlib.Path(folder).glob("*.deb"))
    check_control(packages)
    root = Root(root)
    root.dpkg("--install", *packages)
    check(root.find("usr/bin/paraview.conf"), "paraview.conf")
    with tempfile.TemporaryDirectory() as scratch:
        use_programs(root, scratch)
        use_python(root)
        use_cmake(root, scratch)
    root.dpkg("--install", *packages)  # again: an upgrade
    lines = root.find("usr/bin/paraview.conf").read_text(encoding="utf-8").splitlines()
    check(len(lines) == 1, "paraview.conf: %s" % lines)
    root.dpkg("--purge", *sorted(PACKAGES))
    left = root.files() - root.before - {p for p in root.files() if "__pycache__" in str(p)}
    check(not left, "left after removal: %s" % sorted(map(str, left)))
    print("installed, used and removed: " + ", ".join(package.name for package in packages))


main(*sys.argv[1:])
