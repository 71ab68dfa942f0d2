"""What scripts/compare-operators runs; see there. SPDX-License-Identifier: MIT

Reinhard 2002    pfstmo_reinhard02, every pixel: at most 1e-4 of white
Pattanaik 2000   pfstmo_pattanaik00, likewise, where vesper has the operator
Ward 1997        Radiance's pcond with the same histogram and bins, the tone curve: at most 0.02 in log10
time             the tone chain of vesper against pfstmo_reinhard02 and OpenCV's TonemapReinhard, 1680 x 1050 px
"""

import argparse
import os
import re
import shutil
import sys
import tempfile
import time
from pathlib import Path

import cv2
import numpy as np
import pyradiance

from compared_pictures import HDR, ROOT, WEIGHTS, cleaned, read_exr, run, write_exr

PICTURES = [HDR / "polyhaven/potsdamer_platz_1k.hdr", HDR / "polyhaven/pedestrian_overpass_1k.hdr", HDR / "polyhaven/dikhololo_night_1k.hdr",
            HDR / "openexr-images/ScanLines/Desk.exr", HDR / "openexr-images/ScanLines/CandleGlass.exr", HDR / "openexr-tests/comp_zip.exr"]
LOW_BLACK = ["--display-ambient", "0", "--display-peak", "1", "--display-black", "1e-6"]


def pipe(*commands):
    data = None
    for command in commands:
        data = run(command, input=data)
    return data


class Comparison:
    def __init__(self, vesper, folder):
        self.vesper, self.folder, self.rows, self.broken = vesper, folder, [], False
        self.help = run([vesper, "tonemap", "--help-all"]).decode()

    def add(self, what, picture, measured, limit, unit):
        good = measured <= limit
        self.broken |= not good
        self.rows.append((what, picture, f"{measured:.3g}", f"{limit:.3g} {unit}", "good" if good else "BROKEN"))

    def note(self, what, picture, text):
        self.rows.append((what, picture, text, "", ""))

    def print(self):
        widths = [max(len(row[i]) for row in self.rows) for i in range(5)]
        for row in self.rows:
            print("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip())

    def display_light(self, source, *options):
        """cd/m^2 on a display of 1 cd/m^2: the operator's values."""
        made = self.folder / "vesper.exr"
        run([self.vesper, "tonemap", source, "--unit", "1", "-o", made, *LOW_BLACK, *options])
        return (read_exr(made) - 1e-6) / (1 - 1e-6)

    def given(self, *options):
        """Options with their values, where vesper has all of them."""
        return options if all(o in self.help for o in options if o.startswith("--")) else ()

    def pfstmo(self, source, *operator):
        # Halves and lossy compression are the defaults of pfsoutexr.
        made = self.folder / "pfs.exr"
        pipe(["pfsinexr", source], list(operator), ["pfsoutexr", "--float32", "--compression", "ZIP", made])
        return read_exr(made)


def bright_copy(comparison, picture):
    """A copy with a median of 100 cd/m^2 and no luminance under 0.1: pfstmo divides by luminance, and adds 1e-5 to it before
    it takes logarithms where vesper takes max(L, 1e-4). So neither matters."""
    rgb = cleaned(picture)
    luminance = rgb @ WEIGHTS
    rgb = rgb * (100 / np.median(luminance[luminance > 0])) + 0.1
    made = comparison.folder / "bright.exr"
    write_exr(made, rgb)
    return made, rgb.astype(np.float32).astype(np.float64)


def compare_reinhard(comparison, picture):
    source, rgb = bright_copy(comparison, picture)
    options = "--operator", "reinhard", "--key", "0.18"
    difference = comparison.display_light(source, *options) - comparison.pfstmo(source, "pfstmo_reinhard02", "--key", "0.18")
    comparison.add("Reinhard 2002, in colour", picture.name, np.abs(difference @ WEIGHTS).max(), 1e-4, "of white")
    write_exr(source, np.repeat((rgb @ WEIGHTS)[..., None], 3, axis=-1))
    difference = comparison.display_light(source, *options) - comparison.pfstmo(source, "pfstmo_reinhard02", "--key", "0.18")
    comparison.add("Reinhard 2002", picture.name, np.abs(difference).max(), 1e-4, "of white")
    epsilon = comparison.given("--log-epsilon", "1e-5")
    if epsilon:  # as dark as the picture is; pfstmo divides zero by zero where it is black
        write_exr(source, np.repeat((cleaned(picture) @ WEIGHTS)[..., None], 3, axis=-1))
        difference = comparison.display_light(source, *options, *epsilon) - comparison.pfstmo(source, "pfstmo_reinhard02", "--key", "0.18")
        comparison.add("Reinhard 2002, as it is", picture.name, np.nanmax(np.abs(difference)), 1e-4, "of white")


def compare_pattanaik(comparison, picture):
    # Adapted to 1 cd/m^2: the log average of the frame. Greys, as above; pfstmo has 5e4 where Hunt has 5e5, and ends at white.
    _, rgb = bright_copy(comparison, picture)
    grey = rgb @ WEIGHTS
    source = comparison.folder / "grey.exr"
    write_exr(source, np.repeat((grey / np.exp(np.log(grey).mean()))[..., None], 3, axis=-1))
    got = comparison.display_light(source, "--operator", "pattanaik", *comparison.given("--rod-constant", "5e4"), "--photopic-rods", *comparison.given("--adapt-to", "average"))
    want = comparison.pfstmo(source, "pfstmo_pattanaik00", "--cone", "1", "--rod", "1")
    comparison.add("Pattanaik 2000", picture.name, np.abs(np.clip(got, 0, 1) - want).max(), 1e-4, "of white")


def foveal_votes(luminance, level):
    """log10 of the means over squares of 2^level pixels, and the pixels of each: the histogram that vesper counts."""
    side = 1 << level
    rows, columns = np.arange(0, luminance.shape[0], side), np.arange(0, luminance.shape[1], side)
    total = np.add.reduceat(np.add.reduceat(luminance, rows, 0), columns, 1)
    count = np.add.reduceat(np.add.reduceat(np.ones_like(luminance), rows, 0), columns, 1)
    return np.log10(total / count).ravel(), count.ravel()


def pcond_curve(comparison, votes, weights):
    """Radiance's curve for the same votes, from 1 to 100 cd/m^2: pairs of log10, where its histogram is."""
    # As fine as its reader takes: it sorts them into a hundred bins of its own.
    counts, edges = np.histogram(votes, bins=1000, range=(votes.min(), votes.max()), weights=weights)
    centres = (edges[:-1] + edges[1:]) / 2
    text = "".join(f"{c:.6f} {int(n)}\n" for c, n in zip(centres, counts))
    tools = Path(pyradiance.__file__).parent / "bin"
    grey = comparison.folder / "grey.hdr"
    cv2.imwrite(str(grey), np.full((8, 8, 3), 1, np.float32))
    curve = comparison.folder / "map.txt"
    environment = {**os.environ, "PATH": f"{tools}:{os.environ['PATH']}"}
    for tool in ("pcond", "pfilt"):
        (tools / tool).chmod(0o755)
    run([tools / "pcond", "-I", "-s", "-u", "100", "-d", "100", "-x", curve, grey, comparison.folder / "out.hdr"], input=text.encode(), env=environment)
    return np.log10(np.loadtxt(curve))


def compare_ward(comparison, picture, darkest):
    """The picture scaled so that the darkest of a thousand texels has `darkest` cd/m^2. Without the human threshold (cones and
    rods) the cones' is compared, which is the same from 1 cd/m^2 up."""
    what = f"Ward 1997, from {darkest} cd/m^2"
    level = 3  # 64 pixels a vote
    human = comparison.given("--ceiling", "human", "--whole-votes")
    if not human and darkest < 1:
        return
    rgb = cleaned(picture)
    votes, _ = foveal_votes(np.maximum(rgb @ WEIGHTS, 1e-9), level)
    rgb = rgb * (darkest / 10 ** np.quantile(votes, 0.001))
    source = comparison.folder / "ward.exr"
    write_exr(source, rgb)
    luminance = rgb.astype(np.float32) @ WEIGHTS
    votes, weights = foveal_votes(luminance, level)
    if votes.max() - votes.min() < 2.2:
        comparison.note(what, picture.name, f"spans {votes.max() - votes.min():.1f} decades: pcond is linear there")
        return
    curve = pcond_curve(comparison, votes, weights)
    rising = np.diff(curve[:, 1]) > 1e-6
    if rising.any() and np.ptp((np.diff(curve[:, 1]) / np.diff(curve[:, 0]))[rising][1:-1]) < 0.01:
        comparison.note(what, picture.name, "pcond gave up: it is linear")
        return
    # The same hundred bins.
    step = (curve[-1, 0] - curve[0, 0]) / 99
    low, high = curve[0, 0] - step / 2, curve[-1, 0] + step / 2
    made = comparison.folder / "vesper.exr"
    run([comparison.vesper, "tonemap", source, "--unit", "1", "-o", made, "--operator", "ward", "--foveal-level", level, "--bins", "100",
         "--histogram-low", 10**low, "--histogram-high", 10**high, "--display-peak", "100", "--display-black", "1", "--display-ambient", "0", *human])
    shown = np.log10(read_exr(made) @ WEIGHTS).ravel()
    order = np.argsort(luminance.ravel())
    world = np.log10(np.maximum(luminance.ravel()[order], 1e-9))
    inside = (curve[:, 0] >= max(world[0], np.quantile(votes, 0.001), -3 if human else 0)) & (curve[:, 0] <= min(world[-1], votes.max()))
    distance = np.abs(np.interp(curve[inside, 0], world, shown[order]) - curve[inside, 1])
    comparison.add(what, picture.name, distance.max(), 0.02, "log10")


def fastest(repeat, act):
    best = float("inf")
    for _ in range(repeat):
        start = time.perf_counter()
        act()
        best = min(best, time.perf_counter() - start)
    return 1000 * best


def street(comparison):
    """The night street of data/rivoli at 1680 x 1050."""
    night, made = comparison.folder / "night.gltf", comparison.folder / "street.exr"
    run([comparison.vesper, "convert", ROOT / "data/rivoli/rivoli.gltf", "--photometry", ROOT / "data/rivoli/rivoli.photometry.json", "-o", night])
    run([comparison.vesper, "render", night, "--camera", "driver", "-o", made])
    return made


def vesper_chain(comparison, source, operator):
    """Milliseconds of each pass of the chain, the least of 30 frames; copies between host and device do not belong to it."""
    frames = comparison.folder / "frames"
    frames.mkdir(exist_ok=True)
    for i in range(30):
        target = frames / f"{i}.exr"
        if not target.exists():
            target.symlink_to(source)
    text = run([comparison.vesper, "tonemap", f"{frames}/%d.exr", "--operator", operator, "--stats", "-o", f"{comparison.folder}/shown%d.png"]).decode()
    least = {}
    for line in text.splitlines():
        if timed := re.fullmatch(r"  (\S.*?) {2,}([0-9.]+)", line):
            name, value = timed.groups()
            least[name] = min(float(value), least.get(name, float("inf")))
    passes = {name: value for name, value in least.items() if name != "picture" and not name.startswith("read ")}
    return sum(passes.values())


def compare_time(comparison):
    source = street(comparison)
    picture = "night street"
    chain = vesper_chain(comparison, source, "reinhard")
    comparison.add("vesper, Reinhard 2002: ms", picture, chain, 35, "ms")
    comparison.add("vesper, Ward 1997: ms", picture, vesper_chain(comparison, source, "ward"), 35, "ms")
    stream = pipe(["pfsinexr", source])
    through = fastest(5, lambda: run(["pfstag", "--set", "A=1"], input=stream))
    pfstmo = fastest(5, lambda: run(["pfstmo_reinhard02"], input=stream)) - through
    comparison.note("pfstmo_reinhard02: ms", picture, f"{pfstmo:.1f}, without {through:.1f} for its input and output")
    pixels = read_exr(source).astype(np.float32)
    pixels = np.ascontiguousarray(pixels / pixels.max())
    operator = cv2.createTonemapReinhard(1.0, 0.0, 0.0, 0.0)
    opencv = fastest(10, lambda: operator.process(pixels))
    comparison.note("OpenCV TonemapReinhard: ms", picture, f"{opencv:.1f}")
    comparison.add("time of vesper / pfstmo", picture, chain / pfstmo, 1, "")
    comparison.add("time of vesper / OpenCV", picture, chain / opencv, 1, "")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("pictures", nargs="*", type=Path)
    parser.add_argument("--vesper", type=Path, required=True)
    arguments = parser.parse_args()
    pictures = arguments.pictures or [p for p in PICTURES if p.exists()]
    if not pictures:
        sys.exit(f"no pictures given, and none in {HDR}")
    folder = Path(tempfile.mkdtemp(prefix="vesper-compare-"))
    try:
        comparison = Comparison(arguments.vesper.resolve(), folder)
        has_pattanaik = "pattanaik" in comparison.help.split("--operator", 1)[1].split("\n  --", 1)[0]
        for picture in pictures:
            compare_reinhard(comparison, picture)
            if has_pattanaik:
                compare_pattanaik(comparison, picture)
            for darkest in (0.02, 2):
                compare_ward(comparison, picture, darkest)
        if not has_pattanaik:
            comparison.note("Pattanaik 2000", "", "vesper does not have it yet")
        compare_time(comparison)
        comparison.print()
        return 1 if comparison.broken else 0
    finally:
        shutil.rmtree(folder)


if __name__ == "__main__":
    sys.exit(main())
