"""A container that is stopped, killed, started again or replaced loses nothing."""

import time

import pytest

from contract import Client
from shapes import noisy_sphere, read_ply

JOBS = 10


def send(client):
    """Ten jobs that take a second or so each."""
    return [client.execute("denoise", noisy_sphere(20_000, seed=seed),
                           "?analysisIterations=5").json()["jobID"] for seed in range(JOBS)]


def wait_for_some(client):
    """Waits until some jobs are done and others are not."""
    while True:
        states = [job["status"] for job in client.get("/v1/jobs?limit=50").json()["jobs"]]
        if "successful" in states and "running" in states and "accepted" in states:
            return states.count("successful")
        assert states.count("successful") < JOBS, "they were too fast for this test"
        time.sleep(0.02)


def check_all(client, jobs, most_attempts):
    attempts = []
    for job_id in jobs:
        job = client.finish(client.get("/v1/jobs/" + job_id).json())
        assert job["status"] == "successful", job
        attempts.append(job["attempt"])
        points = client.get(f"/v1/jobs/{job_id}/results/points").content
        assert len(read_ply(points)) == 20_000
    assert max(attempts) <= most_attempts, attempts


@pytest.mark.parametrize("how", ["SIGTERM", "SIGKILL"])
def test_ten_jobs_survive_a_stop_and_a_start(run, how):
    server = run()
    client = Client(server.url)
    jobs = send(client)
    done = wait_for_some(client)
    if how == "SIGTERM":
        code, seconds = server.stop()
        assert code == 0 and seconds < 30
    else:
        server.kill()
        assert server.state()["ExitCode"] == 137
    server.start()
    check_all(client, jobs, most_attempts=1 if how == "SIGTERM" else 2)
    print(f"{how}: stopped after {done} of {JOBS} jobs, all ended well after the start")


def test_a_new_container_takes_the_volume_over(run):
    first = run()
    client = Client(first.url)
    jobs = send(client)
    wait_for_some(client)
    assert first.stop()[0] == 0
    first.remove()
    check_all(Client(run().url), jobs, most_attempts=1)
