"""The story of a job as an event stream."""

import json
import time

import jsonschema
import pytest

from shapes import noisy_sphere

SLOW = "?analysisIterations=1000"


def stream(client, path, **headers):
    """Opens a stream whose head must be right, and gives out its events."""
    response = client.raw("GET", path, stream=True, headers=headers)
    assert response.status_code == 200, response.text
    assert response.headers["Content-Type"].startswith("text/event-stream")
    assert response.headers["Cache-Control"] == "no-cache"
    assert response.headers["X-Accel-Buffering"] == "no"
    return events_of(client, response)


def events_of(client, response):
    schema = {"$ref": "#/components/schemas/JobEvent"}
    validator = jsonschema.Draft202012Validator(schema, resolver=client.contract.resolver)
    event = {}
    for line in response.iter_lines(chunk_size=1, decode_unicode=True):
        name, _, value = line.partition(": ")
        if line == "" and "event" in event:
            event["data"] = json.loads(event["data"])
            event["id"] = int(event["id"])
            errors = list(validator.iter_errors(
                {name: event[name] for name in ("id", "event", "data")}))
            assert not errors, f"{event['event']}: {errors[0].message}"
            yield event
            event = {}
        elif name == "retry":
            assert int(value) > 0
        elif name:
            event[name] = value


def test_a_job_tells_its_story_to_the_end(client):
    job = client.execute("analyze", noisy_sphere(60_000, seed=31), "?analysisIterations=60").json()
    story = list(stream(client, f"/v1/jobs/{job['jobID']}/events"))
    names = [event["event"] for event in story]
    assert names[-1] == "end" and names.count("end") == 1
    assert "status" in names and "progress" in names
    assert story[-1]["data"]["status"] == "successful"
    ids = [event["id"] for event in story]
    assert ids == sorted(set(ids))
    values = [event["data"]["progress"] for event in story if event["event"] == "progress"]
    assert values == sorted(values)


def test_progress_comes_every_second(client):
    job = client.execute("analyze", noisy_sphere(20_000, seed=32), SLOW).json()
    path = f"/v1/jobs/{job['jobID']}"
    times = []
    for event in stream(client, path + "/events"):
        if event["event"] == "progress":
            times.append(time.time())
        if len(times) == 5:
            break
    client.delete(path)
    gaps = [b - a for a, b in zip(times, times[1:])]
    assert max(gaps) < 2.0, gaps


def test_a_dismissal_ends_the_stream(client):
    job = client.execute("analyze", noisy_sphere(20_000, seed=33), SLOW).json()
    path = f"/v1/jobs/{job['jobID']}"
    story = stream(client, path + "/events")
    next(story)
    client.delete(path)
    end = list(story)[-1]
    assert end["event"] == "end" and end["data"]["status"] == "dismissed"
    assert client.get(path + "/events").status_code == 410


def test_what_was_missed_is_told_again(client, done):
    story = list(stream(client, done + "/events"))
    assert [event["event"] for event in story[-2:]] == ["status", "end"]
    for place in ({"Last-Event-ID": str(story[-2]["id"])}, None):
        path = done + "/events"
        if place is None:
            path += f"?lastEventId={story[-2]['id']}"
        rest = list(stream(client, path, **(place or {})))
        assert [event["event"] for event in rest] == ["end"]
    everything = list(stream(client, done + "/events", **{"Last-Event-ID": "nonsense"}))
    assert everything[-1]["event"] == "end"


def test_a_client_that_has_seen_the_end_is_told_to_stay_away(client):
    path = client.run("denoise", noisy_sphere(300, seed=34)) + "/events"
    last = list(stream(client, path))[-1]["id"]
    answer = client.get(path, headers={"Last-Event-ID": str(last)})
    assert answer.status_code == 204 and not answer.content


def test_a_job_from_before_a_restart_says_how_it_ended(start):
    from contract import Client
    server = start()
    client = Client(server.url)
    path = client.run("denoise", noisy_sphere(300, seed=35)) + "/events"
    before = list(stream(client, path))[-1]["id"]
    assert server.terminate() == 0
    client = Client(start().url)
    story = list(stream(client, path, **{"Last-Event-ID": str(before)}))
    assert [event["event"] for event in story] == ["status", "end"]
    assert story[0]["id"] > before
    assert story[-1]["data"]["status"] == "successful"


def test_waiting_jobs_have_a_story_too(start):
    from contract import Client
    client = Client(start("--jobs", "1").url)
    first = client.execute("analyze", noisy_sphere(20_000, seed=36), SLOW).json()
    second = client.execute("analyze", noisy_sphere(20_000, seed=37), SLOW).json()
    event = next(stream(client, f"/v1/jobs/{second['jobID']}/events"))
    assert event["event"] == "status" and event["data"]["status"] == "accepted"
    for job in (second, first):
        client.delete("/v1/jobs/" + job["jobID"])


@pytest.mark.parametrize("path, status", [
    ("/v1/jobs/none/events", 404), ("/v1/jobs/01890000-0000-7000-8000-000000000000/events", 410)])
def test_unknown_jobs_have_no_story(client, path, status):
    assert client.get(path).status_code in (404, status)


def test_wrong_queries(client, done):
    assert client.get(done + "/events?lastEventId=x").status_code == 422
    assert client.get(done + "/events?last=1").status_code == 400
