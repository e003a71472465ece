"""Jobs share a budget of memory: what passes it is refused, and what would together waits."""

import time

import pytest

from contract import Client
from shapes import noisy_sphere

SLOW = "?analysisIterations=1000"


@pytest.fixture(scope="module")
def scan():
    return noisy_sphere(20_000)


@pytest.fixture(scope="module")
def needed(client, scan):
    """What a job on the scan is estimated to need [bytes]."""
    answer = client.post("/v1/processes/analyze/validate" + SLOW, scan)
    return answer.json()["estimate"]["memoryBytes"]


def budget(bytes_):
    # Two large jobs at a time, where there are cores for it.
    return ("--max-memory-bytes", str(int(bytes_)), "--jobs", "2", "--max-small-job-points",
            "1000000")


def check_problem(problem, limit):
    assert problem["status"] == 422 and problem["code"] == "out-of-memory"
    assert problem["limit"] == limit < problem["estimate"]
    assert "memoryBytes" in problem["detail"] and "MiB" in problem["detail"]


def test_a_job_that_passes_the_budget_is_refused_at_once(start, scan, needed):
    limit = int(0.9 * needed)
    client = Client(start(*budget(limit)).url)
    assert client.get("/v1/info").json()["limits"]["memoryBytes"] == limit
    for wait in (None, 30):
        refused = client.execute("analyze", scan, SLOW, wait=wait)
        assert refused.status_code == 422
        check_problem(refused.json(), limit)
    assert client.get("/v1/jobs").json()["jobs"] == []
    foretold = client.post("/v1/processes/analyze/validate" + SLOW, scan).json()
    assert "too-large" in [warning["code"] for warning in foretold["warnings"]]
    client.run("denoise", noisy_sphere(500))


def test_jobs_that_would_pass_it_together_run_one_after_the_other(start, scan, needed):
    client = Client(start(*budget(1.5 * needed)).url)
    first, second = ("/v1/jobs/" + client.execute("analyze", scan, SLOW).json()["jobID"]
                     for _ in range(2))
    while client.get(first).json()["status"] != "running":
        time.sleep(0.02)
    end = time.monotonic() + 1.5
    while time.monotonic() < end:
        assert client.get(second).json()["status"] == "accepted"
        time.sleep(0.05)
    client.delete(first)
    end = time.monotonic() + 20
    while client.get(second).json()["status"] != "running":
        assert time.monotonic() < end, "the second was forgotten"
        time.sleep(0.02)


def test_a_job_that_was_accepted_under_a_larger_budget_fails_instead_of_waiting(start, scan, needed):
    server = start(*budget(1.5 * needed))
    client = Client(server.url)
    jobs = [client.execute("analyze", scan, SLOW).json()["jobID"] for _ in range(2)]
    assert server.terminate() == 0
    limit = int(0.9 * needed)
    client = Client(start(*budget(limit)).url)
    for job in jobs:
        end = client.finish(client.get("/v1/jobs/" + job).json())
        assert end["status"] == "failed"
        check_problem(end["exception"], limit)
