"""The program under test: the built binary, or the one in an image. Both are used the same way.

    LPF_SERVER_BINARY   path of the binary
    LPF_IMAGE           name of an image; its containers share this machine's network and, at the same
                        paths, the files that their arguments name. As root: the tests look into the
                        server's files and its process.
    LPF_ENGINE          docker or podman (podman)
"""

import os
import subprocess
import uuid
from pathlib import Path

IMAGE = os.environ.get("LPF_IMAGE")
ENGINE = os.environ.get("LPF_ENGINE", "podman")
USER = 65532  # of the image; it must be able to use the tests' files


def is_there():
    return bool(IMAGE or os.environ.get("LPF_SERVER_BINARY"))


def run(arguments, **options):
    """Runs the program to its end, and catches what it says."""
    command = _in_container(arguments)[1] if IMAGE else _binary(arguments)
    options.setdefault("input", "")
    return subprocess.run(command, capture_output=True, text=True, timeout=60, check=False,
                          **options)


def start(arguments, stderr, descriptors=None):
    """Starts the program. What it says on standard output can be read from `stdout`.

    `descriptors` limits how many the program may have open.
    """
    if IMAGE:
        name, command = _in_container(arguments, descriptors)
        return _Container(name, command, stderr)
    command = _binary(arguments)
    if descriptors:
        command = ["prlimit", f"--nofile={descriptors}:{descriptors}", *command]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=stderr, text=True)


def _binary(arguments):
    return [os.environ["LPF_SERVER_BINARY"], *arguments]


def _in_container(arguments, descriptors=None):
    """A name, and the command that runs a container of this name as it is meant to be run."""
    name = "lpf-e2e-" + uuid.uuid4().hex[:12]
    command = [ENGINE, "run", "--rm", "--interactive", "--name", name, "--network", "host",
               "--no-healthcheck", "--read-only", "--tmpfs", "/tmp", "--cap-drop", "ALL",
               "--security-opt", "no-new-privileges"]
    if descriptors:  # podman forgets its other default with the first limit that is named
        command += ["--ulimit", f"nofile={descriptors}:{descriptors}", "--ulimit", "nproc=4096:4096"]
    for path in sorted({_shared(Path(text)) for text in arguments if text.startswith("/")}):
        subprocess.run(["chown", "-R", str(USER), str(path)], check=False, capture_output=True)
        command += ["--volume", f"{path}:{path}"]
    return name, [*command, IMAGE, *arguments]


def _shared(path):
    """The path itself, or, if it is still to be made, what it will be made in."""
    while not path.exists():
        path = path.parent
    return path


class _Container(subprocess.Popen):
    """A running container. Signals go to the process in it, not to the engine's client."""

    def __init__(self, name, command, stderr):
        super().__init__(command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=stderr,
                         text=True)
        self.name = name
        self.inner = None

    def inner_pid(self):
        if self.inner is None:
            found = subprocess.run([ENGINE, "inspect", "--format", "{{.State.Pid}}", self.name],
                                   capture_output=True, text=True, timeout=30, check=True)
            self.inner = int(found.stdout)
        return self.inner

    def send_signal(self, sig):
        os.kill(self.inner_pid(), sig)

    def kill(self):
        os.kill(self.inner_pid(), 9)


def pid(process):
    """Number of the server's process on this machine."""
    return process.inner_pid() if IMAGE else process.pid
