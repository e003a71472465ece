#!/usr/bin/env python3
"""What validate foretells of time and memory against what jobs take.

    LPF_SERVER_BINARY=build/release/bin/lpf-server tests/bench/estimates.py [POINTS...]

For each process and size a server of its own is asked, then does the job. Memory is the growth of its
peak (VmHWM) over the job. Prints a table; exit code 1 if a time is off by more than a factor of 2, or
a memory is foretold too low by more than 20 %.
"""

import json
import math
import os
import random
import re
import struct
import subprocess
import sys
import tempfile

import requests


def wave(points):
    """A noisy wavy surface with colours."""
    dice = random.Random(points)
    row = struct.Struct("<fffBBB")
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {points}\n"
            "property float x\nproperty float y\nproperty float z\nproperty uchar red\n"
            "property uchar green\nproperty uchar blue\nend_header\n")
    body = bytearray()
    for _ in range(points):
        x, y = dice.uniform(-1, 1), dice.uniform(-1, 1)
        z = 0.1 * math.sin(12 * x) * math.cos(9 * y) + dice.gauss(0, 0.003)
        body += row.pack(x, y, z, 10, 20, 30)
    return head.encode() + bytes(body)


def mesh(side):
    """The same surface as triangles over a grid."""
    rows = [(2 * i / side - 1, 2 * j / side - 1) for j in range(side) for i in range(side)]
    body = b"".join(struct.pack("<fff", x, y, 0.1 * math.sin(12 * x) * math.cos(9 * y))
                    for x, y in rows)
    faces = []
    for j in range(side - 1):
        for i in range(side - 1):
            a = j * side + i
            faces += [struct.pack("<B3I", 3, a, a + 1, a + side),
                      struct.pack("<B3I", 3, a + 1, a + side + 1, a + side)]
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {len(rows)}\n"
            "property float x\nproperty float y\nproperty float z\n"
            f"element face {len(faces)}\nproperty list uchar uint vertex_indices\nend_header\n")
    return head.encode() + body + b"".join(faces)


class Server:
    def __init__(self, folder):
        self.process = subprocess.Popen(
            [os.environ["LPF_SERVER_BINARY"], "--port", "0", "--admin-port", "0", "--data-dir",
             folder, "--disk-floor-bytes", "0", "--disk-floor-percent", "0", "--log-level", "warn"],
            stdout=subprocess.PIPE, text=True)
        self.url = f"http://127.0.0.1:{json.loads(self.process.stdout.readline())['port']}"

    def memory(self, name):
        with open(f"/proc/{self.process.pid}/status", encoding="ascii") as status:
            return int(re.search(rf"{name}:\s+(\d+)", status.read()).group(1)) * 1024

    def cpu_seconds(self):
        with open(f"/proc/{self.process.pid}/stat", encoding="ascii") as stat:
            fields = stat.read().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def forget_peak(self):
        with open(f"/proc/{self.process.pid}/clear_refs", "w", encoding="ascii") as file:
            file.write("5")

    def stop(self):
        self.process.kill()
        self.process.wait()


def foretell(process, data):
    with tempfile.TemporaryDirectory() as folder:
        server = Server(folder)
        try:
            answer = requests.post(f"{server.url}/v1/processes/{process}/validate", data, timeout=600)
            answer.raise_for_status()
            return answer.json()["estimate"]
        finally:
            server.stop()


def measure(process, data):
    """Seconds, processor seconds and bytes that a job takes."""
    with tempfile.TemporaryDirectory() as folder:
        server = Server(folder)
        try:
            shape = requests.post(f"{server.url}/v1/shapes", data, timeout=600).json()["id"]
            server.forget_peak()
            before, cpu = server.memory("VmRSS"), server.cpu_seconds()
            job = requests.post(f"{server.url}/v1/processes/{process}/execution", timeout=600,
                                json={"inputs": {"shape": shape}}).json()
            path = f"{server.url}/v1/jobs/{job['jobID']}"
            while job["status"] in ("accepted", "running"):
                job = requests.get(path, headers={"Prefer": "wait=30"}, timeout=60).json()
            assert job["status"] == "successful", job
            seconds = requests.get(path + "/results/report", timeout=60).json()["seconds"]
            return seconds, server.cpu_seconds() - cpu, server.memory("VmHWM") - before
        finally:
            server.stop()


def main():
    sizes = [int(size) for size in sys.argv[1:]] or [10_000, 100_000, 1_000_000]
    shapes = [(f"{size} points", wave(size)) for size in sizes] + [("mesh 160 x 160", mesh(160))]
    print("| shape | process | s foretold | s taken | CPU s / threads | MB foretold | MB taken |")
    print("|---|---|---|---|---|---|---|")
    wrong = 0
    for name, data in shapes:
        for process in ("denoise", "resample", "analyze"):
            told = foretell(process, data)
            seconds, cpu, memory = measure(process, data)
            # On a busy machine the processor's time is nearer to what the job takes by itself.
            alone = min(seconds, max(cpu / told["threads"], 0.01))
            factor = told["seconds"] / alone
            wrong += not 0.5 <= factor <= 2 or told["memoryBytes"] < 0.8 * memory
            print(f"| {name} | {process} | {told['seconds']:.2f} | {seconds:.2f} | "
                  f"{cpu / told['threads']:.2f} | {told['memoryBytes'] / 1e6:.0f} | "
                  f"{memory / 1e6:.0f} |", flush=True)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
