"""Pictures and programs of the scripts that compare with programs of others. SPDX-License-Identifier: MIT"""

import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import OpenEXR

ROOT = Path(__file__).resolve().parent.parent
HDR = ROOT.parent / "shared" / "data" / "hdr"
WEIGHTS = np.array([0.212639, 0.715169, 0.072192])  # of luminance, Rec. 709


def run(command, **more):
    """Runs a program; what it says on an error ends this one."""
    done = subprocess.run([str(word) for word in command], capture_output=True, **more)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: {done.stderr.decode(errors='replace').strip()}")
    return done.stdout


def read_exr(file):
    channels = OpenEXR.File(str(file), separate_channels=True).channels()
    return np.stack([channels[c].pixels.astype(np.float64) for c in "RGB"], axis=-1)


def write_exr(file, rgb):
    channels = {c: np.ascontiguousarray(rgb[..., i], dtype=np.float32) for i, c in enumerate("RGB")}
    OpenEXR.File({"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}, channels).write(str(file))


def read_picture(file):
    if file.suffix == ".exr":
        return read_exr(file)
    return cv2.imread(str(file), cv2.IMREAD_ANYDEPTH | cv2.IMREAD_COLOR)[..., ::-1].astype(np.float64)


def cleaned(picture):
    return np.maximum(np.nan_to_num(read_picture(picture), nan=0, posinf=0, neginf=0), 0)
