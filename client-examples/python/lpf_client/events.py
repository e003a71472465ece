"""Follows a job: by its event stream, or by asking if streams do not come through."""

import json
import time

from .errors import Failure, JobFailed, NoServer, describe
from .transport import BROKEN, backoff

ENDED = ("successful", "failed", "dismissed")
SILENCE = 45  # seconds without a byte after which a stream counts as broken
POLL = 5  # seconds that the server may hold an answer back


class StreamRefused(Exception):
    """The server or something before it does not give event streams."""


def parse(lines):
    """Events of a text/event-stream as (id, name, data); an id or a name may be ""."""
    identity, name, data = "", "", []
    for line in lines:
        line = line.decode("utf-8", "replace").rstrip("\r\n")
        if not line:
            if data:
                yield identity, name, "\n".join(data)
            name, data = "", []
            continue
        field, _, value = line.partition(":")
        value = value[1:] if value.startswith(" ") else value
        if field == "id":
            identity = value
        elif field == "event":
            name = value
        elif field == "data":
            data.append(value)


def _object(data):
    try:
        return dict(json.loads(data))
    except (TypeError, ValueError) as error:
        raise StreamRefused from error


class Follower:
    """Follows one job to its end. `listener(statusInfo)` hears of every change."""

    def __init__(self, transport, job_id, listener):
        self._transport = transport
        self._path = "/v1/jobs/" + job_id
        self._listener = listener
        self._last_event = ""
        self._state = {}

    def run(self, events=True):
        """The statusInfo of the successful job; JobFailed if it ended otherwise."""
        try:
            job = self._by_events() if events else self._by_asking()
        except Failure as failure:
            if getattr(failure, "status", None) == 410:
                raise JobFailed(str(failure)) from failure
            raise
        if job["status"] != "successful":
            raise JobFailed(describe(job.get("exception") or {"title": job.get("message", "")}))
        return job

    def _by_events(self):
        broken = 0  # times in a row without a new event
        while True:
            before = self._last_event
            try:
                end = self._read_stream()
                if end:
                    return end
                error = "the event stream ended early"
            except StreamRefused:
                return self._by_asking()
            except BROKEN as lost:
                error = str(lost) or type(lost).__name__
            broken = broken + 1 if self._last_event == before else 0
            if broken > self._transport.retries:
                raise NoServer(f"{self._transport.name} is gone: {error}")
            self._transport.notice("The connection broke; coming back to the job.")
            time.sleep(backoff(broken))

    def _read_stream(self):
        """Reads until the end of the job (its statusInfo) or of the stream (None)."""
        headers = {"Accept": "text/event-stream"}
        if self._last_event:
            headers["Last-Event-ID"] = self._last_event
        with self._transport.send("GET", self._path + "/events", headers=headers,
                                  timeout=SILENCE) as answer:
            kind = answer.headers.get("Content-Type", "")
            if answer.status != 200 or not kind.startswith("text/event-stream"):
                raise StreamRefused  # asking tells why: gone, ended long ago, too many streams
            for identity, name, data in parse(answer.response):
                self._last_event = identity or self._last_event
                if name == "progress":
                    self._tell({**self._state, **_object(data)})
                elif name in ("status", "end"):
                    self._tell(_object(data))
                if name == "end":
                    return self._state
        return None

    def _by_asking(self):
        while True:
            with self._transport.request("GET", self._path, headers={"Prefer": f"wait={POLL}"},
                                         timeout=POLL + SILENCE) as answer:
                self._tell(answer.json())
            if self._state.get("status") in ENDED:
                return self._state
            time.sleep(0.2)  # also when the server answers at once

    def _tell(self, state):
        self._state = state
        self._listener(state)
