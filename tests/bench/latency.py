#!/usr/bin/env python3
"""How fast the server answers while slow clients and jobs keep it busy.

Starts the server, lets many clients upload slowly, others follow a job's events, keeps every core
at work with denoising jobs, and measures GET /healthz and GET /v1/jobs/{id} all the while.
Exits with 1 if a goal is missed.

    tests/bench/latency.py build/release/bin/lpf-server --seconds 30
"""

import argparse
import http.client
import json
import math
import os
import random
import resource
import selectors
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time

GOALS = {"/healthz": 50.0, "GET job": 100.0}  # 99th percentile, milliseconds


def noisy_sphere(count):
    dice = random.Random(1)
    rows = bytearray()
    for _ in range(count):
        z, angle = dice.uniform(-1, 1), dice.uniform(0, 2 * math.pi)
        radius = 1 + dice.gauss(0, 0.01)
        flat = math.sqrt(1 - z * z)
        rows += struct.pack("<fff", radius * flat * math.cos(angle),
                            radius * flat * math.sin(angle), radius * z)
    head = (f"ply\nformat binary_little_endian 1.0\nelement vertex {count}\n"
            "property float x\nproperty float y\nproperty float z\nend_header\n")
    return head.encode() + bytes(rows)


class Server:
    def __init__(self, binary, folder, flags):
        self.process = subprocess.Popen(
            [binary, "--port", "0", "--admin-port", "0", "--data-dir", folder,
             "--disk-floor-bytes", "0", "--disk-floor-percent", "0", "--log-level", "error",
             "--max-connections-per-client", "0", "--max-event-streams-per-client", "0", *flags],
            stdout=subprocess.PIPE, text=True)
        self.port = json.loads(self.process.stdout.readline())["port"]

    def request(self, method, path, body=None):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        try:
            connection.request(method, path, body)
            answer = connection.getresponse()
            return answer.status, answer.read()
        finally:
            connection.close()

    def connect(self):
        return socket.create_connection(("127.0.0.1", self.port))


class Uploads:
    """Clients that send 100 MB at about 2 KiB/s each."""

    def __init__(self, server, count):
        self.clients = [server.connect() for _ in range(count)]
        for client in self.clients:
            client.sendall(b"POST /v1/shapes HTTP/1.1\r\nHost: h\r\n"
                           b"Content-Length: 100000000\r\n\r\n")

    def trickle(self):
        for client in self.clients:
            client.sendall(b"p" * 512)

    def refused(self):
        """Clients that have been answered, where none should be."""
        count = 0
        for client in self.clients:
            client.setblocking(False)
            try:
                count += bool(client.recv(1)) or 1
            except BlockingIOError:
                pass
            client.setblocking(True)
        return count


class Streams:
    """Clients that follow the events of a job, and read all that comes."""

    def __init__(self, server, path, count):
        self.selector = selectors.DefaultSelector()
        self.received = {}
        for _ in range(count):
            client = server.connect()
            client.sendall(f"GET {path}/events HTTP/1.1\r\nHost: h\r\n\r\n".encode())
            client.setblocking(False)
            self.selector.register(client, selectors.EVENT_READ)
            self.received[client] = b""

    def read(self):
        for key, _ in self.selector.select(0):
            piece = key.fileobj.recv(65536)
            self.received[key.fileobj] += piece
            if not piece:
                self.selector.unregister(key.fileobj)

    def alive(self):
        """Streams that have told something, and have not ended."""
        return sum(b"event:" in self.received[key.fileobj]
                   for key in self.selector.get_map().values())


def keep_moving(uploads, streams, over):
    while not over.wait(0.25):
        uploads.trickle()
        streams.read()


def measure(server, targets, seconds):
    """Milliseconds of each request, on connections of their own."""
    times = {name: [] for name in targets}
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        for name, path in targets.items():
            start = time.perf_counter()
            status, _ = server.request("GET", path)
            times[name].append((time.perf_counter() - start) * 1000)
            assert status == 200, (path, status)
        time.sleep(0.01)
    return times


def percentile(values, share):
    ordered = sorted(values)
    return ordered[min(len(ordered) - 1, int(share * len(ordered)))]


def report(times):
    good = True
    print(f"{'':10} {'requests':>8} {'p50':>8} {'p99':>8} {'max':>8}  ms")
    for name, values in times.items():
        p99 = percentile(values, 0.99)
        good = good and p99 < GOALS[name]
        print(f"{name:10} {len(values):8} {percentile(values, 0.5):8.2f} {p99:8.2f} "
              f"{max(values):8.2f}  goal: p99 < {GOALS[name]:.0f}")
    return good


def start_jobs(server, count, points):
    shape = noisy_sphere(points)
    query = "?analysisIterations=1000&maxSeconds=600"
    paths = []
    for _ in range(count):
        status, body = server.request("POST", "/v1/processes/denoise/execution" + query, shape)
        assert status == 201, body
        paths.append("/v1/jobs/" + json.loads(body)["jobID"])
    while json.loads(server.request("GET", paths[0])[1])["status"] != "running":
        time.sleep(0.1)
    return paths


def bench(server, options):
    job = start_jobs(server, 4, options.points)[0]
    uploads = Uploads(server, options.uploads)
    streams = Streams(server, job, options.streams)
    over = threading.Event()
    mover = threading.Thread(target=keep_moving, args=(uploads, streams, over))
    mover.start()
    time.sleep(2)
    before = os.times().elapsed, cpu_seconds(server)
    times = measure(server, {"/healthz": "/healthz", "GET job": job}, options.seconds)
    elapsed, used = os.times().elapsed - before[0], cpu_seconds(server) - before[1]
    over.set()
    mover.join()
    print(f"{options.uploads} slow uploads ({uploads.refused()} refused), {options.streams} event "
          f"streams ({streams.alive()} alive), server on {used / elapsed:.1f} of "
          f"{os.cpu_count()} cores, load average {os.getloadavg()[0]:.1f}")
    return report(times)


def cpu_seconds(server):
    with open(f"/proc/{server.process.pid}/stat", encoding="ascii") as file:
        fields = file.read().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("binary")
    parser.add_argument("--seconds", type=float, default=30)
    parser.add_argument("--uploads", type=int, default=64)
    parser.add_argument("--streams", type=int, default=32)
    parser.add_argument("--points", type=int, default=200_000)
    parser.add_argument("flags", nargs="*", help="further flags of the server, after --")
    options = parser.parse_args()
    resource.setrlimit(resource.RLIMIT_NOFILE, (resource.getrlimit(resource.RLIMIT_NOFILE)[1],) * 2)
    with tempfile.TemporaryDirectory() as folder:
        server = Server(options.binary, folder, options.flags)
        try:
            good = bench(server, options)
        finally:
            server.process.kill()
            server.process.wait()
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
