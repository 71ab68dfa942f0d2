"""Direct light and visibility of lamps, or all light, in pictures of vesper, against rays through all triangles.

It reads the scene by itself, finds with Embree what each of some random pixels sees and which lamps that place sees, and
compares the light with vesper's. The pictures are of a grey copy of the scene: all surfaces matt, of one reflectance, dark by
themselves, no ambient light, so that a pixel holds lx. Lamps of less than the threshold count for nothing on either side.

  pixels           the surface that they see is the same for both (unoccluded light within 1 %); the others are left out
  within 5 %       share of pixels whose light differs from the traced light by at most that
  past contacts    of traced light that nothing nearer than --contact to a surface hides, as shadow maps promise
  leaks, lost      light that should not be there, and light that is missing, over all traced light
  pairs            of a pixel and a lamp, of lamps that have a colour channel of a picture for themselves
  near an edge     rays to places up to so many texels of the lamp's map around it disagree, or it is in a penumbra
  Radiance         the same light by rtrace, of all lamps at any illuminance; for some of the pixels

With --indirect POINTS it compares all light instead: luminance of random matt pixels in pictures of the scene itself,
with light between surfaces and with --indirect off, against lamps, emitting surfaces, an even sky and reflections along
random paths of its own. Vesper's reflectance of a pixel (from a picture in even light) counts on both sides, so that
filters of textures do not. Bodies that move hide and send light here, as they stand at time 0: best without any.

  error of paths   standard error of the traced luminance: a part of each difference
  light / traced   sums of luminances; "all other": without what lamps give directly
  by surface       the same for materials, sides, and parts by brightness
  Radiance         -ab 1 and -ab 4 at --radiance pixels of each camera, with mean reflectances and emissions; 5 s each
"""

import argparse
import os
import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
import OpenEXR

import rays as tracing
import scene as reading
from scene import GREY, LUMINANCE, BadInput

ROOT = Path(__file__).resolve().parent.parent.parent
STREET = ROOT / "data/rivoli/rivoli.gltf", ROOT / "data/rivoli/rivoli.photometry.json"
BRIGHT = 1.3             # lx, as in tests/passes/shadows/visibility_test.cpp
SAME_SURFACE = 0.01
EDGE_TEXELS = 2
FEWEST_PAIRS = 200       # of a lamp that is chosen, of the pixels of a camera
MORE_PIXELS = 3          # for pairs, times those for the light
EXAMPLES = """examples:
  tools/oracle/oracle                                       the night street of data/rivoli, all its cameras
  tools/oracle/oracle night.gltf --camera driver --size 1680x1050
  tools/oracle/oracle --opening-samples 64 --lamps 0        against lamps of the size of their openings
  tools/oracle/oracle --radiance 500                        with Radiance as a second witness
  tools/oracle/oracle night.gltf --indirect 100             light between surfaces, 100 pixels of each camera
  tools/oracle/oracle --self-test                           closed forms; no device and no vesper needed"""


def run(*command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode != 0:
        raise BadInput(f"{' '.join(map(str, command))}: {done.stderr.strip()}")
    return done.stdout


def read_exr(file):
    channels = OpenEXR.File(str(file), separate_channels=True).channels()
    return np.stack([channels[c].pixels.astype(np.float64) for c in "RGB"], axis=-1)


class Table:
    def __init__(self, heads):
        self.rows, self.heads = {}, heads

    def add(self, row, column, value, form):
        self.rows.setdefault(row, {})[column] = form.format(value)

    def print(self):
        lines = [("", *self.heads)] + [(row, *(cells.get(h, "") for h in self.heads)) for row, cells in self.rows.items()]
        widths = [max(len(line[i]) for line in lines) for i in range(len(lines[0]))]
        for line in lines:
            print("  ".join([line[0].ljust(widths[0])] + [cell.rjust(width) for cell, width in zip(line[1:], widths[1:])]).rstrip())


class Oracle:
    def __init__(self, arguments, scene, folder):
        self.a, self.scene, self.folder = arguments, scene, folder
        self.rays = tracing.Rays(scene)
        self.noise = np.random.default_rng(arguments.seed)
        self.broken = []
        self.render_seconds = 0.0
        scene.grey_copy(folder / "grey.gltf")
        self.radiance = None
        if arguments.radiance > 0 and not arguments.indirect:
            import radiance
            self.radiance = radiance.Radiance(scene, folder)

    def picture(self, camera, shadows, scene="grey.gltf"):
        """RGB of vesper's picture as illuminance, lx."""
        began, made = time.perf_counter(), self.folder / "picture.exr"
        run(self.a.vesper, "render", self.folder / scene, "--camera", camera, "--size", f"{self.a.size[0]}x{self.a.size[1]}", "--shadows", shadows,
            "--glare", "none", "--anti-aliasing", "off", "--threshold", self.a.threshold, "--indirect", "off", *self.a.render_option, "-o", made)
        self.render_seconds += time.perf_counter() - began
        return read_exr(made) * (np.pi / GREY)

    def luminance(self, camera, scene, indirect):
        """RGB of vesper's picture of a scene, cd/m^2."""
        made = self.folder / "picture.exr"
        run(self.a.vesper, "render", scene, "--camera", camera, "--size", f"{self.a.size[0]}x{self.a.size[1]}",
            "--glare", "none", "--anti-aliasing", "off", "--threshold", self.a.threshold, "--indirect", indirect,
            *self.a.render_option, "-o", made)
        return read_exr(made)

    def check_triangles(self, table):
        told = run(self.a.vesper, "inspect", self.a.scene)
        match = re.search(r"(\d+) triangles", told)
        count = len(self.scene.corners)
        table.add("triangles here", self.a.camera[0], count, "{}")
        table.add("triangles, vesper inspect", self.a.camera[0], match.group(1) if match else "?", "{}")
        if not match or int(match.group(1)) != count:
            self.broken.append("the oracle does not hold the triangles that vesper counts")

    def surfaces(self, camera, count, off):
        """Places that random pixels see and on which both agree: surfaces, unoccluded light (lx), pairs; and the ratios of the
        unoccluded light of all lit pixels."""
        width, height = self.a.size
        at = self.noise.choice(width * height, min(count, width * height), replace=False)
        seen = self.rays.surfaces(self.scene.camera(camera), np.stack([at % width, at // width], axis=1), self.a.size)
        seen = tracing.select(seen, (seen["triangle"] >= 0) & ~self.covered(seen))
        points, lit, light = tracing.pairs_of(self.scene.lamps, seen, self.a.threshold)
        total = np.bincount(points, light, len(seen["depth"]))
        shown = off[seen["pixel"][:, 1], seen["pixel"][:, 0]]
        ratio = shown / np.maximum(total, 1e-12)
        lit_here = total >= self.a.threshold
        good = lit_here & (np.abs(ratio - 1) <= SAME_SURFACE)
        number = np.cumsum(good) - 1
        kept = good[points]
        return tracing.select(seen, good), (number[points[kept]], lit[kept], light[kept]), ratio[lit_here]

    def covered(self, seen):
        """Pixels whose rays go by the opening of a lamp, which is drawn there whatever the surface."""
        lamps, covered = self.scene.lamps, np.zeros(len(seen["depth"]), bool)
        ray = tracing.unit(seen["position"] - seen["eye"])
        for k in np.flatnonzero(lamps["area"] > 0):
            to = lamps["place"][k] - seen["eye"]
            along = ray @ to
            away = np.linalg.norm(to - along[:, None] * ray, axis=1)
            covered |= (along > 0) & (away < np.sqrt(lamps["area"][k]) + along * 3e-3)
        return covered

    def compare_light(self, table, camera, on, seen, pairs):
        points, lit, light = pairs
        n = len(seen["depth"])
        share = tracing.visible_share(self.rays, seen, points, lit, self.a.opening_samples, self.noise)
        truth = np.bincount(points, light * share, n)
        got = on[seen["pixel"][:, 1], seen["pixel"][:, 0]]
        some = np.maximum(truth, got) >= self.a.threshold
        got, truth = got[some], truth[some]
        if len(got) == 0:
            raise BadInput(f"{self.a.scene}: camera '{camera}': no pixel is lit")
        error = np.abs(got - truth) / np.maximum(truth, 1e-12)
        bright = np.maximum(got, truth) >= BRIGHT
        table.add("pixels, lit", camera, len(got), "{}")
        table.add(f"pixels of {BRIGHT} lx and more", camera, bright.sum(), "{}")
        table.add("within 5 %: all lit", camera, 100 * (error <= 0.05).mean(), "{:.2f} %")
        table.add(f"within 5 %: {BRIGHT} lx and more", camera, 100 * (error[bright] <= 0.05).mean() if bright.any() else np.nan, "{:.2f} %")
        if self.a.contact > 0:
            share = tracing.visible_share(self.rays, seen, points, lit, self.a.opening_samples, self.noise, self.a.contact)
            past = np.bincount(points, light * share, n)[some]
            close = np.abs(got - past) <= 0.05 * past
            table.add("  past contacts: all lit", camera, 100 * close.mean(), "{:.2f} %")
            table.add(f"  past contacts: {BRIGHT} lx and more", camera, 100 * close[bright].mean() if bright.any() else np.nan, "{:.2f} %")
        table.add("light / traced light", camera, got.sum() / truth.sum(), "{:.4f}")
        table.add("light that leaks", camera, 100 * np.maximum(got - truth, 0).sum() / truth.sum(), "{:.2f} %")
        table.add("light that is lost", camera, 100 * np.maximum(truth - got, 0).sum() / truth.sum(), "{:.2f} %")
        for p in (50, 75, 90, 95, 99):
            table.add(f"error, percentile {p}", camera, 100 * np.quantile(error, p / 100), "{:.2f} %")

    def compare_pairs(self, table, camera, seen, pairs):
        """Lamps take turns: one has the red of a picture, one the green, all others the blue; so all are there, with the maps
        that they have in the scene."""
        points, lit, light = pairs
        lamps = self.scene.lamps
        per_lamp = np.bincount(lit, minlength=len(lamps["node"]))
        known = np.flatnonzero(per_lamp >= min(FEWEST_PAIRS, per_lamp.max()))
        chosen = self.noise.choice(known, min(self.a.lamps, len(known)), replace=False)
        maps = tracing.Maps(lamps, seen["eye"])
        wanted = np.zeros(len(lit), bool)
        wanted[self.noise.permutation(np.flatnonzero(np.isin(lit, chosen) & (light >= 1.02 * self.a.threshold)))[:self.a.pairs]] = True
        agree, near = [], []
        for k in range(0, len(chosen), 2):
            colours = np.tile([0.0, 0.0, 1.0], (len(lamps["node"]), 1))
            for channel, lamp in enumerate(chosen[k:k + 2]):
                colours[lamp] = np.eye(3)[channel]
            self.scene.grey_copy(self.folder / "pair.gltf", colours)
            shown = self.picture(camera, "on", "pair.gltf")
            for channel, lamp in enumerate(chosen[k:k + 2]):
                here = np.flatnonzero(wanted & (lit == lamp))
                pixel = seen["pixel"][points[here]]
                got = shown[pixel[:, 1], pixel[:, 0], channel] * LUMINANCE[channel] / light[here]
                share = tracing.visible_share(self.rays, seen, points[here], lit[here], self.a.opening_samples, self.noise)
                as_point = tracing.visible_share(self.rays, seen, points[here], lit[here])
                agree.append((got > 0.5) == (share > 0.5))
                edge = tracing.near_silhouette(self.rays, maps, seen, points[here], lit[here], as_point, EDGE_TEXELS)
                near.append(edge | (share != as_point))  # in a penumbra
        agree, near = np.concatenate(agree), np.concatenate(near)
        table.add("pairs", camera, len(agree), "{}")
        table.add("pairs that agree", camera, 100 * agree.mean(), "{:.2f} %")
        table.add(f"pairs near an edge ({EDGE_TEXELS} texels)", camera, 100 * near.mean(), "{:.2f} %")
        table.add("pairs that agree, the others", camera, 100 * agree[~near].mean(), "{:.2f} %")

    def compare_radiance(self, table, camera, on, seen):
        some = self.noise.permutation(len(seen["depth"]))[:self.a.radiance]
        few = tracing.select(seen, np.sort(some))
        n = len(some)
        points, lit, light = tracing.pairs_of(self.scene.lamps, few, 1e-9)
        truth = np.bincount(points, light * tracing.visible_share(self.rays, few, points, lit), n)
        strong = light >= self.a.threshold
        faint = truth - np.bincount(points[strong], light[strong] * tracing.visible_share(self.rays, few, points[strong], lit[strong]), n)
        other = self.radiance.illuminance(few["position"] + tracing.OFF_SURFACE * few["flat"], few["normal"])
        got = on[few["pixel"][:, 1], few["pixel"][:, 0]] + faint
        bright = np.maximum(truth, other) >= BRIGHT
        table.add("Radiance: pixels", camera, n, "{}")
        table.add("Radiance / traced light", camera, other.sum() / truth.sum(), "{:.4f}")
        for name, value in (("traced", truth), ("vesper", got)):
            error = np.abs(value - other) / np.maximum(other, 1e-12)
            table.add(f"Radiance: {name} within 5 %", camera, 100 * (error <= 0.05).mean(), "{:.2f} %")
            table.add(f"Radiance: {name} within 5 %, {BRIGHT} lx", camera, 100 * (error[bright] <= 0.05).mean() if bright.any() else np.nan, "{:.2f} %")

    def compare(self, table, camera):
        began, cast, self.render_seconds = time.perf_counter(), self.rays.cast, 0.0
        on, off = self.picture(camera, "on") @ LUMINANCE, self.picture(camera, "off") @ LUMINANCE
        seen, pairs, ratio = self.surfaces(camera, self.a.points, off)
        off_by = abs(np.median(ratio) - 1)
        table.add("unoccluded / vesper's, median - 1", camera, np.median(ratio) - 1, "{:+.6f}")
        table.add("pixels left out: other surfaces", camera, 100 * (np.abs(ratio - 1) > SAME_SURFACE).mean(), "{:.2f} %")
        if not off_by < 1e-3:
            self.broken.append(f"camera '{camera}': unoccluded light differs by {100 * off_by:.3g} % in the median")
        self.compare_light(table, camera, on, seen, pairs)
        if self.a.lamps > 0:
            more, more_pairs, _ = self.surfaces(camera, MORE_PIXELS * self.a.points, off)
            self.compare_pairs(table, camera, more, more_pairs)
        if self.radiance:
            self.compare_radiance(table, camera, on, seen)
        whole = time.perf_counter() - began
        table.add("seconds: vesper", camera, self.render_seconds, "{:.1f}")
        table.add("seconds: oracle", camera, whole - self.render_seconds, "{:.1f}")
        table.add("million rays", camera, (self.rays.cast - cast) / 1e6, "{:.2f}")


def parse():
    parser = argparse.ArgumentParser(prog="oracle", description=__doc__, epilog=EXAMPLES, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("scene", nargs="?", type=Path, help="photometric .gltf or .glb; default: data/rivoli, converted")
    parser.add_argument("--camera", action="append", help="camera to look through; again for more (all of the scene)")
    parser.add_argument("--size", default="840x525", help="of the pictures, px (%(default)s)")
    parser.add_argument("--points", type=int, default=20000, help="pixels for each camera (%(default)s)")
    parser.add_argument("--pairs", type=int, default=20000, help="pairs for each camera, at most (%(default)s)")
    parser.add_argument("--lamps", type=int, default=12, help="lamps that the pairs are of; 0: no pairs (%(default)s)")
    parser.add_argument("--opening-samples", type=int, default=0, metavar="N", help="rays to points on a disc of the opening's area; 0: lamps are points (%(default)s)")
    parser.add_argument("--contact", type=float, default=0.016, metavar="M", help="for a second comparison: nothing nearer to a surface hides a lamp, m; 0: no such rows (%(default)s)")
    parser.add_argument("--radiance", type=int, default=0, metavar="N", help="pixels for which Radiance computes the light, too (%(default)s)")
    parser.add_argument("--indirect", type=int, nargs="?", const=100, default=0, metavar="POINTS",
                        help="compare all light at so many pixels of each camera instead (without a number: %(const)s)")
    parser.add_argument("--paths", type=int, default=8192,
                        help="of --indirect for a pixel, at most; 256 at least (%(default)s)")
    parser.add_argument("--save", type=Path, metavar="FILE.npz", help="what --indirect found for each pixel")
    parser.add_argument("--cache", metavar="DIR|off",
                        help="folder that keeps vesper's shadows and light between surfaces for later runs (off, so "
                             "that seconds are those of a first run; with --indirect a folder of this run)")
    parser.add_argument("--threshold", type=float, default=0.001, help="illuminance below which a lamp counts as dark, lx (%(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="of the choice of pixels and lamps (%(default)s)")
    parser.add_argument("--render-option", action="append", default=[], metavar="WORD", help="a further word for vesper render, as --render-option=--all-lamps")
    parser.add_argument("--vesper", type=Path, default=ROOT / "build/release/bin/vesper", help="the program (build/release/bin/vesper, built anew)")
    parser.add_argument("--venv", type=Path, help="folder of the Python packages, made if it is missing (build/oracle-venv)")
    parser.add_argument("--self-test", action="store_true", help="check the oracle against closed forms, and end")
    a = parser.parse_args()
    size = re.fullmatch(r"(\d+)x(\d+)", a.size)
    if not size or not all(8 <= int(s) <= 16384 for s in size.groups()):
        parser.error(f"--size {a.size}: WIDTHxHEIGHT is wanted, 8 to 16384 px")
    a.size = tuple(map(int, size.groups()))
    if a.points < 1 or a.pairs < 1 or not a.threshold > 0:
        parser.error("--points, --pairs and --threshold must be positive")
    if min(a.lamps, a.opening_samples, a.radiance, a.contact, a.indirect) < 0:
        parser.error("--lamps, --opening-samples, --radiance, --contact and --indirect must not be negative")
    if a.paths < 256:
        parser.error("--paths must be 256 or more")
    return a


def main():
    a = parse()
    try:
        with tempfile.TemporaryDirectory(prefix="vesper-oracle-") as folder:
            folder = Path(folder)
            os.environ["VESPER_CACHE"] = a.cache or (str(folder / "cache") if a.indirect else "off")
            if a.self_test:
                import compare_test
                return compare_test.main(folder)
            if not a.vesper.exists():
                raise BadInput(f"{a.vesper}: no such program")
            if a.scene is None:
                a.scene = folder / "night.gltf"
                run(a.vesper, "convert", STREET[0], "--photometry", STREET[1], "-o", a.scene)
            scene = reading.Scene(a.scene)
            a.camera = a.camera or scene.camera_names()
            for camera in a.camera:
                scene.camera(camera)
            oracle, table = Oracle(a, scene, folder), Table(a.camera + ["all"] * (a.indirect > 0))
            oracle.check_triangles(table)
            if a.indirect:
                import indirect
                indirect.compare(oracle, table)
            else:
                for camera in a.camera:
                    oracle.compare(table, camera)
                table.print()
            for line in oracle.broken:
                print(f"BROKEN: {line}")
            return 1 if oracle.broken else 0
    except BadInput as error:
        print(f"oracle: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
