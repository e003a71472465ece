"""The command line: what is asked for, with the inputs that the server itself describes."""

import argparse
import os

from .inputs import add_options

CODES = """\
exit codes:
  0  done
  1  something unexpected at the server
  2  usage: a wrong command, option or input
  3  no server: nobody answers, or the connection broke too often
  4  bad file: it cannot be read, or the server does not take it
  5  busy: the queue was full or the quota used up, over all tries
  6  the job failed, or was dismissed by somebody
  7  an API key is missing or not good enough
  8  a result could not be written, or was damaged on its way
  130  interrupted by Ctrl-C; the job was cancelled
"""

COMMANDS = """\
commands:
  denoise|resample|analyze FILE -o RESULT   run a job and fetch what it gives
  validate PROCESS FILE                     what a job would do, and how long it would take
  jobs                                      the newest jobs
  cancel JOB ...                            take jobs back
'COMMAND --help' shows its options; those of a process come from the server.
"""


def _common():
    parser = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    parser.add_argument("--server", metavar="URL",
                        default=os.environ.get("LPF_URL") or "http://127.0.0.1:8080",
                        help="address of the service; else $LPF_URL, else http://127.0.0.1:8080")
    parser.add_argument("--api-key", metavar="KEY", default=os.environ.get("LPF_API_KEY"),
                        help="else $LPF_API_KEY, which other users of the machine cannot see")
    parser.add_argument("--retries", type=_count, default=5, metavar="N",
                        help="times that a request is tried again (default 5)")
    parser.add_argument("-q", "--quiet", action="store_true", help="print results and errors only")
    return parser


def _count(text):
    value = int(text)
    if value < 0:
        raise ValueError
    return value


def parse_command(argv):
    """(command, common options): what is needed to ask the server for the rest."""
    first = argparse.ArgumentParser(
        prog="lpf_client.py", parents=[_common()], allow_abbrev=False, add_help=False,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        description="Denoises, resamples and analyses 3D scans with an LPF server.",
        epilog=COMMANDS + "\n" + CODES)
    first.add_argument("command", nargs="?")
    known, rest = first.parse_known_args(argv)
    if known.command is None:
        if not {"-h", "--help"} & set(rest):
            first.error("a command is missing; --help lists them")
        first.print_help()
        first.exit()
    return known.command, known


def _parser(command, about):
    parser = argparse.ArgumentParser(
        prog="lpf_client.py " + command, parents=[_common()], allow_abbrev=False,
        formatter_class=argparse.RawDescriptionHelpFormatter, description=about, epilog=CODES)
    return parser


def _parse(parser, argv, command):
    """Parses what is left of argv without the command itself."""
    argv = list(argv)
    argv.remove(command)
    return parser.parse_args(argv)


def parse_jobs(argv):
    """Of `jobs`."""
    parser = _parser("jobs", "Lists the newest jobs.")
    parser.add_argument("--status", help="only those that are so")
    parser.add_argument("--process", metavar="ID", help="only those of a process")
    parser.add_argument("--limit", type=_count, default=20, help="how many (default 20)")
    parser.add_argument("--json", action="store_true", help="print the server's answer")
    return _parse(parser, argv, "jobs")


def parse_cancel(argv):
    """Of `cancel`."""
    parser = _parser("cancel", "Dismisses jobs.")
    parser.add_argument("job", nargs="+", help="ID of a job")
    return _parse(parser, argv, "cancel")


def _add_inputs(parser, inputs):
    parser.add_argument("--set", action="append", default=[], metavar="NAME=VALUE",
                        help="any input by its name, also one whose option means something else")
    add_options(parser, inputs)


def parse_validate(argv, process, inputs):
    """Of `validate PROCESS`."""
    parser = _parser("validate " + process, "Tells what a job would do, without making one.")
    parser.add_argument("file", help="PLY or Draco")
    parser.add_argument("--json", action="store_true", help="print the server's answer")
    _add_inputs(parser, inputs)
    argv = list(argv)
    argv.remove("validate")
    return _parse(parser, argv, process)


def parse_process(argv, process, inputs):
    """Of a process. --dictionary and such name files here; --set dictionary=ID is the input."""
    parser = _parser(process, "Sends a file as a job, follows it, and fetches its results.")
    parser.add_argument("file", help="PLY or Draco")
    parser.add_argument("-o", "--output", metavar="FILE", help="where the points go")
    for name, what in (("dictionary", "learned dictionary (JSON)"),
                       ("report", "report (JSON)"), ("fields", "local probing fields (PLY)")):
        parser.add_argument("--" + name, metavar="FILE", help=f"where to save the {what}")
    parser.add_argument("--no-events", action="store_true",
                        help="ask for progress instead of reading the event stream")
    _add_inputs(parser, inputs)
    return _parse(parser, argv, process)
