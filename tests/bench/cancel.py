#!/usr/bin/env python3
"""Measures how long a job goes on after it was dismissed.

    cancel.py lpf-server [JOBS] [POINTS]

Starts the server on an empty folder, submits JOBS jobs (50), every other one on POINTS points
(5 million), dismisses each at a random moment between its acceptance and about its end, and prints
how long it took from the DELETE until the worker was free, by phase. Exits with 1 if the 99th
percentile is a second or more.
"""

import collections
import json
import math
import os
import random
import struct
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request

PROCESSES = ("denoise", "resample", "analyze")
OPTIONS = ("", "&format=drc", "&format=ply-ascii&normals=estimate", "&outliers=remove",
           "&normals=estimate&duplicates=remove")
GOAL = 1.0


def noisy_sphere(path, count):
    """A sphere of so many points with colours, written piece by piece."""
    dice = random.Random(count).random
    row = struct.Struct("<3f3B")
    with open(path, "wb") as file:
        file.write((f"ply\nformat binary_little_endian 1.0\nelement vertex {count}\n"
                    "property float x\nproperty float y\nproperty float z\nproperty uchar red\n"
                    "property uchar green\nproperty uchar blue\nend_header\n").encode())
        piece = []
        for i in range(count):
            z, angle = 2 * dice() - 1, 2 * math.pi * dice()
            radius = 1 + 0.004 * (dice() - 0.5)
            flat = math.sqrt(1 - z * z) * radius
            piece.append(row.pack(flat * math.cos(angle), flat * math.sin(angle), radius * z,
                                  i % 256, 7, 255))
            if len(piece) == 100_000:
                file.write(b"".join(piece))
                piece = []
        file.write(b"".join(piece))


class Server:
    def __init__(self, binary, folder):
        self.process = subprocess.Popen(
            [binary, "--port", "0", "--admin-port", "0", "--data-dir", folder, "--jobs", "1",
             "--disk-floor-bytes", "0", "--disk-floor-percent", "0", "--log-level", "warn"],
            stdout=subprocess.PIPE, text=True)
        ready = json.loads(self.process.stdout.readline())
        self.url = f"http://127.0.0.1:{ready['port']}"
        self.admin = f"http://127.0.0.1:{ready['adminPort']}"

    def request(self, method, path, data=None):
        request = urllib.request.Request(self.url + path, data=data, method=method, headers={
            "Content-Type": "application/octet-stream" if "inputs" not in str(data)[:20]
            else "application/json"})
        with urllib.request.urlopen(request, timeout=600) as answer:
            return json.loads(answer.read())

    def metric(self, name):
        text = urllib.request.urlopen(self.admin + "/metrics", timeout=60).read().decode()
        line = next((x for x in text.splitlines() if x.startswith(name + " ")), None)
        return float(line.split()[1]) if line else 0.0

    def stop(self):
        self.process.terminate()
        self.process.wait(timeout=60)


def execute(server, shape, process, options):
    inputs = {"shape": shape}
    for pair in filter(None, options.split("&")):
        name, _, value = pair.partition("=")
        inputs[name] = value
    body = json.dumps({"inputs": inputs}).encode()
    return server.request("POST", f"/v1/processes/{process}/execution", body)["jobID"]


def dismiss_after(server, job, delay):
    """Returns the phase that was cut short and the seconds until the worker was free."""
    end = time.monotonic() + delay
    state = server.request("GET", f"/v1/jobs/{job}")
    while time.monotonic() < end and state["status"] in ("accepted", "running"):
        time.sleep(min(0.05, max(0.0, end - time.monotonic())))
        state = server.request("GET", f"/v1/jobs/{job}")
    if state["status"] not in ("accepted", "running"):
        return None, 0.0
    start = time.monotonic()
    server.request("DELETE", f"/v1/jobs/{job}")
    while server.metric("lpf_jobs_running") > 0:
        time.sleep(0.01)
    return state.get("phase", state["status"]), time.monotonic() - start


def longest(server, shape, process, options, limit):
    """Seconds that the job takes when nobody stops it, or the limit."""
    job = execute(server, shape, process, options)
    start = time.monotonic()
    state = server.request("GET", f"/v1/jobs/{job}")
    while state["status"] in ("accepted", "running") and time.monotonic() - start < limit:
        time.sleep(0.1)
        state = server.request("GET", f"/v1/jobs/{job}")
    seconds = time.monotonic() - start
    if state["status"] in ("accepted", "running"):
        # A job that works for a day is stopped somewhere in the first part of it.
        share = max(state.get("progress", 0), 1) / 100
        server.request("DELETE", f"/v1/jobs/{job}")
        while server.metric("lpf_jobs_running") > 0:
            time.sleep(0.01)
        return min(seconds / share, 3 * limit)
    return seconds


def percentile(values, share):
    values = sorted(values)
    return values[min(len(values) - 1, math.ceil(share * len(values)) - 1)]


def main():
    binary = sys.argv[1]
    jobs = int(sys.argv[2]) if len(sys.argv) > 2 else 50
    points = int(sys.argv[3]) if len(sys.argv) > 3 else 5_000_000
    limit = float(os.environ.get("LPF_BENCH_SECONDS", "60"))  # of one job, before it is stopped
    dice = random.Random(7)
    latencies, phases = [], collections.defaultdict(list)
    with tempfile.TemporaryDirectory() as folder:
        server = Server(binary, folder)
        try:
            shapes = []
            for count in (points, 200_000):
                path = f"{folder}/{count}.ply"
                noisy_sphere(path, count)
                with open(path, "rb") as file:
                    shapes.append(server.request("POST", "/v1/shapes", file.read())["id"])
            seconds = [longest(server, shape, "denoise", "", limit) for shape in shapes]
            print(f"a job takes about {seconds[0]:.0f} s on {points} points, {seconds[1]:.1f} s on "
                  "200000", flush=True)
            while len(latencies) < jobs:
                number = len(latencies) % 2
                process, options = dice.choice(PROCESSES), dice.choice(OPTIONS)
                if process == "analyze":
                    options = options.replace("&normals=estimate", "").replace("&format=ply-ascii",
                                                                              "").replace(
                                                                                  "&format=drc", "")
                # Stages at the beginning are short: half of the moments are among them.
                delay = dice.uniform(0, seconds[number] * dice.choice((0.15, 1.0)))
                phase, latency = dismiss_after(
                    server, execute(server, shapes[number], process, options), delay)
                if phase is None:
                    continue  # it was done before
                latencies.append(latency)
                phases[phase].append(latency)
                print(f"{process}{options} {delay:6.2f} s {phase:12s} {latency:.3f} s", flush=True)
        finally:
            server.stop()
    for phase, values in sorted(phases.items()):
        print(f"{phase:12s} {len(values):3d} jobs, at most {max(values):.3f} s")
    p99 = percentile(latencies, 0.99)
    print(f"{len(latencies)} dismissals: p50 {percentile(latencies, 0.5):.3f} s, p99 {p99:.3f} s, "
          f"max {max(latencies):.3f} s")
    return 0 if p99 < GOAL else 1


if __name__ == "__main__":
    sys.exit(main())
