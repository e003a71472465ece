"""512 MB and one core: large jobs are done or refused, and the kernel never has to kill anything."""

import threading
import time

import pytest
import requests

from container import MemoryWatch
from contract import Client
from shapes import noisy_sphere

LIMIT = 512 << 20


@pytest.fixture(scope="module")
def million():
    return noisy_sphere(1_000_000, noise=0.003)


class Small:
    """A container with little memory, watched while it works."""

    def __init__(self, server):
        self.server = server
        self.client = Client(server.url)
        self.pid = server.pid()
        self.watch = MemoryWatch(server)
        self.over = threading.Event()
        self.thread = threading.Thread(target=self.look)
        self.thread.start()

    def look(self):
        while not self.over.wait(0.02):
            self.watch.look()

    def end(self):
        """Nothing was killed, and the process is the one that was started."""
        self.over.set()
        self.thread.join()
        assert self.watch.kills() == 0
        assert self.server.pid() == self.pid
        assert self.watch.most < LIMIT
        print(f"at most {self.watch.most >> 20} MiB of {LIMIT >> 20}")

    def done_or_refused(self, process, data, query=""):
        answer = self.client.execute(process, data, query)
        if answer.status_code == 201:
            job = self.client.finish(answer.json())
            assert job["status"] == "successful", job
            return "done"
        check_refusal(answer, self.client)
        return "refused"


def check_refusal(answer, client):
    assert answer.status_code == 422, answer.text
    problem = answer.json()
    assert problem["code"] == "out-of-memory"
    assert problem["limit"] == client.get("/v1/info").json()["limits"]["memoryBytes"] < LIMIT
    assert problem["estimate"] > problem["limit"]
    assert f"{problem['limit'] >> 20} MiB" in problem["detail"]


@pytest.fixture
def small(run):
    small = Small(run("--memory", str(LIMIT), "--memory-swap", str(LIMIT), "--cpus", "1"))
    yield small
    small.over.set()


def test_the_limits_of_the_container_are_known(small):
    info = small.client.get("/v1/info").json()
    assert info["queue"]["workers"] * info["queue"]["threadsPerJob"] == 1
    assert LIMIT // 4 <= info["limits"]["memoryBytes"] <= LIMIT * 3 // 4
    small.end()


def test_a_million_points(small, million):
    for process, query in (("denoise", ""), ("denoise", "?outliers=remove&normals=estimate"),
                           ("denoise", "?format=drc"), ("resample", ""), ("analyze", "")):
        begin = time.monotonic()
        end = small.done_or_refused(process, million, query)
        print(f"{process}{query} of 1 000 000 points: {end} after {time.monotonic() - begin:.1f} s,",
              f"at most {small.watch.most >> 20} MiB so far")
    small.end()


def test_what_never_fits_is_refused_at_once(small, million):
    shape = small.client.post("/v1/shapes", million).json()["id"]
    begin = time.monotonic()
    answer = small.client.post("/v1/processes/resample/execution",
                               json={"inputs": {"shape": shape, "factor": 15}})
    check_refusal(answer, small.client)
    assert time.monotonic() - begin < 10
    small.client.run("denoise", noisy_sphere(2000))  # the server lives
    small.end()


def test_questions_about_large_shapes_while_a_job_runs(small, million):
    """Decoding within requests has memory of its own."""
    shape = small.client.post("/v1/shapes", million).json()["id"]
    body = {"inputs": {"shape": shape}}
    job = small.client.post("/v1/processes/denoise/execution", json=body).json()
    faults = []

    def ask():
        for _ in range(3):
            answer = requests.post(small.server.url + "/v1/processes/denoise/validate", json=body,
                                   timeout=200)
            if answer.status_code != 200:
                faults.append(answer.text)

    askers = [threading.Thread(target=ask) for _ in range(4)]
    for asker in askers:
        asker.start()
    for asker in askers:
        asker.join()
    if "jobID" in job:
        assert small.client.finish(job)["status"] == "successful"
    assert faults == []
    small.end()
