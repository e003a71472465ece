"""Command-line options made from the server's own description of a process's inputs."""

import re

from .errors import UsageError


def option_names(name):
    """--radiusUnit and --radius-unit."""
    dashed = re.sub(r"(?<=[a-z0-9])[A-Z]", lambda m: "-" + m.group().lower(), name)
    return list(dict.fromkeys(["--" + dashed, "--" + name]))


def _allowed(schema):
    """What an input may be, in a few words: keep|drop, integer 1..256, number > 0."""
    if "enum" in schema:
        return "|".join(str(value) for value in schema["enum"])
    if "oneOf" in schema:
        return " or ".join(_allowed(choice) for choice in schema["oneOf"])
    if "const" in schema:
        return str(schema["const"])
    text = schema.get("type", "value")
    low, high = schema.get("minimum"), schema.get("maximum")
    if low is not None and high is not None:
        return f"{text} {low}..{high}"
    for key, sign in (("minimum", ">="), ("exclusiveMinimum", ">"), ("maximum", "<=")):
        if key in schema:
            text += f" {sign} {schema[key]}"
    return text


def _help(entry):
    schema = entry.get("schema", {})
    unit = schema.get("x-unit")
    parts = [entry.get("title", "") + (f" [{unit}]" if unit else "") + ".",
             entry.get("description", ""), f"({_allowed(schema)})", schema.get("x-auto", "")]
    return " ".join(part for part in parts if part).replace("%", "%%")  # argparse formats it


def add_options(parser, inputs):
    """Adds an option for each input. A name that the parser has already is left to --set."""
    group = parser.add_argument_group("inputs, as this server describes them")
    for name, entry in inputs.items():
        taken = parser._option_string_actions  # argparse has no public way to ask
        flags = [flag for flag in option_names(name) if flag not in taken]
        if flags:
            group.add_argument(*flags, dest="input_" + name, metavar="VALUE", help=_help(entry))


def values_of(arguments, inputs):
    """{input: text} that the user gave. The server judges the values, and says what is wrong."""
    values = {}
    for setting in arguments.set:
        name, equals, value = setting.partition("=")
        if not equals or name not in inputs:
            raise UsageError(f"--set {setting}: give NAME=VALUE; the names are "
                             f"{', '.join(sorted(inputs))}")
        values[name] = value
    for name in inputs:
        value = getattr(arguments, "input_" + name, None)
        if value is not None:
            values[name] = value
    return values


def format_for(source, target, inputs):
    """{"format": ...} if the name of the result asks for another format than the file has."""
    suffix = target.rpartition(".")[2].lower()
    if suffix not in inputs.get("format", {}).get("schema", {}).get("enum", []):
        return {}
    with open(source, "rb") as file:
        is_draco = file.read(5) == b"DRACO"
    return {"format": suffix} if is_draco != (suffix == "drc") else {}
