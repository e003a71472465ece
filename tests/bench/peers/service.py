"""Denoises and resamples by the service itself, over HTTP, as a user would."""

import http.client
import json
import shutil
import subprocess
import tempfile
import time
from pathlib import Path

from measured import wait_for


class Server:
    """One server for one job, so that its CPU time and its memory are the job's."""

    def __init__(self, binary, log):
        self.folder = tempfile.mkdtemp(prefix="lpf-peers-")
        self.log = open(log, "wb")
        self.process = subprocess.Popen(
            [binary, "--port", "0", "--admin-port", "0", "--data-dir", self.folder,
             "--disk-floor-bytes", "0", "--disk-floor-percent", "0"],
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=self.log)
        self.port = json.loads(self.process.stdout.readline())["port"]

    def request(self, method, path, body=None):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=120)
        try:
            connection.request(method, path, body)
            answer = connection.getresponse()
            content = answer.read()
        finally:
            connection.close()
        if answer.status >= 400:
            raise RuntimeError(f"{method} {path}: {answer.status} {content[:300]!r}")
        return content

    def stop(self):
        """Ends the server; its usage."""
        self.process.terminate()
        usage = wait_for(self.process)
        self.process.stdout.close()
        self.log.close()
        shutil.rmtree(self.folder, ignore_errors=True)
        return usage


def run_job(server, process, query, scan, result):
    """Sends a scan, waits for the job, writes its points; "ok" or what went wrong."""
    answer = server.request("POST", f"/v1/processes/{process}/execution{query}",
                            Path(scan).read_bytes())
    job = "/v1/jobs/" + json.loads(answer)["jobID"]
    while True:
        status = json.loads(server.request("GET", job))
        if status["status"] not in ("accepted", "running"):
            break
        time.sleep(0.2)
    if status["status"] != "successful":
        return f"{status['status']}: {status.get('message', '')}"
    Path(result).write_bytes(server.request("GET", job + "/results/points"))
    return "ok"


def run(binary, process, query, scan, result, log):
    """Usage of the whole of it, reading and writing of files included."""
    server = Server(binary, log)
    outcome = "failed: no answer"
    try:
        outcome = run_job(server, process, query, scan, result)
    except (OSError, RuntimeError) as error:
        outcome = f"failed: {error}"
    finally:
        usage = server.stop()
    if outcome != "ok":
        usage.outcome = outcome
    return usage
