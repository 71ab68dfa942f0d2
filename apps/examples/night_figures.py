#!/usr/bin/env python3
"""What an observer sees in pictures, on numpy arrays, and how much of a night a display shows.
SPDX-License-Identifier: MIT

    python3 night_figures.py [libvesper-c.so] OUT.svg

Petit, Bremond and Vienne ask how well a displayed night stands for the real one in what a driver sees. The figure
answers for a small target: its visibility level (Adrian 1989) over the luminance of its background, in the scene and as
tone operators show it. OUT.svg has the figure, and OUT.csv, beside it, its numbers.
"""
import ctypes as c
import os
import sys

import numpy as np

from tonemap import Sized, ToneMapper, picture_of


class Observer(Sized):
    _fields_ = [("size", c.c_uint32), ("age", c.c_float), ("pigmentation", c.c_float), ("scattered", c.c_int32)]


class Differences(Sized):
    _fields_ = [("size", c.c_uint32), ("x", c.c_uint32), ("y", c.c_uint32), ("largest", c.c_float),
                ("above_half", c.c_float), ("above_75", c.c_float), ("above_95", c.c_float)]


class Fidelity(Sized):
    _fields_ = [("size", c.c_uint32)] + [(name, c.POINTER(c.c_float))
                                         for name in ("seen", "lost", "invented", "amplified")]


class Target(Sized):
    _fields_ = [("size", c.c_uint32), ("arc_minutes", c.c_float), ("seconds", c.c_float), ("age", c.c_float),
                ("veil", c.c_float)]


def floats(array):
    return array.ctypes.data_as(c.POINTER(c.c_float))


class Vision(ToneMapper):
    """A tone mapper, and figures of pictures: height x width x 3, cd/m^2. `observer`: an Observer, or None."""

    def __init__(self, library="libvesper-c.so"):
        self.vision = c.c_void_p()
        super().__init__(library)
        try:
            self.check(self.calls.vesper_vision_create, self.device, c.byref(self.vision))
        except RuntimeError:
            self.close()
            raise

    def close(self):
        self.calls.vesper_vision_destroy(self.vision)
        self.vision = c.c_void_p()
        super().close()

    def compare(self, first, second, vertical_fov, observer=None):
        """Returns height x width probabilities that an observer detects a difference, and Differences."""
        probability, found = np.empty(np.shape(first)[:2], np.float32), Differences()
        self.check(self.calls.vesper_visible_differences, self.vision, observer and c.byref(observer),
                   c.byref(picture_of(first, vertical_fov)), c.byref(picture_of(second, vertical_fov)),
                   floats(probability), c.byref(found))
        return probability, found

    def fidelity(self, scene, shown, vertical_fov, observer=None):
        """Returns, by name, height x width shares of the octaves in which contrast is seen in the scene, lost,
        invented and amplified."""
        maps = {name: np.empty(np.shape(scene)[:2], np.float32) for name, _ in Fidelity._fields_[1:]}
        to = Fidelity(**{name: floats(values) for name, values in maps.items()})
        self.check(self.calls.vesper_contrast_fidelity, self.vision, observer and c.byref(observer),
                   c.byref(picture_of(scene, vertical_fov)), c.byref(picture_of(shown, vertical_fov)), c.byref(to))
        return maps

    def saliency(self, picture):
        """Returns the map, in texels of 16 px, 0 to 1."""
        height, width = np.shape(picture)[:2]
        salient = np.empty(((height + 15) // 16, (width + 15) // 16), np.float32)
        self.check(self.calls.vesper_saliency, self.vision, c.byref(picture_of(picture, 0.7)), floats(salient))
        return salient

    def light_of(self, codes, **settings):
        """`codes`: height x width x 4, as map() returns them with these settings. Returns the light of the display."""
        codes = np.ascontiguousarray(codes, np.uint8)
        height, width, _ = codes.shape
        light = np.empty((height, width, 3), np.float32)
        self.check(self.calls.vesper_light_of_codes, c.byref(self.settings(**settings)), c.c_uint32(width),
                   c.c_uint32(height), codes.ctypes.data_as(c.POINTER(c.c_uint8)), floats(light))
        return light

    def visibility_level(self, luminance, background, arc_minutes=10.0, seconds=0.2, age=23.0, veil=0.0):
        """Of targets on backgrounds, cd/m^2, arrays or numbers."""
        luminance, background = (np.ascontiguousarray(values, np.float32)
                                 for values in np.broadcast_arrays(luminance, background))
        levels = np.empty(luminance.shape, np.float32)
        target = Target(arc_minutes=arc_minutes, seconds=seconds, age=age, veil=veil)
        self.check(self.calls.vesper_visibility_levels, c.byref(target), c.c_size_t(levels.size), floats(luminance),
                   floats(background), floats(levels))
        return levels


PIXELS = 30  # of a degree
FIELD = 3 * PIXELS  # of one background, px
ROWS, COLUMNS = 3, 7
MINUTES, CONTRAST = 10, 0.5  # of the target
BACKGROUNDS = np.geomspace(0.01, 100, ROWS * COLUMNS)  # cd/m^2
VERTICAL_FOV = float(2 * np.arctan(np.radians(ROWS * FIELD / PIXELS) / 2))
SHOWN = ["irawan", "ward", "ferwerda", "grave", "reinhard", "linear"]
COLOURS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"]


def fields():
    """Middles of the fields, px: rows from left to right, each from dark to bright."""
    return [(FIELD * row + FIELD // 2, FIELD * column + FIELD // 2) for row in range(ROWS) for column in range(COLUMNS)]


def chart():
    """Fields of all backgrounds, with a bright target in the middle of each."""
    luminance = np.repeat(np.repeat(BACKGROUNDS.reshape(ROWS, COLUMNS), FIELD, 0), FIELD, 1)
    half = round(MINUTES / 60 * PIXELS) // 2
    for y, x in fields():
        luminance[y - half:y + half + 1, x - half:x + half + 1] *= 1 + CONTRAST
    return np.repeat(luminance[:, :, None], 3, 2)


def targets_of(picture):
    """Luminance of each target and of its background, a degree away from it."""
    luminance = picture @ np.array([0.212639, 0.715169, 0.072192])
    return (np.array([luminance[y, x] for y, x in fields()]),
            np.array([luminance[y, x - PIXELS:x - PIXELS // 2].mean() for y, x in fields()]))


def svg(curves, low=0.1, high=100.0, width=640, height=400):
    """Curves by name, over BACKGROUNDS, on axes of logarithms. What is below the axis lies on it."""
    left, top, inner, tall = 64, 40, width - 200, height - 96

    def point(background, level):
        return (left + inner * np.log10(background / BACKGROUNDS[0]) / np.log10(BACKGROUNDS[-1] / BACKGROUNDS[0]),
                top + tall * (1 - np.log10(np.clip(level, low, high) / low) / np.log10(high / low)))

    def text(x, y, words, anchor="middle", more=""):
        return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" {more}>{words}</text>'

    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" font-family="sans-serif" '
             f'font-size="12"><rect width="100%" height="100%" fill="white"/>',
             text(left, 22, f"Visibility level of a target of {MINUTES}', {CONTRAST:.0%} brighter than its background",
                  "start", 'font-size="14"'),
             text(left + inner / 2, height - 14, "luminance of the background in the scene, cd/m²"),
             text(18, top + tall / 2, "visibility level", more=f'transform="rotate(-90 18 {top + tall / 2})"')]
    for decade in range(-2, 3):
        x, _ = point(10.0**decade, low)
        parts += [f'<path d="M{x:.1f} {top}V{top + tall}" stroke="#ddd"/>',
                  text(x, top + tall + 18, f"{10.0**decade:g}")]
    for decade in range(-1, 3):
        _, y = point(1, 10.0**decade)
        parts += [f'<path d="M{left} {y:.1f}H{left + inner}" stroke="{"#888" if decade == 0 else "#ddd"}"/>',
                  text(left - 8, y + 4, f"{10.0**decade:g}", "end")]
    for i, (name, levels) in enumerate(curves.items()):
        style = 'stroke="black" stroke-dasharray="6 4"' if i == 0 else f'stroke="{COLOURS[i - 1]}"'
        line = " ".join("{:.1f},{:.1f}".format(*point(b, v)) for b, v in zip(BACKGROUNDS, levels))
        y = top + 12 + 20 * i
        parts += [f'<polyline points="{line}" fill="none" stroke-width="2" {style}/>',
                  f'<path d="M{left + inner + 16} {y}h24" stroke-width="2" {style}/>',
                  text(left + inner + 46, y + 4, name, "start")]
    return "\n".join(parts + ["</svg>\n"])


def main(file, *library):
    scene = chart()
    with Vision(*library) as vision:
        curves = {"scene": vision.visibility_level(*targets_of(scene), MINUTES)}
        # Pixels that are told apart from the scene; contrast over that which is seen there; correlation of the maps.
        print("operator    differs  lost  invented  amplified  saliency")
        salient = vision.saliency(scene).ravel()
        for operator in SHOWN:
            shown = vision.light_of(vision.map(scene, operator, vertical_fov=VERTICAL_FOV))
            curves[operator] = vision.visibility_level(*targets_of(shown), MINUTES)
            differs = vision.compare(scene, shown, VERTICAL_FOV)[1].above_half
            maps = vision.fidelity(scene, shown, VERTICAL_FOV)
            kept = {name: values.sum() / maps["seen"].sum() for name, values in maps.items()}
            alike = np.corrcoef(salient, vision.saliency(shown).ravel())[0, 1]
            print(f"{operator:10s} {differs:8.2f} {kept['lost']:5.2f} {kept['invented']:9.2f} "
                  f"{kept['amplified']:10.2f} {alike:9.2f}")
    with open(file, "w", encoding="utf-8") as figure:
        figure.write(svg(curves))
    with open(os.path.splitext(file)[0] + ".csv", "w", encoding="utf-8") as table:
        table.write(",".join(["background_cd_m2", *curves]) + "\n")
        for row in zip(BACKGROUNDS, *curves.values()):
            table.write(",".join(f"{value:.6g}" for value in row) + "\n")


if __name__ == "__main__":
    if len(sys.argv) not in (2, 3) or sys.argv[-1].startswith("-"):
        sys.exit(__doc__)
    main(sys.argv[-1], *sys.argv[1:-1])
