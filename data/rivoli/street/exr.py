"""Writes RGB pictures in half floats as OpenEXR: scan lines in blocks of 16, deflated."""

import struct
import zlib

import numpy as np

_ZIP, _HALF, _LINES = 3, 1, 16


def write_exr(path, luminance, white_luminance=1.0):
    """``luminance`` has shape (rows, columns, 3), linear Rec. 709; 1 means ``white_luminance`` cd/m2."""
    rows, columns, _ = luminance.shape
    window = struct.pack("<4i", 0, 0, columns - 1, rows - 1)
    channels = b"".join(name + b"\0" + struct.pack("<iB3xii", _HALF, 0, 1, 1) for name in (b"B", b"G", b"R")) + b"\0"
    header = struct.pack("<ii", 20000630, 2) + b"".join(
        name + b"\0" + kind + b"\0" + struct.pack("<i", len(value)) + value
        for name, kind, value in (
            (b"channels", b"chlist", channels),
            (b"compression", b"compression", bytes([_ZIP])),
            (b"dataWindow", b"box2i", window),
            (b"displayWindow", b"box2i", window),
            (b"lineOrder", b"lineOrder", b"\0"),
            (b"pixelAspectRatio", b"float", struct.pack("<f", 1.0)),
            (b"screenWindowCenter", b"v2f", struct.pack("<2f", 0.0, 0.0)),
            (b"screenWindowWidth", b"float", struct.pack("<f", 1.0)),
            (b"whiteLuminance", b"float", struct.pack("<f", white_luminance)),
        )
    )
    planes = np.ascontiguousarray(luminance[:, :, ::-1].transpose(0, 2, 1)).astype("<f2")  # rows of B, G, R
    blocks = [_deflated(planes[row : row + _LINES].tobytes()) for row in range(0, rows, _LINES)]
    place = len(header) + 1 + 8 * len(blocks)
    offsets, chunks = b"", b""
    for index, block in enumerate(blocks):
        offsets += struct.pack("<Q", place + len(chunks))
        chunks += struct.pack("<ii", index * _LINES, len(block)) + block
    path.write_bytes(header + b"\0" + offsets + chunks)


def _deflated(raw):
    """Even bytes before odd ones, differences of neighbours, deflated; or as it was where that is not smaller."""
    data = np.frombuffer(raw, np.uint8)
    apart = np.concatenate([data[0::2], data[1::2]]).astype(np.int16)
    apart[1:] = apart[1:] - apart[:-1] + 128
    packed = zlib.compress((apart & 255).astype(np.uint8).tobytes(), 9)
    return packed if len(packed) < len(raw) else raw
