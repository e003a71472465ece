"""What can go wrong, each with the exit code of the command line."""

INTERRUPTED = 130  # Ctrl-C, as shells have it


class Failure(Exception):
    """The server or the network did something unexpected, and trying again did not help."""

    exit_code = 1


class UsageError(Failure):
    """The command or an input is wrong; the same command will never work."""

    exit_code = 2


class NoServer(Failure):
    """Nobody answers at the address, or the connection broke too often."""

    exit_code = 3


class Refused(Failure):
    """The file cannot be read, or the server does not take it."""

    exit_code = 4


class Busy(Failure):
    """The queue is full or the quota used up, and stayed so over all tries."""

    exit_code = 5


class JobFailed(Failure):
    """The job was accepted, but failed or was dismissed by somebody."""

    exit_code = 6


class AccessDenied(Failure):
    """An API key is missing or not good enough."""

    exit_code = 7


class CannotSave(Failure):
    """A result could not be written, or is not what the server announced."""

    exit_code = 8


def printable(text):
    """Without control characters: text of a server must not steer a terminal."""
    return "".join(c if c.isprintable() or c == "\n" else "?" for c in str(text))


def describe(problem):
    """A problem document (RFC 9457) as text: title, detail, and what else was wrong."""
    title, detail = problem.get("title", ""), problem.get("detail", "")
    lines = [f"{title}: {detail}" if title and detail else title or detail or "no reason was given"]
    for error in problem.get("errors", []):
        if error.get("detail") != detail:
            lines.append(f"  {error.get('pointer', '')}: {error.get('detail', '')}")
    return printable("\n".join(lines))


def failure_of(status, problem):
    """The exception for a refusal, by its HTTP status and problem document."""
    if status in (401, 403):
        kind = AccessDenied
    elif status in (429, 503):
        kind = Busy
    elif status in (502, 504):
        kind = NoServer
    elif status >= 500:
        kind = Failure
    elif problem.get("code") == "invalid-parameter":
        kind = UsageError
    else:
        kind = Refused
    failure = kind(describe(problem))
    failure.status = status
    failure.problem = problem
    return failure
