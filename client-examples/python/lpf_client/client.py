"""The operations of the service, for programs and for the command line."""

import os
import uuid

from .download import download
from .errors import Failure, Refused
from .events import Follower
from .transport import FileBody, Transport


def _ignore(*_):
    pass


class Client:
    """One LPF server. Options as of Transport: api_key, retries, timeout, notice."""

    def __init__(self, server="http://127.0.0.1:8080", **options):
        self._transport = Transport(server, **options)

    def get(self, path, **query):
        """GET as JSON."""
        with self._transport.request("GET", path, query=query) as answer:
            return answer.json()

    def processes(self):
        """IDs of what the server can do."""
        return [process["id"] for process in self.get("/v1/processes").get("processes", [])]

    def inputs(self, process):
        """{name: description} of a process's inputs but the shape, each with its schema."""
        inputs = self.get(f"/v1/processes/{process}").get("inputs", {})
        return {name: entry for name, entry in inputs.items() if name != "shape"}

    def submit(self, process, path, values, uploaded=_ignore):
        """Sends a file as a job; its statusInfo. However often it is sent, it makes one job."""
        return self._post(f"/v1/processes/{process}/execution", path, values, uploaded,
                          {"Idempotency-Key": str(uuid.uuid4())})

    def validate(self, process, path, values, uploaded=_ignore):
        """What a job would do: resolved parameters, estimate, warnings. Makes none."""
        return self._post(f"/v1/processes/{process}/validate", path, values, uploaded, {})

    def _post(self, target, path, values, uploaded, headers):
        try:
            size = os.path.getsize(path)
            open(path, "rb").close()
        except OSError as error:
            raise Refused(f"{path} cannot be read: {error.strerror}") from error
        headers.update({"Content-Type": "application/octet-stream", "Content-Length": str(size)})
        with self._transport.request("POST", target, lambda: FileBody(path, size, uploaded),
                                     query=values, headers=headers) as answer:
            job = answer.json()
        if not job:
            raise Failure("The answer to the upload is no JSON; is this an LPF server?")
        return job

    def follow(self, job_id, follower=_ignore, events=True):
        """Waits for a job; its final statusInfo. JobFailed if it did not succeed."""
        return Follower(self._transport, job_id, follower).run(events)

    def run(self, process, path, values, follower=_ignore, uploaded=_ignore):
        """submit() and follow()."""
        return self.follow(self.submit(process, path, values, uploaded)["jobID"], follower)

    def save_result(self, job_id, name, path, downloaded=_ignore):
        """Writes points, dictionary, report or fields to a file; the number of bytes."""
        results = self.get(f"/v1/jobs/{job_id}/results")
        if name not in results:
            raise Refused(f"The job has no {name}; it has: {', '.join(sorted(results))}.")
        return download(self._transport, results[name], path, downloaded)

    def cancel(self, job_id):
        """Dismisses a job: a waiting one never starts, a running one stops within a second."""
        with self._transport.request("DELETE", f"/v1/jobs/{job_id}", timeout=10) as answer:
            return answer.json()

    def jobs(self, limit=20, **filters):
        """The newest jobs; filters are status and processID."""
        return self.get("/v1/jobs", limit=limit, **filters).get("jobs", [])
