"""A pvserver on this machine, and a client that is connected to it.

    python3 serve.py PVSERVER [ARGUMENT...] -- CLIENT [ARGUMENT...]
"""
import socket
import subprocess
import sys


class Server:
    """A pvserver on a free port, ready once it is made. It leaves with its client."""

    def __init__(self, *command):
        with socket.socket() as probe:
            probe.bind(("localhost", 0))
            self.port = probe.getsockname()[1]
        self.process = subprocess.Popen([*command, "--server-port=%d" % self.port],
                                        stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.output = b""
        while b"Accepting connection" not in self.output:
            line = self.process.stdout.readline()
            self.output += line
            if not line:
                raise RuntimeError("pvserver does not start: " + self.output.decode())

    def kill(self):
        self.process.kill()


def main(arguments):
    middle = arguments.index("--")
    server = Server(*arguments[:middle])
    try:
        result = subprocess.run(
            [*arguments[middle + 1:], "--server-url=cs://localhost:%d" % server.port], check=False)
        if result.returncode == 0:
            print(server.process.communicate(timeout=60)[0].decode(), flush=True)
    finally:
        server.kill()
    return result.returncode


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
