"""Kills at random moments while clients send, follow and fetch: nothing acknowledged is lost.

LPF_CRASH_KILLS sets the number of kills; LPF_CRASH_SEED the dice.
"""

import hashlib
import os
import random
import signal
import sqlite3
import threading
import time
import uuid

import requests

from contract import Client
from server import Server
from shapes import noisy_sphere

KILLS = int(os.environ.get("LPF_CRASH_KILLS", "5"))
SEED = int(os.environ.get("LPF_CRASH_SEED", "7"))
FLAGS = ("--max-job-attempts", "100", "--max-queued-jobs", "100000")
SLOW = "?analysisIterations=1000"
ENDED = ("successful", "failed")
MOST_UNFINISHED = 40  # the senders wait beyond that, so that the end comes soon


class Ledger:
    """What the server has told its clients, and what must therefore stay true."""

    def __init__(self):
        self.lock = threading.Lock()
        self.acknowledged = {}  # job -> seed of its request
        self.keys = {}          # seed -> job, of requests with an Idempotency-Key
        self.ends = {}          # job -> (status, time of its end)
        self.digests = {}       # job -> digests of its results
        self.faults = []

    def fault(self, text):
        with self.lock:
            self.faults.append(text)

    def acknowledge(self, seed, job, keyed):
        with self.lock:
            if keyed and self.keys.setdefault(seed, job) != job:
                self.faults.append(f"one key made the jobs {self.keys[seed]} and {job}")
            self.acknowledged[job] = seed

    def see(self, job, asked):
        """A job as it was shown: an end is the only one, for good.

        What was asked for before the end was seen may have been answered before it, too.
        """
        with self.lock:
            name, end = job["jobID"], (job["status"], job.get("finished"))
            known, seen = self.ends.get(name, (None, 0))
            if known and known != end and (end[0] in ENDED or asked > seen):
                self.faults.append(f"job {name} was {known} and is {end}")
            elif end[0] in ENDED and not known:
                self.ends[name] = (end, time.monotonic())

    def see_results(self, job, digests):
        with self.lock:
            if self.digests.setdefault(job, digests) != digests:
                self.faults.append(f"the results of job {job} have changed")

    def unfinished(self):
        with self.lock:
            return len(self.acknowledged.keys() - self.ends.keys())

    def some_job(self, dice):
        with self.lock:
            return dice.choice(list(self.acknowledged)) if self.acknowledged else None


def fetch_whole(url):
    """The answer; requests passes a body that the death of the server cut short off as whole."""
    answer = requests.get(url, timeout=20)
    if len(answer.content) < int(answer.headers.get("Content-Length", 0)):
        raise requests.ConnectionError(f"{url}: the body ends early")
    return answer


def verify_results(url, job, ledger):
    """The results are those that the document names, byte by byte."""
    results = requests.get(f"{url}/v1/jobs/{job}/results", timeout=20)
    if results.status_code != 200:
        ledger.fault(f"results of {job}: {results.text}")
        return
    digests = {}
    for name, entry in results.json().items():
        answer = fetch_whole(url + entry["href"])
        digests[name] = hashlib.sha256(answer.content).hexdigest()
        if digests[name] != entry["sha256"] or len(answer.content) != entry["bytes"]:
            ledger.fault(f"{name} of {job} is not what its document says: status "
                         f"{answer.status_code}, {len(answer.content)} bytes, not {entry['bytes']}")
    ledger.see_results(job, digests)


class Clients:
    """Threads that use whatever server is there now, and bear with its deaths."""

    def __init__(self, ledger):
        self.ledger = ledger
        self.url = None
        self.stopping = threading.Event()
        self.counter = iter(range(1, 10 ** 9))
        actions = [self.send, self.send_keyed, self.send_keyed, self.follow, self.fetch]
        self.threads = [threading.Thread(target=self.work, args=(action, random.Random(SEED + i)))
                        for i, action in enumerate(actions)]
        for thread in self.threads:
            thread.start()

    def work(self, action, dice):
        while not self.stopping.is_set():
            try:
                if self.url:
                    action(dice)
            except requests.RequestException:
                pass
            time.sleep(dice.uniform(0, 0.05))

    def post(self, seed, dice, headers):
        shape = noisy_sphere(dice.choice([60, 120, 200]), seed=dice.randrange(20))
        return requests.post(f"{self.url}/v1/processes/denoise/execution?randomSeed={seed}",
                             data=shape, headers=headers, timeout=20)

    def send(self, dice):
        if self.ledger.unfinished() > MOST_UNFINISHED:
            return
        seed = next(self.counter)
        answer = self.post(seed, dice, {})
        self.take(answer, seed, keyed=False)

    def send_keyed(self, dice):
        """Sends the same request again and again until it is acknowledged, then once more."""
        if self.ledger.unfinished() > MOST_UNFINISHED:
            return
        seed = next(self.counter)
        headers = {"Idempotency-Key": str(uuid.UUID(int=dice.getrandbits(128)))}
        state, acknowledged = dice.getstate(), 0
        while acknowledged < 2 and not self.stopping.is_set():
            dice.setstate(state)  # the same body
            try:
                answer = self.post(seed, dice, headers)
                acknowledged += self.take(answer, seed, keyed=True)
            except requests.RequestException:
                time.sleep(0.02)

    def take(self, answer, seed, keyed):
        if answer.status_code == 201:
            self.ledger.acknowledge(seed, answer.json()["jobID"], keyed)
            return True
        if answer.status_code not in (409, 503):
            self.ledger.fault(f"sending: {answer.status_code} {answer.text}")
        return False

    def follow(self, dice):
        job = self.ledger.some_job(dice)
        if job:
            asked = time.monotonic()
            answer = requests.get(f"{self.url}/v1/jobs/{job}", timeout=20)
            if answer.status_code != 200:
                self.ledger.fault(f"following {job}: {answer.status_code} {answer.text}")
            else:
                self.ledger.see(answer.json(), asked)

    def fetch(self, dice):
        asked = time.monotonic()
        for job in requests.get(self.url + "/v1/jobs?limit=30", timeout=20).json()["jobs"]:
            self.ledger.see(job, asked)
            if job["status"] == "successful" and dice.random() < 0.2:
                verify_results(self.url, job["jobID"], self.ledger)

    def stop(self):
        self.stopping.set()
        for thread in self.threads:
            thread.join(timeout=60)
            assert not thread.is_alive(), "a client hangs"


def all_jobs(client):
    jobs, path = [], "/v1/jobs?limit=500"
    while path:
        page = client.get(path).json()
        jobs += page["jobs"]
        path = next((link["href"] for link in page["links"] if link["rel"] == "next"), None)
    return jobs


def check_books(folder):
    """The database is whole, and no job has two ends or half a result."""
    with sqlite3.connect(folder / "jobs.sqlite") as books:
        assert books.execute("PRAGMA integrity_check").fetchone() == ("ok",)
        assert books.execute("SELECT count(*) FROM jobs WHERE status IN ('accepted', 'running') "
                             "OR lease <> ''").fetchone() == (0,)
        broken = books.execute(
            "SELECT id FROM jobs WHERE status = 'successful' AND "
            "(SELECT count(*) FROM results WHERE job_id = id) <> 4").fetchall()
        assert broken == []
        for digest, size in books.execute("SELECT sha256, bytes FROM results"):
            blob = folder / "blobs" / digest[:2] / digest
            assert blob.stat().st_size == size
    assert list((folder / "tmp").iterdir()) == []


def test_nothing_acknowledged_is_lost_however_often_the_server_is_killed(start, tmp_path):
    dice, ledger = random.Random(SEED), Ledger()
    clients = Clients(ledger)
    try:
        for _ in range(KILLS):
            server = start(*FLAGS)
            clients.url = server.url
            time.sleep(dice.choice([dice.uniform(0, 0.1), dice.uniform(0.1, 1.2)]))
            server.kill()
        server = start(*FLAGS)
        clients.url = server.url
        time.sleep(1)
    finally:
        clients.stop()

    client = Client(server.url)
    deadline = time.time() + 60 + KILLS
    for job in list(ledger.acknowledged):
        state = client.get("/v1/jobs/" + job).json()
        while state["status"] not in ENDED:
            assert time.time() < deadline, f"job {job} hangs: {state}"
            state = client.get("/v1/jobs/" + job, headers={"Prefer": "wait=5"}).json()
        ledger.see(state, time.monotonic())
        if state["status"] == "successful":
            verify_results(server.url, job, ledger)
    jobs = all_jobs(client)
    for job in jobs:  # also those whose acknowledgement was lost with the server
        client.finish(job)
    seeds = [job["parameters"]["randomSeed"] for job in jobs]
    for seed, job in ledger.keys.items():
        assert seeds.count(seed) == 1, f"the request of job {job} made {seeds.count(seed)} jobs"
    assert ledger.faults == []
    assert set(ledger.acknowledged) <= {job["jobID"] for job in jobs}
    assert len(ledger.acknowledged) >= KILLS
    ends = [end[0] for end, _ in ledger.ends.values()]
    assert server.terminate() == 0
    check_books(tmp_path / "data")
    print(f"{KILLS} kills, {len(jobs)} jobs, {len(ledger.acknowledged)} acknowledged, "
          f"{len(ledger.keys)} with a key, {ends.count('successful')} successful, "
          f"{ends.count('failed')} failed, {max(job['attempt'] for job in jobs)} attempts at most")


def test_a_stop_gives_running_jobs_back_uncounted(start):
    """Four jobs, as many of them running as there are cores for it."""
    server = start("--jobs", "4", "--max-small-job-points", "1000000")
    client = Client(server.url)
    jobs = [client.execute("analyze", noisy_sphere(20_000, seed=i), SLOW).json()["jobID"]
            for i in range(4)]
    workers = client.get("/v1/info").json()["queue"]["workers"]
    running = []
    while len(running) < workers:
        running = client.get("/v1/jobs?status=running").json()["jobs"]
        time.sleep(0.02)
    assert {job["attempt"] for job in running} == {1}
    begin = time.time()
    assert server.terminate() == 0
    assert time.time() - begin < 30

    client = Client(start("--jobs", "4", "--max-job-seconds", "2").url)
    for job in jobs:  # the limit of time lets each end soon
        end = client.finish(client.get("/v1/jobs/" + job).json())
        assert end["attempt"] == 1, end
        assert end["exception"]["code"] == "timed-out"


def test_a_worker_that_was_stopped_beyond_its_lease_loses_its_job(start):
    server = start("--lease-seconds", "1", "--sweep-seconds", "0.5", "--max-job-seconds", "6")
    client = Client(server.url)
    job = client.execute("analyze", noisy_sphere(20_000), SLOW).json()["jobID"]
    while client.get("/v1/jobs/" + job).json()["status"] != "running":
        time.sleep(0.02)
    server.process.send_signal(signal.SIGSTOP)
    time.sleep(2)
    server.process.send_signal(signal.SIGCONT)
    end = client.finish(client.get("/v1/jobs/" + job).json())
    assert end["attempt"] == 2 and end["exception"]["code"] == "timed-out"
    metrics = requests.get(server.admin_url + "/metrics", timeout=10).text
    assert "lpf_lease_losses_total 1" in metrics
    assert server.process.poll() is None
