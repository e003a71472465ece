"""Whatever was acknowledged survives the end of the server, however it ends."""

import random
import threading
import time

import pytest
import requests

import program
from contract import Client
from shapes import noisy_sphere, read_ply

SLOW = "?analysisIterations=1000"


def end(server, how):
    if how == "SIGTERM":
        assert server.terminate() == 0
    else:
        server.kill()


@pytest.mark.parametrize("how", ["SIGTERM", "SIGKILL"])
def test_finished_jobs_stay_and_waiting_ones_run(start, how):
    first = start()
    client = Client(first.url)
    done = client.run("denoise", noisy_sphere(300))
    points = client.get(done + "/results/points").content
    running = client.execute("analyze", noisy_sphere(20_000), SLOW).json()
    waiting = client.execute("denoise", noisy_sphere(400, seed=2)).json()
    while client.get("/v1/jobs/" + running["jobID"]).json()["status"] != "running":
        time.sleep(0.05)
    end(first, how)

    client = Client(start().url)
    assert client.get(done + "/results/points").content == points
    again = client.get("/v1/jobs/" + running["jobID"]).json()
    assert again["status"] in ("accepted", "running")
    while again["status"] != "running":
        again = client.get("/v1/jobs/" + running["jobID"]).json()
    assert again["attempt"] == (1 if how == "SIGTERM" else 2)
    client.delete("/v1/jobs/" + running["jobID"])
    job = client.finish(client.get("/v1/jobs/" + waiting["jobID"]).json())
    assert job["status"] == "successful"
    assert len(read_ply(client.get(f"/v1/jobs/{job['jobID']}/results/points").content)) == 400


def test_a_job_that_ends_its_server_three_times_fails(start):
    server = start()
    client = Client(server.url)
    job = client.execute("analyze", noisy_sphere(20_000), SLOW).json()
    path = "/v1/jobs/" + job["jobID"]
    for _ in range(3):
        while client.get(path).json()["status"] != "running":
            time.sleep(0.05)
        server.kill()
        server = start()
        client = Client(server.url)
    job = client.get(path).json()
    assert job["status"] == "failed" and job["exception"]["code"] == "worker-lost"


def test_every_acknowledged_job_ends_once_whenever_the_server_is_killed(start):
    """Kills at random moments while jobs are sent."""
    dice = random.Random(7)
    acknowledged = []
    for _ in range(3):
        server = start("--max-job-attempts", "10")
        killer = threading.Timer(dice.uniform(0.05, 0.6), server.kill)
        killer.start()
        try:
            while True:
                shape = noisy_sphere(150, seed=dice.randrange(1000))
                answer = requests.post(server.url + "/v1/processes/denoise/execution", data=shape,
                                       timeout=30)
                if answer.status_code == 201:
                    acknowledged.append(answer.json()["jobID"])
        except requests.RequestException:
            killer.join()
    client = Client(start("--max-job-attempts", "10").url)
    assert acknowledged
    for job_id in acknowledged:
        job = client.finish(client.get("/v1/jobs/" + job_id).json())
        assert job["status"] == "successful"
        points = client.get(f"/v1/jobs/{job_id}/results/points").content
        assert len(read_ply(points)) == 150


def test_a_stop_ends_within_seconds_and_refuses_nothing_half(start):
    server = start()
    client = Client(server.url)
    client.execute("analyze", noisy_sphere(20_000), SLOW)
    begin = time.time()
    assert server.terminate() == 0
    assert time.time() - begin < 15
    with pytest.raises(requests.ConnectionError):
        requests.get(server.url + "/healthz", timeout=5)


def test_two_servers_never_share_a_folder(start, tmp_path):
    start()
    second = program.run(["--port", "0", "--admin-port", "0", "--data-dir",
                          str(tmp_path / "data")])
    assert second.returncode == 1
    assert "in use by another server" in second.stderr


def test_health_check_of_the_binary(start):
    server = start()
    port = server.admin_url.rsplit(":", 1)[1]
    question = ["--healthcheck", "--host", "127.0.0.1", "--admin-port", port]
    assert program.run(question).returncode == 0
    server.kill()
    assert program.run(question).returncode == 1
