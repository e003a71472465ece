"""A full disk, a quota, a folder that cannot be written to, a database that is damaged."""

import hashlib
import os
import shutil
import subprocess
import time

import pytest

import program
from conftest import needs_program
from contract import Client
from server import Server
from shapes import noisy_sphere


@pytest.fixture
def small_disk(tmp_path):
    """A file system of 16 MiB for a server of the test's own."""
    needs_program()
    folder = tmp_path / "disk"
    folder.mkdir()
    mounted = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=16m", "tmpfs", str(folder)],
                             capture_output=True, text=True, check=False)
    if mounted.returncode != 0:
        pytest.skip("may not mount a small disk: " + mounted.stderr.strip())
    yield folder
    subprocess.run(["umount", "--lazy", str(folder)], check=False)


def refusal(folder, *flags):
    """What a server says that does not start."""
    ended = program.run(["--port", "0", "--admin-port", "0", "--data-dir", str(folder), *flags])
    assert ended.returncode == 1
    return ended.stderr


def finish_all(client, jobs):
    return [client.finish(client.get("/v1/jobs/" + job).json()) for job in jobs]


def fill(client):
    """Sends shapes, some with a job, until the disk is full. Returns what was acknowledged."""
    shapes, jobs, refusals = {}, [], 0
    for number in range(1000):
        data = noisy_sphere(8_000, seed=number)
        if number % 6 == 0:
            answer = client.execute("denoise", data, "?analysisIterations=1")
        else:
            answer = client.post("/v1/shapes", data)
        assert answer.status_code in (201, 507), answer.text
        if answer.status_code == 507:
            assert answer.json()["code"] == "insufficient-storage"
            assert "disk" in answer.json()["detail"]
            refusals += 1
            if refusals == 10:
                return shapes, jobs
        elif number % 6 == 0:
            jobs.append(answer.json()["jobID"])
        else:
            shapes[answer.json()["id"]] = hashlib.sha256(data).hexdigest()
    raise AssertionError("the disk never was full")


def check_shapes(client, shapes):
    for shape, digest in shapes.items():
        data = client.get(f"/v1/shapes/{shape}/data").content
        assert hashlib.sha256(data).hexdigest() == digest


@pytest.mark.parametrize("floor", ["8000000", "0"])
def test_a_full_disk_loses_nothing(small_disk, floor):
    flags = ("--disk-floor-bytes", floor, "--lease-seconds", "3", "--sweep-seconds", "1")
    with Server(small_disk / "data", *flags) as server:
        client = Client(server.url)
        shapes, acknowledged = fill(client)
        assert shapes and acknowledged
        assert client.get("/healthz").status_code == 200
        check_shapes(client, shapes)
        subprocess.run(["mount", "-o", "remount,size=64m", str(small_disk)], check=True)
        ends = finish_all(client, acknowledged)
        for job in ends:  # results that found no room can be had once there is some
            if job["status"] != "successful":
                assert job["exception"]["code"] == "insufficient-storage", job["exception"]
                again = client.post(f"/v1/jobs/{job['jobID']}/retry", b"")
                assert client.finish(again.json())["status"] == "successful"
        client.run("denoise", noisy_sphere(500, seed=1000))
        assert server.terminate() == 0
    with Server(small_disk / "data", *flags) as server:
        client = Client(server.url)
        assert [job["status"] for job in finish_all(client, acknowledged)] == \
            [job["status"] for job in ends]
        check_shapes(client, shapes)


def test_the_quota_of_stored_bytes(start):
    client = Client(start("--max-stored-bytes", "300000").url)
    answers = [client.post("/v1/shapes", noisy_sphere(2000, seed=i)) for i in range(8)]
    statuses = [answer.status_code for answer in answers]
    assert statuses[0] == 201 and statuses[-1] == 507
    assert sorted(statuses) == statuses, "what is full stays full"
    problem = answers[-1].json()
    assert problem["code"] == "insufficient-storage" and "storedBytes" in problem["detail"]
    assert client.get("/v1/info").json()["limits"]["storedBytes"] == 300000
    assert client.delete("/v1/shapes/" + answers[0].json()["id"]).status_code == 204
    assert client.post("/v1/shapes", noisy_sphere(2000, seed=20)).status_code == 201


def test_a_folder_that_cannot_be_written_to(small_disk, tmp_path):
    subprocess.run(["mount", "-o", "remount,ro", str(small_disk)], check=True)
    text = refusal(small_disk / "data")
    assert "cannot be written to" in text and "--data-dir" in text
    file = tmp_path / "file"
    file.write_text("not a folder")
    assert "cannot be written to" in refusal(file / "data")


def test_a_damaged_database_is_told_and_left_alone(start, tmp_path):
    server = start()
    Client(server.url).run("denoise", noisy_sphere(200))
    assert server.terminate() == 0
    books = tmp_path / "data" / "jobs.sqlite"
    content = bytearray(books.read_bytes())
    for page in range(1, min(8, len(content) // 4096)):
        content[page * 4096:page * 4096 + 300] = b"\xff" * 300
    books.write_bytes(content)
    text = refusal(tmp_path / "data")
    assert "damaged" in text and "jobs.sqlite" in text
    assert books.read_bytes() == content
    shutil.rmtree(tmp_path / "data")
    Client(start().url).run("denoise", noisy_sphere(200))


def test_files_that_nobody_knows_are_put_aside_and_not_deleted(start, tmp_path):
    server = start()
    path = Client(server.url).run("denoise", noisy_sphere(200))
    assert server.terminate() == 0
    unknown = "ab" * 32
    stray = tmp_path / "data" / "blobs" / "ab" / unknown
    fresh = tmp_path / "data" / "blobs" / "ab" / ("ab" + "0" * 62)
    stray.parent.mkdir(exist_ok=True)
    for file in (stray, fresh):
        file.write_text("whose is this?")
    os.utime(stray, (time.time() - 7200,) * 2)
    client = Client(start().url)
    assert not stray.exists() and fresh.exists()
    assert (tmp_path / "data" / "quarantine" / unknown).read_text() == "whose is this?"
    assert client.get(path + "/results/points").status_code == 200
