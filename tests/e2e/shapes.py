"""Shapes and files for the tests, made in plain Python, and a reader for what comes back."""

import math
import random
import struct

SIZES = {"char": "b", "uchar": "B", "short": "h", "ushort": "H", "int": "i", "uint": "I",
         "float": "f", "double": "d"}


def header(count, properties, kind="binary_little_endian", extra=""):
    lines = "".join(f"property {kind_} {name}\n" for kind_, name in properties)
    return f"ply\nformat {kind} 1.0\nelement vertex {count}\n{lines}{extra}end_header\n".encode()


def binary_ply(rows, properties):
    row = struct.Struct("<" + "".join(SIZES[kind] for kind, _ in properties))
    return header(len(rows), properties) + b"".join(row.pack(*r) for r in rows)


def noisy_sphere(count=1500, noise=0.01, seed=1):
    """Points near a sphere of radius 1, with colours, an intensity and their number."""
    dice = random.Random(seed)
    rows = []
    for number in range(count):
        z = dice.uniform(-1, 1)
        angle = dice.uniform(0, 2 * math.pi)
        radius = 1 + dice.gauss(0, noise)
        flat = math.sqrt(1 - z * z)
        rows.append((radius * flat * math.cos(angle), radius * flat * math.sin(angle), radius * z,
                     number % 256, 7, 255, number / 2, number))
    return binary_ply(rows, [("float", "x"), ("float", "y"), ("float", "z"), ("uchar", "red"),
                             ("uchar", "green"), ("uchar", "blue"), ("float", "intensity"),
                             ("int", "number")])


def ascii_ply(points, count=None):
    text = "".join(f"{x} {y} {z}\n" for x, y, z in points)
    properties = [("float", axis) for axis in "xyz"]
    return header(len(points) if count is None else count, properties, "ascii") + text.encode()


def read_ply(data):
    """Vertex rows of a binary PLY without lists, as dictionaries."""
    head, _, body = data.partition(b"end_header\n")
    lines = head.decode().splitlines()
    assert lines[0] == "ply" and lines[1] == "format binary_little_endian 1.0"
    start = next(i for i, line in enumerate(lines) if line.startswith("element vertex"))
    count = int(lines[start].split()[2])
    properties = []
    for line in lines[start + 1:]:
        if line.startswith("element"):
            break
        properties.append(line.split()[1:])
    row = struct.Struct("<" + "".join(SIZES[kind] for kind, _ in properties))
    names = [name for _, name in properties]
    return [dict(zip(names, row.unpack_from(body, i * row.size))) for i in range(count)]


def radius_error(rows):
    """Root of the mean squared distance to the sphere of radius 1."""
    squares = [(math.hypot(r["x"], r["y"], r["z"]) - 1) ** 2 for r in rows]
    return math.sqrt(sum(squares) / len(squares))
