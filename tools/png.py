"""8-bit RGB PNG files, as deltalux writes them, with the standard library alone."""
import pathlib
import struct
import sys
import zlib


def fail(message):
    sys.exit(f"{pathlib.Path(sys.argv[0]).name}: {message}")


def unfilter(kind, line, above, step):
    for i in range(len(line)):
        left = line[i - step] if i >= step else 0
        up = above[i]
        corner = above[i - step] if i >= step else 0
        if kind == 1:
            line[i] = line[i] + left & 255
        elif kind == 2:
            line[i] = line[i] + up & 255
        elif kind == 3:
            line[i] = line[i] + (left + up) // 2 & 255
        elif kind == 4:
            guess = left + up - corner
            near = min((abs(guess - left), 0, left), (abs(guess - up), 1, up), (abs(guess - corner), 2, corner))
            line[i] = line[i] + near[2] & 255
        elif kind:
            fail(f"unknown PNG filter {kind}")
    return line


def read(path):
    try:
        data = open(path, "rb").read()
    except OSError as error:
        fail(f"{path}: {error.strerror}")
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        fail(f"{path}: is no PNG file")
    at, packed, size = 8, b"", None
    while at < len(data):
        length, name = struct.unpack(">I4s", data[at : at + 8])
        body = data[at + 8 : at + 8 + length]
        if name == b"IHDR":
            width, height, depth, colour, _, _, interlaced = struct.unpack(">IIBBBBB", body)
            if (depth, colour, interlaced) != (8, 2, 0):
                fail(f"{path}: is not 8-bit RGB without interlacing")
            size = width, height
        elif name == b"IDAT":
            packed += body
        at += 12 + length
    width, height = size
    raw = zlib.decompress(packed)
    lines, above = [], bytearray(3 * width)
    for y in range(height):
        start = y * (3 * width + 1)
        above = unfilter(raw[start], bytearray(raw[start + 1 : start + 1 + 3 * width]), above, 3)
        lines.append(above)
    return size, lines


def write(path, width, lines):
    def chunk(name, body):
        return struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))

    raw = b"".join(b"\0" + bytes(line) for line in lines)
    with open(path, "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n")
        out.write(chunk(b"IHDR", struct.pack(">IIBBBBB", width, len(lines), 8, 2, 0, 0, 0)))
        out.write(chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))
