"""Requests that are sent again, and jobs that are tried again."""

import threading
import time
import uuid

import pytest
import requests

from contract import Client
from shapes import noisy_sphere

SLOW = "?analysisIterations=1000"


def keyed(key=None):
    return {"Idempotency-Key": key or str(uuid.uuid4())}


def form(data, **fields):
    files = {"file": ("scan.ply", data)}
    files.update({name: (None, value) for name, value in fields.items()})
    return files


def test_the_same_request_makes_one_job(client):
    headers, shape = keyed(), noisy_sphere(200, seed=31)
    first = client.execute("denoise", shape, "?atoms=4&lambda=0.1", headers=headers)
    second = client.execute("denoise", shape, "?lambda=0.1&atoms=4", headers=headers)
    assert (first.status_code, second.status_code) == (201, 201)
    assert first.json()["jobID"] == second.json()["jobID"]
    assert first.headers["Location"] == second.headers["Location"]
    assert "Idempotency-Replayed" not in first.headers
    assert second.headers["Idempotency-Replayed"] == "true"


def test_another_request_needs_another_key(client):
    headers, shape = keyed(), noisy_sphere(200, seed=32)
    first = client.execute("denoise", shape, headers=headers).json()["jobID"]
    for process, data, query in [("denoise", shape, "?atoms=4"), ("analyze", shape, ""),
                                 ("denoise", noisy_sphere(200, seed=33), "")]:
        answer = client.execute(process, data, query, headers=headers)
        assert (answer.status_code, answer.json()["code"]) == (422, "idempotency-mismatch")
        assert first in answer.json()["detail"]
    assert client.execute("denoise", shape, headers=keyed()).json()["jobID"] != first


def test_forms_and_json_bodies_count_as_well(client):
    shape, headers = noisy_sphere(200, seed=34), keyed()
    first = client.execute("denoise", None, headers=headers, files=form(shape, atoms="4"))
    again = client.execute("denoise", None, headers=headers, files=form(shape, atoms="4"))
    assert first.json()["jobID"] == again.json()["jobID"]  # although the boundary is another
    other = client.execute("denoise", None, headers=headers, files=form(shape, atoms="5"))
    assert other.json()["code"] == "idempotency-mismatch"

    headers = keyed()
    body = {"inputs": {"shape": client.post("/v1/shapes", shape).json()["id"]}}
    jobs = [client.post("/v1/processes/analyze/execution", json=body, headers=headers)
            for _ in range(2)]
    assert jobs[0].json()["jobID"] == jobs[1].json()["jobID"]


def test_a_request_that_failed_is_not_remembered(client):
    headers = keyed()
    assert client.execute("denoise", b"ply\n", headers=headers).status_code == 422
    assert client.execute("denoise", noisy_sphere(100), headers=headers).status_code == 201


def test_a_replay_waits_like_the_first(client):
    headers, shape = keyed(), noisy_sphere(200, seed=35)
    first = client.execute("denoise", shape, wait=30, headers=headers)
    again = client.execute("denoise", shape, wait=30, headers=headers)
    assert (first.status_code, again.status_code) == (200, 200)
    assert first.content == again.content
    assert again.headers["Idempotency-Replayed"] == "true"


@pytest.mark.parametrize("key", ["", '""', "a" * 256, "a\tb"])
def test_keys_that_are_none(client, key):
    answer = client.execute("denoise", noisy_sphere(100), headers={"Idempotency-Key": key})
    assert (answer.status_code, answer.json()["code"]) == (400, "malformed-request")


def test_while_the_first_is_in_flight_the_second_is_sent_away(start):
    client = Client(start().url)  # a proxy would hold half a body back
    headers, shape = keyed(), noisy_sphere(3000, seed=36)
    half_sent, go_on = threading.Event(), threading.Event()

    def slow_body():
        yield shape[:1000]
        half_sent.set()
        go_on.wait(20)
        yield shape[1000:]

    answers = []
    sender = threading.Thread(
        target=lambda: answers.append(client.execute("denoise", slow_body(), headers=headers)))
    sender.start()
    assert half_sent.wait(10)
    time.sleep(1)  # the server sees the head of the first; the second may not hold the key before it
    second = client.execute("denoise", shape[:-12], headers=headers)
    assert second.json()["code"] == "idempotency-conflict"
    assert int(second.headers["Retry-After"]) >= 1
    go_on.set()
    sender.join()
    assert answers[0].status_code == 201


def test_many_threads_with_one_key_make_one_job(client):
    headers, shape = keyed(), noisy_sphere(300, seed=37)
    answers = []

    def send():
        for _ in range(200):
            answer = client.execute("denoise", shape, headers=headers)
            if answer.status_code != 409:
                break
        answers.append(answer)

    threads = [threading.Thread(target=send) for _ in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert {answer.status_code for answer in answers} == {201}
    assert len({answer.json()["jobID"] for answer in answers}) == 1


def test_a_key_outlives_the_server(start):
    headers, shape = keyed(), noisy_sphere(200)
    server = start()
    job = Client(server.url).execute("denoise", shape, headers=headers).json()["jobID"]
    server.kill()
    again = Client(start().url).execute("denoise", shape, headers=headers)
    assert again.json()["jobID"] == job and again.headers["Idempotency-Replayed"] == "true"


def test_a_retry_is_a_new_job_with_the_same_inputs(client):
    path = client.run("denoise", noisy_sphere(300, seed=38), "?atoms=4")
    headers = keyed()
    answer = client.post(path + "/retry", b"", headers=headers)
    assert answer.status_code == 201
    new = answer.json()
    assert new["retryOf"] == path.rsplit("/", 1)[1]
    assert {"rel": "predecessor-version", "href": path}.items() <= \
        next(l for l in new["links"] if l["rel"] == "predecessor-version").items()
    old = client.get(path).json()
    assert any(l["rel"] == "successor-version" and l["href"].endswith(new["jobID"])
               for l in old["links"])
    assert new["parameters"] == old["parameters"] and new["shape"] == old["shape"]
    again = client.post(path + "/retry", b"", headers=headers)
    assert again.json()["jobID"] == new["jobID"]
    assert again.headers["Idempotency-Replayed"] == "true"
    assert client.finish(new)["status"] == "successful"
    points = [client.get(f"/v1/jobs/{job}/results").json()["points"]["sha256"]
              for job in (old["jobID"], new["jobID"])]
    assert points[0] == points[1]


def test_retries_that_cannot_be(client):
    path = client.run("denoise", noisy_sphere(150, seed=39))
    assert client.post(path + "/retry", b"{}").status_code == 400
    assert client.delete("/v1/shapes/" + client.get(path).json()["shape"]).status_code == 204
    answer = client.post(path + "/retry", b"")
    assert (answer.status_code, answer.json()["code"]) == (404, "shape-not-found")
    assert "pload it again" in answer.json()["detail"]
    client.delete(path)
    assert client.post(path + "/retry", b"").json()["code"] == "job-dismissed"
    unknown = "/v1/jobs/01890000-0000-7000-8000-000000000000/retry"
    assert client.post(unknown, b"").status_code in (404, 410)
    slow = client.execute("analyze", noisy_sphere(20_000), SLOW).headers["Location"]
    assert client.post(slow + "/retry", b"").json()["code"] == "conflict"
    client.delete(slow)


def test_no_retry_without_a_length_hangs(client):
    answer = requests.post(client.url + "/v1/jobs/none/retry", data=b"", timeout=10)
    assert answer.status_code == 404
