"""A container of the image under test (LPF_IMAGE), run as docs/deploy.md says, by LPF_ENGINE."""

import json
import os
import socket
import subprocess
import time
import uuid

import requests

IMAGE = os.environ["LPF_IMAGE"]
ENGINE = os.environ.get("LPF_ENGINE", "podman")
HARDENED = ["--read-only", "--tmpfs", "/tmp", "--cap-drop", "ALL",
            "--security-opt", "no-new-privileges", "--pids-limit", "512"]


def engine(*arguments, check=True):
    return subprocess.run([ENGINE, *arguments], capture_output=True, text=True, timeout=120,
                          check=check)


def free_ports(count):
    probes = [socket.create_server(("127.0.0.1", 0)) for _ in range(count)]
    ports = [probe.getsockname()[1] for probe in probes]
    for probe in probes:
        probe.close()
    return ports


class Volume:
    """A named volume for the data folder."""

    def __init__(self):
        self.name = "lpf-test-" + uuid.uuid4().hex[:12]
        engine("volume", "create", self.name)

    def remove(self):
        engine("volume", "rm", "--force", self.name, check=False)


class Container:
    """A running container on this machine's network."""

    def __init__(self, volume, *options):
        """`options` are further ones of the engine's `run`."""
        self.name = "lpf-test-" + uuid.uuid4().hex[:12]
        port, admin = free_ports(2)
        self.url = f"http://127.0.0.1:{port}"
        self.admin_url = f"http://127.0.0.1:{admin}"
        engine("run", "--detach", "--name", self.name, "--network", "host",
               "--env", f"LPF_PORT={port}", "--env", f"LPF_ADMIN_PORT={admin}",
               "--env", "LPF_DISK_FLOOR_BYTES=0", "--env", "LPF_DISK_FLOOR_PERCENT=0",
               "--volume", f"{volume.name}:/var/lib/lpf", *HARDENED, *options, IMAGE)
        self.wait_until_ready()

    def wait_until_ready(self):
        deadline = time.monotonic() + 60
        while True:
            try:
                if requests.get(self.admin_url + "/readyz", timeout=5).status_code == 200:
                    return
            except requests.RequestException:
                pass
            assert time.monotonic() < deadline and self.state()["Running"], self.log()
            time.sleep(0.05)

    def state(self):
        return json.loads(engine("inspect", "--format", "{{json .State}}", self.name).stdout)

    def pid(self):
        return self.state()["Pid"]

    def log(self):
        ended = engine("logs", self.name)
        return ended.stdout + ended.stderr

    def run(self, *command):
        """Runs a command within."""
        return engine("exec", self.name, *command, check=False)

    def stop(self):
        """An orderly stop, as the engine does it. Returns the exit code and the seconds."""
        begin = time.monotonic()
        engine("stop", "--time", "40", self.name)
        return self.state()["ExitCode"], time.monotonic() - begin

    def kill(self):
        engine("kill", "--signal", "KILL", self.name)
        while self.state()["Running"]:
            time.sleep(0.05)

    def start(self):
        """Starts the same container again."""
        engine("start", self.name)
        self.wait_until_ready()

    def remove(self):
        engine("rm", "--force", "--time", "5", self.name, check=False)


class MemoryWatch:
    """What the processes of a container hold at most, apart from what the kernel may drop."""

    def __init__(self, container):
        self.folder, self.version = _memory_group(container.pid())
        self.most = 0

    def look(self):
        with open(self.folder + "/memory.stat", encoding="ascii") as file:
            figures = {name: int(value) for name, value in (line.split() for line in file)}
        names = ("anon", "shmem") if self.version == 2 else ("rss", "shmem")
        self.most = max(self.most, sum(figures.get(name, 0) for name in names))

    def kills(self):
        """Processes that the kernel has killed for the limit."""
        name = "memory.events" if self.version == 2 else "memory.oom_control"
        with open(f"{self.folder}/{name}", encoding="ascii") as file:
            return {key: int(value) for key, value in (line.split() for line in file)}["oom_kill"]


def _memory_group(pid):
    with open(f"/proc/{pid}/cgroup", encoding="ascii") as file:
        groups = [line.rstrip("\n").split(":", 2) for line in file]
    for _, controllers, path in groups:
        if "memory" in controllers.split(","):
            return "/sys/fs/cgroup/memory" + path, 1
    return "/sys/fs/cgroup" + next(path for _, names, path in groups if not names), 2
