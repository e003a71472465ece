"""The command-line tool: each command, and how failures end it."""

import json
import os
import sys
import time

from . import arguments
from .client import Client
from .errors import INTERRUPTED, CannotSave, Failure, UsageError, printable
from .inputs import format_for, values_of
from .progress import Progress, duration, size


class Session:
    """One run of the tool: the client, the line of progress, the job to cancel if interrupted."""

    def __init__(self, options):
        self.progress = Progress(options.quiet)
        self.client = Client(options.server, api_key=options.api_key, retries=options.retries,
                             notice=self.progress.say)
        self.job_id = None

    def cancel(self):
        """What Ctrl-C does: takes the job back, as far as there is one."""
        if self.job_id is None:
            return "Interrupted."
        try:
            self.client.cancel(self.job_id)
            return f"Interrupted; job {self.job_id} is cancelled."
        except Failure as failure:
            return f"Interrupted; job {self.job_id} could not be cancelled. {failure}"


def main(argv=None):
    """Runs the command; its exit code."""
    argv = sys.argv[1:] if argv is None else argv
    command, options = arguments.parse_command(argv)
    session = None
    try:
        session = Session(options)
        with session.progress:
            _COMMANDS.get(command, _run_process)(session, command, argv)
        return 0
    except KeyboardInterrupt:
        print(session.cancel() if session else "Interrupted.", file=sys.stderr)
        return INTERRUPTED
    except Failure as failure:
        print(f"lpf_client.py: {failure}", file=sys.stderr)
        return failure.exit_code


def _inputs_of(session, process):
    """The inputs of a process; UsageError with the names of all if there is none such."""
    processes = session.client.processes()
    if process not in processes:
        raise UsageError(f"there is no command or process {process!r}; the server has "
                         f"{', '.join(processes)}, and validate, jobs and cancel")
    return session.client.inputs(process)


def _run_process(session, process, argv):
    inputs = _inputs_of(session, process)
    asked = arguments.parse_process(argv, process, inputs)
    wanted = {"points": asked.output, "dictionary": asked.dictionary, "report": asked.report,
              "fields": asked.fields}
    wanted = {name: path for name, path in wanted.items() if path}
    _check_targets(process, wanted)
    values = values_of(asked, inputs)
    if asked.output and "format" not in values and os.path.isfile(asked.file):
        values.update(format_for(asked.file, asked.output, inputs))
    begin = time.monotonic()
    progress = session.progress
    job = session.client.submit(process, asked.file, values, progress.transfer("upload"))
    session.job_id = job["jobID"]
    progress.say(f"job {session.job_id}")
    job = session.client.follow(session.job_id, progress.job, events=not asked.no_events)
    for warning in job.get("warnings", []):
        progress.say(f"warning: {warning.get('detail', '')}")
    for name, path in wanted.items():
        count = session.client.save_result(session.job_id, name, path,
                                           progress.transfer("download"))
        progress.clear()
        print(f"{path}: {name}, {size(count)}")
    progress.say(f"{process} took {duration(time.monotonic() - begin)}")


def _check_targets(process, wanted):
    """Says before the work, not after it, that its results would have nowhere to go."""
    if not wanted:
        raise UsageError(f"{process} would be done for nothing; say where its results go: "
                         "-o FILE, --dictionary FILE, --report FILE or --fields FILE")
    if process == "analyze" and "points" in wanted:
        raise UsageError("analyze gives no points; ask for --dictionary, --report or --fields")
    for path in wanted.values():
        folder = os.path.dirname(os.path.abspath(path))
        if not os.path.isdir(folder):
            raise CannotSave(f"there is no folder {folder} for {os.path.basename(path)}")


def _validate(session, command, argv):
    rest = argv[argv.index(command) + 1:]
    process = next((word for word in rest if not word.startswith("-")), None)
    if process is None:
        raise UsageError("validate needs a process and a file")
    inputs = _inputs_of(session, process)
    asked = arguments.parse_validate(argv, process, inputs)
    answer = session.client.validate(process, asked.file, values_of(asked, inputs),
                                     session.progress.transfer("upload"))
    session.progress.clear()
    if asked.json:
        print(json.dumps(answer, indent=2))
        return
    for name, chosen in answer.get("resolvedParameters", {}).items():
        value = chosen.get("value")
        text = f"{value:.6g}" if isinstance(value, (int, float)) else value
        print(printable(f"{name} = {text}  ({chosen.get('source')}: {chosen.get('rule')})"))
    estimate = answer.get("estimate", {})
    print(f"about {duration(estimate.get('seconds', 0))}, "
          f"{size(estimate.get('memoryBytes', 0))} of memory, "
          f"{estimate.get('outputPoints', 0)} points in the result")
    for warning in answer.get("warnings", []):
        print(printable(f"warning: {warning.get('detail', '')}"))


def _jobs(session, _, argv):
    asked = arguments.parse_jobs(argv)
    filters = {"status": asked.status, "processID": asked.process}
    jobs = session.client.jobs(asked.limit, **{k: v for k, v in filters.items() if v})
    if asked.json:
        print(json.dumps(jobs, indent=2))
        return
    for job in jobs:
        print(printable(f"{job['jobID']}  {job['processID']:<9} {job['status']:<11}"
                        f"{job.get('progress', 0):3.0f} %  {job['created']}"))


def _cancel(session, _, argv):
    for job_id in arguments.parse_cancel(argv).job:
        job = session.client.cancel(job_id)
        print(printable(f"{job_id}  {job.get('status')}"))


_COMMANDS = {"validate": _validate, "jobs": _jobs, "cancel": _cancel}
