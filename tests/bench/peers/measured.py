"""Runs a program with a limit of CPU time; tells what it took of time and memory."""

import os
import resource
import signal
import subprocess
from dataclasses import dataclass


@dataclass
class Usage:
    cpu_seconds: float   # user and system, the program and all that it started and waited for
    memory_bytes: int    # largest resident set of any one of these processes
    outcome: str         # "ok", or what became of the program


def _limit_cpu(seconds):
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds + 5))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def outcome_of(status, cpu_limit):
    """What a wait status says, in words."""
    if os.WIFSIGNALED(status):
        number = os.WTERMSIG(status)
        if number in (signal.SIGXCPU, signal.SIGKILL):
            return f"stopped after {cpu_limit} CPU s"
        return f"crashed: {signal.Signals(number).name}"
    code = os.waitstatus_to_exitcode(status)
    return "ok" if code == 0 else f"failed: exit code {code}"


def wait_for(process, cpu_limit=0):
    """Usage of a started subprocess.Popen once it has ended."""
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    return Usage(used.ru_utime + used.ru_stime, used.ru_maxrss * 1024,
                 outcome_of(status, cpu_limit))


def run(command, cpu_limit, log):
    """Runs `command` to its end, its words going to the file `log`."""
    with open(log, "wb") as words:
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=words,
                                   stderr=subprocess.STDOUT,
                                   preexec_fn=lambda: _limit_cpu(cpu_limit))
    return wait_for(process, cpu_limit)
