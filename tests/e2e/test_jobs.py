"""Jobs as resources: state, lists, waiting, dismissal."""

import time

import pytest

from contract import Client
from shapes import noisy_sphere

SLOW = "?analysisIterations=1000"  # far longer than any test waits


@pytest.fixture(scope="module")
def busy(tmp_path_factory):
    """A server of one worker that is occupied, with two jobs waiting behind."""
    from conftest import needs_program
    from server import Server
    needs_program()
    with Server(tmp_path_factory.mktemp("busy"), "--max-queued-jobs", "4") as server:
        client = Client(server.url)
        client.slow = [client.execute("analyze", noisy_sphere(20_000), SLOW).json()
                       for _ in range(3)]
        while client.get("/v1/jobs/" + client.slow[0]["jobID"]).json()["status"] != "running":
            time.sleep(0.05)
        yield client


def test_unfinished_jobs_say_so(busy):
    running, waiting = (busy.get("/v1/jobs/" + j["jobID"]) for j in busy.slow[:2])
    assert running.json()["status"] == "running" and "Retry-After" in running.headers
    assert waiting.json()["status"] == "accepted" and waiting.json()["queuePosition"] == 1
    answer = busy.get("/v1/jobs/" + busy.slow[0]["jobID"] + "/results")
    assert (answer.status_code, answer.json()["code"]) == (404, "result-not-ready")
    assert "Retry-After" in answer.headers


def test_progress_moves(busy):
    path = "/v1/jobs/" + busy.slow[0]["jobID"]
    end = time.time() + 30
    while not busy.get(path).json().get("phaseProgress"):
        assert time.time() < end, "no progress in 30 s"
        time.sleep(0.1)
    assert busy.get(path).json()["phase"]


def test_a_wait_that_is_too_short_gives_the_job(busy):
    answer = busy.execute("denoise", noisy_sphere(100), wait=1)
    assert answer.status_code == 201
    assert answer.json()["status"] == "accepted"
    start = time.time()
    path = answer.headers["Location"]
    assert busy.get(path, headers={"Prefer": "wait=1"}).json()["status"] == "accepted"
    assert 0.9 < time.time() - start < 5
    assert busy.delete(path).json()["status"] == "dismissed"


def test_lists_are_filtered_and_paged(busy):
    running = busy.get("/v1/jobs?status=running").json()["jobs"]
    assert [j["jobID"] for j in running] == [busy.slow[0]["jobID"]]
    page = busy.get("/v1/jobs?limit=2&processID=analyze").json()
    seen = [j["jobID"] for j in page["jobs"]]
    following = next(link["href"] for link in page["links"] if link["rel"] == "next")
    seen += [j["jobID"] for j in busy.get(following).json()["jobs"]]
    assert seen == [j["jobID"] for j in reversed(busy.slow)]
    assert busy.get("/v1/jobs?processID=denoise&status=running").json()["jobs"] == []
    for wrong in ("limit=0", "limit=x", "status=lost", "processID=melt", "cursor=x"):
        assert busy.get("/v1/jobs?" + wrong).status_code == 422, wrong


def test_the_queue_has_an_end(busy):
    extra = []
    while True:
        answer = busy.execute("denoise", noisy_sphere(100))
        if answer.status_code != 201:
            break
        extra.append(answer.headers["Location"])
    assert (answer.status_code, answer.json()["code"]) == (503, "queue-full")
    assert int(answer.headers["Retry-After"]) > 0
    for path in extra:
        busy.delete(path)


def test_a_shape_in_use_cannot_be_deleted(busy):
    shape = busy.get("/v1/jobs/" + busy.slow[0]["jobID"]).json()["shape"]
    answer = busy.delete("/v1/shapes/" + shape)
    assert (answer.status_code, answer.json()["code"]) == (409, "shape-in-use")


def test_dismissal_stops_a_running_job_within_a_second(busy):
    """The last one on this server: it ends the job that kept it busy."""
    busy.delete("/v1/jobs/" + busy.slow[2]["jobID"])
    path = "/v1/jobs/" + busy.slow[0]["jobID"]
    following = "/v1/jobs/" + busy.slow[1]["jobID"]
    start = time.time()
    assert busy.delete(path).json()["status"] == "dismissed"
    while busy.get(following).json()["status"] != "running":
        assert time.time() - start < 1.5, "the worker is still at the dismissed job"
        time.sleep(0.02)
    answer = busy.get(path)
    assert (answer.status_code, answer.json()["code"]) == (410, "job-dismissed")
    assert busy.delete(path).status_code == 410
    assert busy.delete(following).status_code == 200


def test_dismissal_of_a_finished_job_takes_its_results(client):
    path = client.run("denoise", noisy_sphere(200, seed=5))
    assert client.delete(path).json()["status"] == "dismissed"
    assert client.get(path + "/results/points").status_code == 410
    assert client.get(path + "/results").status_code == 410


def test_a_job_that_may_run_a_second_only(client):
    job = client.finish(client.execute("analyze", noisy_sphere(20_000), SLOW + "&maxSeconds=1").json())
    assert job["status"] == "failed"
    assert job["exception"]["code"] == "timed-out"
    answer = client.get("/v1/jobs/" + job["jobID"] + "/results")
    assert (answer.status_code, answer.json()["code"]) == (422, "timed-out")


def test_unknown_jobs(client):
    for path in ("", "/results", "/results/points"):
        answer = client.get("/v1/jobs/01890000-0000-7000-8000-000000000000" + path)
        assert answer.status_code in (404, 410)
        assert client.get("/v1/jobs/none" + path).status_code == 404
