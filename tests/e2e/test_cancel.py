"""A job that is stopped stops: at any stage, on a large shape, and when its time is over.

tests/bench/cancel.py does the same with millions of points and prints percentiles.
"""

import random
import re
import time

import pytest
import requests

from contract import Client
from shapes import noisy_sphere

POINTS = 150_000
LONGEST = 3.0  # seconds; the goal is one, and tests/bench/cancel.py measures it on a quiet machine


@pytest.fixture(scope="module")
def large():
    return noisy_sphere(POINTS, noise=0.002)


@pytest.fixture
def server(start, large):
    server = start("--jobs", "1")
    server.client = Client(server.url)
    server.shape = server.client.post("/v1/shapes", large).json()["id"]
    return server


def execute(server, process, **inputs):
    body = {"inputs": {"shape": server.shape, **inputs}}
    answer = server.client.post(f"/v1/processes/{process}/execution", json=body)
    assert answer.status_code == 201, answer.text
    return "/v1/jobs/" + answer.json()["jobID"]


def running(server):
    text = requests.get(server.admin_url + "/metrics", timeout=30).text
    return int(re.search(r"^lpf_jobs_running (\d+)", text, re.MULTILINE)[1])


def seconds_until_free(server):
    start = time.monotonic()
    while running(server) > 0:
        assert time.monotonic() - start < 30, "the worker never came back"
        time.sleep(0.01)
    return time.monotonic() - start


@pytest.mark.parametrize("process, inputs", [
    ("denoise", {}), ("denoise", {"format": "drc", "outliers": "remove"}),
    ("denoise", {"normals": "estimate", "format": "ply-ascii", "analysisIterations": 1}),
    ("resample", {"duplicates": "remove"}), ("analyze", {})])
def test_a_dismissed_job_stops_within_a_second(server, process, inputs):
    dice = random.Random(process + str(inputs))
    for delay in (0, dice.uniform(0, 0.3), dice.uniform(0.3, 1.5), dice.uniform(1.5, 5)):
        path = execute(server, process, **inputs)
        time.sleep(delay)
        job = server.client.get(path).json()
        assert server.client.delete(path).json()["status"] == "dismissed"
        seconds = seconds_until_free(server)
        assert seconds < LONGEST, f"{seconds:.1f} s in phase {job.get('phase')} after {delay:.1f} s"


def test_a_job_ends_when_its_time_is_over(server):
    for process in ("analyze", "resample"):
        path = execute(server, process, maxSeconds=1, analysisIterations=1000)
        start = time.monotonic()
        job = server.client.finish(server.client.get(path).json())
        assert job["status"] == "failed" and job["exception"]["code"] == "timed-out", job
        assert time.monotonic() - start < 1 + 2 * LONGEST


def test_progress_moves_every_second(server):
    path = execute(server, "denoise", outliers="remove", normals="estimate")
    seen, last, longest = None, time.monotonic(), (0, None)
    end = last + 20
    while time.monotonic() < end:
        job = server.client.get(path).json()
        if job["status"] not in ("accepted", "running"):
            break
        now = (job.get("phase"), job["progress"], str(job.get("phaseProgress")))
        if now != seen:
            longest = max(longest, (time.monotonic() - last, str(seen)))
            seen, last = now, time.monotonic()
        time.sleep(0.05)
    assert longest[0] < LONGEST, f"nothing moved for {longest[0]:.1f} s after {longest[1]}"
    server.client.delete(path)
