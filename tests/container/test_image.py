"""What is in the image, and what its server may do."""

import json
import os
import time

from container import IMAGE, engine

from contract import Client
from shapes import noisy_sphere, radius_error, read_ply

MOST_BYTES = 120_000_000


def facts():
    return json.loads(engine("image", "inspect", IMAGE).stdout)[0]


def test_the_image_is_small_and_says_what_it_is():
    image = facts()
    assert image["Size"] < MOST_BYTES, image["Size"]
    labels = image["Config"]["Labels"]
    assert labels["org.opencontainers.image.licenses"] == "Apache-2.0"
    version = engine("run", "--rm", IMAGE, "--version").stdout.split()[1]
    assert labels["org.opencontainers.image.version"] == version
    assert labels["org.opencontainers.image.revision"] == os.environ.get("LPF_COMMIT", "unknown")


def test_the_server_has_few_rights(run):
    server = run()
    assert server.run("id", "-u").stdout.strip() == "65532"
    status = server.run("cat", "/proc/1/status").stdout
    fields = dict(line.split(":", 1) for line in status.splitlines())
    assert int(fields["CapEff"], 16) == int(fields["CapPrm"], 16) == int(fields["CapBnd"], 16) == 0
    assert fields["NoNewPrivs"].strip() == "1"
    for path in ("/", "/usr/local/bin", "/etc"):
        assert server.run("touch", path + "/mine").returncode != 0, path
    assert server.run("touch", "/tmp/mine").returncode == 0
    for tool in ("cc", "c++", "g++", "cmake", "npm", "python3"):
        assert server.run("which", tool).returncode != 0, tool


def test_it_works_and_logs_json_lines(run):
    server = run()
    client = Client(server.url)
    path = client.run("denoise", noisy_sphere(3000, noise=0.03))
    rows = read_ply(client.get(path + "/results/points").content)
    assert len(rows) == 3000 and radius_error(rows) < 0.02
    assert client.run("denoise", client.get(path + "/results/points?format=drc").content)
    assert "<html" in client.raw("GET", "/").text
    events = [json.loads(line)["event"] for line in server.log().splitlines()]
    assert {"listening", "started", "job-finished"} <= set(events)


def test_health_is_probed_by_the_binary_itself(run):
    server = run()
    image = facts()
    probe = image.get("Healthcheck") or image["Config"]["Healthcheck"]  # podman, docker
    assert probe["Test"] == ["CMD", "lpf-server", "--healthcheck"]
    assert server.run("lpf-server", "--healthcheck").returncode == 0
    assert server.run("env", "LPF_ADMIN_PORT=1", "lpf-server", "--healthcheck").returncode == 1
    if engine("healthcheck", "run", server.name, check=False).returncode == 0:
        return  # podman, which probes when it is asked
    deadline = time.monotonic() + 40
    while server.state()["Health"]["Status"] != "healthy":
        assert time.monotonic() < deadline
        time.sleep(0.5)
