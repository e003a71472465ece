"""Valid files, and what transport, faulty programs and ill will make of them."""

import re
import struct

INTERESTING = (0, 1, 2, 3, 127, 128, 255, 256, 32767, 65535, 65536, 2 ** 24, 2 ** 31 - 1, 2 ** 31,
               2 ** 32 - 1, 2 ** 32, 2 ** 63, 2 ** 64 - 1, 2 ** 64, -1)
WORDS = (b"float", b"double", b"uchar", b"int", b"list uchar int", b"list int float",
         b"list uint double", b"x", b"vertex", b"face", b"vertex_indices", b"ascii",
         b"binary_little_endian", b"binary_big_endian", b"end_header", b"comment", b"\r", b"\0")


def flip_bits(data, dice):
    for _ in range(dice.choice((1, 1, 2, 8))):
        data[dice.randrange(len(data))] ^= 1 << dice.randrange(8)


def set_bytes(data, dice):
    for _ in range(dice.choice((1, 2, 16))):
        data[dice.randrange(len(data))] = dice.choice((0, 1, 0x20, 0x7F, 0x80, 0xFF))


def set_number(data, dice):
    """A binary number, where one may lie."""
    kind = dice.choice(("<H", "<I", ">I", "<f", "<d", "<Q"))
    value = dice.choice(INTERESTING) if kind[1] not in "fd" else dice.choice(
        (float("nan"), float("inf"), -1e308, 1e-310, 3e38, 0.0))
    if kind == "<f" and abs(value) > 3.4e38:
        value = float("inf")
    if kind[1] not in "fd":
        value %= 2 ** (8 * struct.calcsize(kind))
    packed = struct.pack(kind, value)
    at = dice.randrange(len(data))
    data[at:at + len(packed)] = packed


def truncate(data, dice):
    del data[dice.randrange(len(data)):]


def cut_out(data, dice):
    at = dice.randrange(len(data))
    del data[at:at + dice.choice((1, 2, 4, 100))]


def repeat(data, dice):
    at = dice.randrange(len(data))
    piece = data[at:at + dice.choice((1, 3, 17, 300))]
    data[at:at] = piece * dice.choice((1, 2, 50))


def edit_header(data, dice):
    """Numbers and words of a PLY header, or the head of a Draco stream."""
    if data[:5] == b"DRACO":
        at = dice.randrange(5, min(len(data), 24)) if len(data) > 5 else 0
        value = dice.choice((0, 1, 2, 3, 4, 0x7F, 0x80, 0xFF, dice.randrange(256)))
        data[at:at + 1] = bytes([value])
        return
    end = data.find(b"end_header")
    tokens = list(re.finditer(rb"\S+", bytes(data[:max(end, 0)])))
    if not tokens:
        return
    token = dice.choice(tokens)
    new = str(dice.choice(INTERESTING)).encode() if token[0].isdigit() or dice.random() < 0.2 \
        else dice.choice(WORDS)
    data[token.start():token.end()] = new


def splice(data, dice, other):
    """The beginning of this file and the end of another."""
    at = dice.randrange(len(data))
    data[at:] = other[dice.randrange(len(other)):]


PLAIN = (flip_bits, set_bytes, set_number, truncate, cut_out, repeat, edit_header, edit_header)


def mutated(seeds, dice):
    """One of the seeds after one to four accidents."""
    data = bytearray(dice.choice(seeds))
    for _ in range(dice.choice((1, 1, 1, 2, 4))):
        if not data:
            break
        if dice.random() < 0.1:
            splice(data, dice, dice.choice(seeds))
        else:
            dice.choice(PLAIN)(data, dice)
    return bytes(data)


def ply_seeds(count=40):
    """Every kind of PLY, with lists, faces, other elements and comments."""
    points = [(i % 8 + 0.25 * (i % 3), i // 8, 0.125 * (i % 5)) for i in range(count)]
    faces = [(i, i + 1, i + 8) for i in range(count - 8)]
    head = "comment made for a test\nobj_info 1\n"
    kinds = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
    files = []
    for kind, order in kinds.items():
        text = (f"ply\nformat {kind} 1.0\n{head}element vertex {count}\nproperty float x\n"
                "property double y\nproperty float z\nproperty uchar red\n"
                "property list uchar short near\n"
                f"element face {len(faces)}\nproperty list uchar int vertex_indices\n"
                "element edge 2\nproperty int vertex1\nproperty int vertex2\nend_header\n")
        if not order:
            body = "".join(f"{x} {y} {z} {i} 2 {i} -1\n" for i, (x, y, z) in enumerate(points))
            body += "".join("3 {} {} {}\n".format(*f) for f in faces) + "0 1\n1 2\n"
            files.append((text + body).encode())
            continue
        body = b"".join(struct.pack(order + "fdfBBhh", x, y, z, i, 2, i, -1)
                        for i, (x, y, z) in enumerate(points))
        body += b"".join(struct.pack(order + "B3i", 3, *f) for f in faces)
        files.append(text.encode() + body + struct.pack(order + "4i", 0, 1, 1, 2))
    plain = (f"ply\nformat binary_little_endian 1.0\nelement vertex {count}\nproperty float x\n"
             "property float y\nproperty float z\nend_header\n").encode()
    files.append(plain + b"".join(struct.pack("<3f", *p) for p in points))
    return files
