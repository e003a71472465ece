"""A client of the LPF server on the standard library alone.

    from lpf_client import Client

    client = Client("http://127.0.0.1:8080")
    job = client.run("denoise", "in.ply", {"radius": "auto"}, follower=print)
    client.save_result(job["jobID"], "points", "out.ply")

Every failure is an lpf_client.Failure; its subclasses and their exit codes are in errors.py.
"""

from .client import Client
from .errors import (AccessDenied, Busy, CannotSave, Failure, JobFailed, NoServer, Refused,
                     UsageError)

__all__ = ["AccessDenied", "Busy", "CannotSave", "Client", "Failure", "JobFailed", "NoServer",
           "Refused", "UsageError"]
