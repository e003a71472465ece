"""Uploads damaged files over many connections and asks for a decent answer to each.

    mutated_uploads.py URL NUMBER [SEED]

An answer is decent if it is a result, or a 4xx problem document as the OpenAPI document has it.
"""

import collections
import http.client
import json
import random
import sys
import threading
import time
import urllib.parse

import jsonschema

from mutation import mutated

CONNECTIONS = 4
JOB_SHARE = 0.05
EXECUTION = ("/v1/processes/denoise/execution?analysisIterations=1&denoiseIterations=1"
             "&patternPoints=25&atoms=4&maxSeconds=20")


class Judge:
    """Tells decent answers from others, and counts them."""

    def __init__(self, document):
        resolver = jsonschema.RefResolver("", document)
        schema = {"$ref": "#/components/schemas/Problem"}
        self.problem = jsonschema.Draft202012Validator(schema, resolver=resolver)
        self.answers = collections.Counter()
        self.faults = []
        self.lock = threading.Lock()

    def judge(self, path, data, status, headers, body):
        fault = None
        if status in (200, 201):
            answer = "job" if "execution" in path else "shape"
            if not json.loads(body).get("jobID" if answer == "job" else "id"):
                fault = "a success without an id"
        elif 400 <= status < 500:
            problem = json.loads(body)
            answer = f"{status} {problem.get('code')}"
            error = next(self.problem.iter_errors(problem), None)
            if error is not None or not headers.startswith("application/problem+json"):
                fault = f"no problem document: {error and error.message}"
        else:
            answer = str(status)
            fault = body[:200].decode("utf-8", "replace")
        with self.lock:
            self.answers[answer] += 1
            if fault:
                self.faults.append((path, data, status, fault))


class Uploader(threading.Thread):
    """One connection with its own dice."""

    def __init__(self, url, seeds, judge, count, seed):
        super().__init__(daemon=True)
        self.address = urllib.parse.urlsplit(url).netloc
        self.seeds, self.judge, self.count = seeds, judge, count
        self.dice = random.Random(seed)
        self.connection = None
        self.error = None

    def run(self):
        try:
            for _ in range(self.count):
                self.upload(mutated(self.seeds, self.dice))
        except Exception as error:  # told by the main thread
            self.error = error

    def upload(self, data):
        path = EXECUTION if self.dice.random() < JOB_SHARE else "/v1/shapes"
        while True:
            status, headers, body = self.send(path, data)
            wait = headers.get("Retry-After")
            if status not in (429, 503) or wait is None:
                break
            time.sleep(min(float(wait), 2))  # too much at a time is no verdict about the file
        self.judge.judge(path, data, status, headers.get("Content-Type", ""), body)

    def send(self, path, data):
        fresh = self.connection is None
        if fresh:
            self.connection = http.client.HTTPConnection(self.address, timeout=300)
        try:
            self.connection.request("POST", path, data,
                                    {"Content-Type": "application/octet-stream"})
            answer = self.connection.getresponse()
            body = answer.read()
            if answer.will_close:
                self.close()
            return answer.status, answer.headers, body
        except (http.client.RemoteDisconnected, ConnectionResetError, BrokenPipeError):
            self.close()
            if fresh:
                raise
            return self.send(path, data)  # the server may close a connection that was idle

    def close(self):
        self.connection.close()
        self.connection = None


def upload_all(url, document, seeds, count, seed=1):
    """Uploads `count` damaged files. Returns the judge."""
    judge = Judge(document)
    share = [count // CONNECTIONS + (i < count % CONNECTIONS) for i in range(CONNECTIONS)]
    uploaders = [Uploader(url, seeds, judge, n, seed * 1000 + i) for i, n in enumerate(share)]
    for uploader in uploaders:
        uploader.start()
    for uploader in uploaders:
        uploader.join()
        if uploader.error is not None:
            raise uploader.error
    return judge


def fetch(url, path):
    connection = http.client.HTTPConnection(urllib.parse.urlsplit(url).netloc, timeout=60)
    connection.request("GET", path)
    answer = connection.getresponse()
    return answer.status, answer.read()


def draco_seeds(url, plys):
    """What the server itself makes of some shapes."""
    files = []
    for ply in plys:
        connection = http.client.HTTPConnection(urllib.parse.urlsplit(url).netloc, timeout=60)
        connection.request("POST", EXECUTION + "&format=drc", ply, {"Prefer": "wait=30"})
        answer = connection.getresponse()
        body = answer.read()
        if answer.status == 201:
            job = json.loads(body)["jobID"]
            while json.loads(fetch(url, f"/v1/jobs/{job}")[1])["status"] in ("accepted", "running"):
                time.sleep(0.1)
            body = fetch(url, f"/v1/jobs/{job}/results/points")[1]
        assert body[:5] == b"DRACO", body[:200]
        files.append(body)
    return files


def jobs_with_server_faults(url):
    """Jobs that failed for another reason than their input."""
    path, found = "/v1/jobs?status=failed&limit=1000", []
    while path:
        page = json.loads(fetch(url, path)[1])
        found += [job for job in page["jobs"] if job["exception"]["status"] >= 500]
        path = next((link["href"] for link in page["links"] if link["rel"] == "next"), None)
    return found


def wait_for_jobs(url, seconds):
    end = time.time() + seconds
    for status in ("accepted", "running"):
        while json.loads(fetch(url, f"/v1/jobs?status={status}&limit=1")[1])["jobs"]:
            assert time.time() < end, f"jobs are still {status} after {seconds} s"
            time.sleep(0.2)


def main():
    from mutation import ply_seeds
    url, count = sys.argv[1].rstrip("/"), int(sys.argv[2])
    plys = ply_seeds()
    dracos = draco_seeds(url, plys)
    document = json.loads(fetch(url, "/v1/openapi.json")[1])
    start = time.time()
    judge = upload_all(url, document, plys + dracos, count, int((sys.argv[3:] or [1])[0]))
    seconds = time.time() - start
    print(f"{count} uploads in {seconds:.0f} s, {count / seconds:.0f} a second")
    for answer, number in judge.answers.most_common():
        print(f"{number:8d}  {answer}")
    wait_for_jobs(url, 600)
    failed = jobs_with_server_faults(url)
    for path, data, status, fault in judge.faults[:5]:
        print(f"FAULT {path} {status}: {fault}\n  {data[:300]!r}")
    for job in failed[:5]:
        print(f"FAULT of job {job['jobID']}: {job['exception']}")
    return 1 if judge.faults or failed else 0


if __name__ == "__main__":
    sys.exit(main())
