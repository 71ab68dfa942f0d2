#!/usr/bin/env python3
"""Tone-maps a numpy array through the C interface. SPDX-License-Identifier: MIT

    python3 tonemap.py [libvesper-c.so] OUT.ppm
"""
import ctypes as c
import sys

import numpy as np

OPERATORS = ["irawan", "ward", "reinhard", "linear", None, "pattanaik", "ferwerda", "durand", "grave",
             "drago", "devlin", "neutral"]


class Error(c.Structure):
    _fields_ = [("message", c.c_char * 1024)]


class Sized(c.Structure):
    """A structure that begins with its size, as all of vesper.h do."""

    def __init__(self, **values):
        super().__init__(size=c.sizeof(self), **values)


class ToneSettings(Sized):
    _fields_ = [("size", c.c_uint32), ("tone_operator", c.c_uint32), ("glare", c.c_uint32), ("bins", c.c_uint32), ("age", c.c_float),
                ("pigmentation", c.c_float), ("gaze", c.c_float * 2), ("colour_loss", c.c_int32), ("acuity_loss", c.c_int32),
                ("purkinje", c.c_int32), ("display", c.c_char_p), ("display_peak", c.c_float), ("display_black", c.c_float),
                ("display_ambient", c.c_float), ("display_gamma", c.c_float), ("display_reflection", c.c_float), ("adapt_to", c.c_uint32),
                ("smoothing", c.c_float), ("low_vision", c.c_float), ("rods", c.c_int32), ("histogram_low", c.c_float),
                ("histogram_high", c.c_float), ("key", c.c_float), ("white", c.c_float), ("black", c.c_float), ("pupil", c.c_uint32),
                ("eye_seed", c.c_uint32), ("lashes", c.c_int32), ("gamut", c.c_uint32), ("options", c.c_char_p)]


class Picture(Sized):
    _fields_ = [("size", c.c_uint32), ("width", c.c_uint32), ("height", c.c_uint32), ("channels", c.c_uint32),
                ("values", c.POINTER(c.c_float)), ("scale", c.c_float), ("vertical_fov", c.c_float), ("edges", c.c_float * 4)]


class Outputs(Sized):
    _fields_ = [("size", c.c_uint32), ("codes", c.POINTER(c.c_uint8)), ("luminance", c.POINTER(c.c_float)),
                ("display_light", c.POINTER(c.c_float)), ("report", c.c_void_p)]


def picture_of(luminance, vertical_fov):
    """`luminance`: height x width x 3, cd/m^2; `vertical_fov`: angle of its height, rad."""
    values = np.ascontiguousarray(luminance, np.float32)
    height, width, channels = values.shape
    picture = Picture(width=width, height=height, channels=channels, values=values.ctypes.data_as(c.POINTER(c.c_float)), scale=1.0,
                      vertical_fov=vertical_fov)
    picture.array = values  # kept as long as the picture
    return picture


class ToneMapper:
    """Maps pictures, each for itself or one after the other with an eye that adapts from each to the next."""

    def __init__(self, library="libvesper-c.so"):
        self.calls = c.CDLL(library)
        self.device, self.mapper = c.c_void_p(), c.c_void_p()
        try:
            self.check(self.calls.vesper_device_open, None, c.byref(self.device))
            self.check(self.calls.vesper_tone_mapper_create, self.device, c.byref(self.mapper))
        except RuntimeError:
            self.close()
            raise

    def check(self, call, *arguments):
        error = Error()
        if call(*arguments, c.byref(error)) != 0:
            raise RuntimeError(error.message.decode())

    def close(self):
        self.calls.vesper_tone_mapper_destroy(self.mapper)
        self.calls.vesper_device_close(self.device)
        self.device, self.mapper = c.c_void_p(), c.c_void_p()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def settings(self, operator="irawan", **settings):
        """The defaults, but for these."""
        tone = ToneSettings()
        self.calls.vesper_tone_settings_defaults(c.byref(tone), c.c_size_t(c.sizeof(tone)))
        tone.tone_operator = OPERATORS.index(operator)
        for name, value in settings.items():
            if not hasattr(tone, name):
                raise TypeError("there is no setting " + name)
            setattr(tone, name, value)
        return tone

    def map(self, luminance, operator="irawan", seconds=None, vertical_fov=0.7, **settings):
        """`luminance`: height x width x 3, cd/m^2. `seconds` since the picture before, which the eye still sees; None: it has seen none.
        Returns height x width x 4 codes."""
        picture = picture_of(luminance, vertical_fov)
        codes = np.empty((picture.height, picture.width, 4), np.uint8)
        tone = self.settings(operator, **settings)
        if seconds is None:
            self.check(self.calls.vesper_tone_mapper_reset, self.mapper)
        outputs = Outputs(codes=codes.ctypes.data_as(c.POINTER(c.c_uint8)))
        self.check(self.calls.vesper_tone_map, self.mapper, c.byref(tone), c.byref(picture), c.c_float(seconds or 0), c.byref(outputs))
        return codes


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    ramp = np.geomspace(1e-3, 1e4, 512, dtype=np.float32)
    with ToneMapper(*sys.argv[1:-1]) as mapper:
        codes = mapper.map(np.broadcast_to(ramp[None, :, None], (128, 512, 3)))
    with open(sys.argv[-1], "wb") as file:
        file.write(b"P6\n512 128\n255\n" + codes[:, :, :3].tobytes())
    print("codes", codes[0, 0, 0], "to", codes[0, -1, 0])
