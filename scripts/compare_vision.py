"""What scripts/compare-vision runs; see there. SPDX-License-Identifier: MIT

Differences  `vesper compare` beside ColorVideoVDP (JOD) and HDR-FLIP (mean): a dozen pictures with six kinds of
             distortion each, in one of three strengths; those of the street with two more
Saliency     `vesper saliency` beside OpenCV's spectral residual and fine grained saliency, by squares of 16 x 16 px
"""

import argparse
import importlib.metadata
import json
import shutil
import sys
import tempfile
import time
from pathlib import Path

import cv2
import numpy as np

from compare_vision_pictures import HEIGHT, WIDTH, Street, in_blocks, luminance, pairs, pictures, synthetic
from compared_pictures import read_exr, run, write_exr

try:
    import flip_evaluator
except ImportError:
    flip_evaluator = None

DEGREES = 10   # that a picture covers in height
TEXEL = 16     # px, of vesper's map of saliency
DEGREE = 30    # px, about a degree
EXPOSURES = 6  # of FLIP, over the range that it finds itself; with its own 18 a pair with lamps takes 4 s
# Figures of vesper compare; the sign makes them grow with the difference.
FIGURES = {"largest_probability": 1, "share_above_0.75": 1, "log10_rmse": 1, "pu21_psnr_db": -1, "pu21_ssim": -1}


def ranks(values):
    """From 1; means where values are equal."""
    _, place, count = np.unique(np.asarray(values, float).ravel(), return_inverse=True, return_counts=True)
    last = np.cumsum(count)
    return (last - (count - 1) / 2)[place.ravel()]


def spearman(a, b):
    """Spearman's rank correlation; NaN if one of the lists is all equal."""
    a, b = ranks(a), ranks(b)
    a, b = a - a.mean(), b - b.mean()
    scale = np.sqrt((a @ a) * (b @ b))
    return float(a @ b / scale) if scale > 0 else float("nan")


def squares(values, side):
    """Means of squares; what is left over at the edges is left out."""
    rows, columns = values.shape[0] // side, values.shape[1] // side
    return values[:rows * side, :columns * side].reshape(rows, side, columns, side).mean((1, 3))


def middle(values):
    values = [v for v in values if np.isfinite(v)]
    return float(np.median(values)) if values else float("nan")


def table(rows):
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    for row in rows:
        print("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip())
    print()


class Metrics:
    """Figures of one pair, all of which grow with the difference, and maps."""

    def __init__(self, vesper, jod, folder):
        self.vesper, self.folder = vesper, folder
        self.jod = jod if jod and jod.exists() else None
        self.others = [name for name, there in (("JOD", self.jod), ("FLIP", flip_evaluator)) if there]

    def of(self, reference, test):
        files = [self.folder / name for name in ("a.exr", "b.exr", "map.exr", "found.json")]
        write_exr(files[0], reference), write_exr(files[1], test)
        run([self.vesper, "compare", *files[:2], "--unit", "1", "--fov", DEGREES, "-o", files[2], "--json", files[3]])
        found = json.loads(files[3].read_text())
        figures = {name: sign * (found[name] if found[name] is not None else np.inf) for name, sign in FIGURES.items()}
        maps = {"vesper": read_exr(files[2])[..., 0]}
        density = found["pixels_per_degree"]
        if self.jod:
            raw = [self.folder / name for name in ("a.raw", "b.raw", "map.raw")]
            reference.astype(np.float32).tofile(raw[0]), test.astype(np.float32).tofile(raw[1])
            figures["JOD"] = 10 - float(run([self.jod, density, WIDTH, HEIGHT, *raw]))
            maps["JOD"] = np.fromfile(raw[2], np.float32).reshape(HEIGHT, WIDTH)
        if flip_evaluator:
            made, figures["FLIP"], _ = flip_evaluator.evaluate(
                reference.astype(np.float32), test.astype(np.float32), "HDR", applyMagma=False,
                parameters={"ppd": density, "numExposures": EXPOSURES})
            maps["FLIP"] = np.asarray(made).reshape(HEIGHT, WIDTH, -1)[..., 0]
        return figures, maps


def map_agreement(maps, others):
    """Rank correlations of maps, by pixel and by squares of a degree."""
    couples = [("vesper", other) for other in others] + ([("JOD", "FLIP")] if len(others) == 2 else [])
    return {couple + (side,): spearman(squares(maps[couple[0]], side), squares(maps[couple[1]], side))
            for couple in couples for side in (1, DEGREE)}


def print_pairs(found, others):
    rows = [["picture", "distortion", "strength", "P", "above 0.75, %", "log10 RMSE", "PSNR, dB", "SSIM", *others]]
    for name, kind, strength, f, _ in found:
        rows.append([name, kind, f"{strength:g}", f"{f['largest_probability']:.4f}",
                     f"{100 * f['share_above_0.75']:.2f}", f"{f['log10_rmse']:.4f}", f"{-f['pu21_psnr_db']:.1f}",
                     f"{-f['pu21_ssim']:.4f}",
                     *(f"{10 - f[o]:.3f}" if o == "JOD" else f"{f[o]:.4f}" for o in others)])
    table(rows)


def print_correlations(found, others, what):
    print(f"Spearman over {len(found)} pairs{what}; in brackets: median over pictures of that within a picture")
    names = list(dict.fromkeys(name for name, *_ in found))
    rows = [["", *others]]
    for figure in [*FIGURES, *others]:
        row = [figure]
        for other in others:
            values = [[(f[figure], f[other]) for picture, _, _, f, _ in found if name in (None, picture)]
                      for name in (None, *names)]
            whole, *within = (spearman(*zip(*v)) for v in values)
            row.append("" if figure == other else f"{whole:.3f} ({middle(within):.3f})")
        rows.append(row)
    table(rows)


def print_agreement(found, others):
    if not others:
        return
    print_correlations(found, others, "")
    # A factor on all luminances hardly changes contrasts, which are all that ColorVideoVDP sees.
    print_correlations([pair for pair in found if pair[1] != "brightness"], others, " without those of brightness")
    print("Mean rank of each distortion, from 0 (least seen) to 1 (most)")
    shown = ["share_above_0.75", "log10_rmse", *others]
    places = {figure: (ranks([f[figure] for *_, f, _ in found]) - 0.5) / len(found) for figure in shown}
    rows = [["distortion", "pairs", *shown]]
    for kind in dict.fromkeys(kind for _, kind, *_ in found):
        here = np.array([k == kind for _, k, *_ in found])
        rows.append([kind, str(here.sum()), *(f"{places[figure][here].mean():.2f}" for figure in shown)])
    table(rows)
    print("Maps: median over pairs of Spearman over pixels, and over squares of a degree")
    rows = [["maps", "pixels", "squares"]]
    for a, b in dict.fromkeys(key[:2] for *_, agreement in found for key in agreement):
        values = [middle([agreement[a, b, side] for *_, agreement in found]) for side in (1, DEGREE)]
        rows.append([f"{a}, {b}", *(f"{v:.3f}" for v in values)])
    table(rows)


def print_saliency(vesper, made, folder):
    print("Saliency: Spearman over squares of 16 x 16 px; OpenCV sees the logarithm of luminance, 0.1 to 99.9 % of it")
    makers = {"spectral residual": cv2.saliency.StaticSaliencySpectralResidual_create(),
              "fine grained": cv2.saliency.StaticSaliencyFineGrained_create()}
    rows, sums = [["picture", *(f"vesper, {m}" for m in makers), " and ".join(makers)]], []
    for name, rgb in made:
        source, target = folder / "picture.exr", folder / "saliency.exr"
        write_exr(source, rgb)
        run([vesper, "saliency", source, "--unit", "1", "--fov", DEGREES, "-o", target])
        log = np.log(luminance(rgb))
        low, high = np.quantile(log, (0.001, 0.999))
        grey = (np.clip((log - low) / (high - low), 0, 1) * 255).round().astype(np.uint8)
        maps = [read_exr(target)[..., 0]]
        for maker in makers.values():
            good, values = maker.computeSaliency(cv2.cvtColor(grey, cv2.COLOR_GRAY2BGR))
            if not good:
                sys.exit(f"OpenCV finds no saliency in {name}")
            maps.append(squares(values.astype(np.float64), TEXEL))
        sums.append([spearman(maps[0], maps[1]), spearman(maps[0], maps[2]), spearman(maps[1], maps[2])])
        rows.append([name, *(f"{v:.3f}" for v in sums[-1])])
    table(rows + [["mean", *(f"{v:.3f}" for v in np.nanmean(sums, axis=0))]])


def print_versions(metrics, vesper):
    print("vesper", run([vesper, "--version"]).decode().strip())
    for package in ("flip-evaluator", "opencv-contrib-python-headless", "numpy"):
        try:
            print(package, importlib.metadata.version(package))
        except importlib.metadata.PackageNotFoundError:
            print(package, "is not installed: passed over")
    print("colorvideovdp 0.1.1 (model 0.5.7)\n" if metrics.jod else "colorvideovdp is not built: passed over\n")


def self_test():
    """Closed forms. Ties: ranks 1, 2.5, 2.5, 4 and 1, 3, 2, 4."""
    noise = np.random.default_rng(1)
    rgb = synthetic(noise)
    checks = {"rising": spearman([1, 2, 30], [-5, 0, 1]) == 1, "falling": spearman([1, 2, 30], [9, 8, 0]) == -1,
              "ties": abs(spearman([1, 2, 2, 3], [1, 3, 2, 4]) - 4.5 / np.sqrt(22.5)) < 1e-12,
              "all equal": np.isnan(spearman([2, 2, 2], [1, 2, 3])),
              "infinite": spearman([1, np.inf, -np.inf], [2, 3, 1]) == 1,
              "squares": (squares(np.arange(20.0).reshape(4, 5), 2) == [[3, 5], [13, 15]]).all(),
              "blocks": np.allclose(in_blocks(rgb, 1e-9, noise), rgb, rtol=1e-6)}
    for name, good in checks.items():
        print(f"{'good' if good else 'WRONG'}  {name}")
    return 0 if all(checks.values()) else 1


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--vesper", type=Path, required=True)
    parser.add_argument("--jod", type=Path)
    parser.add_argument("--self-test", action="store_true", help="only check the script's own correlation")
    arguments = parser.parse_args()
    if arguments.self_test:
        return self_test()
    began, folder, noise = time.monotonic(), Path(tempfile.mkdtemp(prefix="vesper-compare-")), np.random.default_rng(1)
    try:
        vesper = arguments.vesper.resolve()
        street, metrics = Street(vesper, folder), Metrics(vesper, arguments.jod, folder)
        print_versions(metrics, vesper)
        made = pictures(street, noise)
        print_saliency(vesper, made, folder)
        found = []
        for name, kind, strength, reference, test in pairs(made, street, noise):
            figures, maps = metrics.of(reference, test)
            found.append((name, kind, strength, figures, map_agreement(maps, metrics.others)))
            if sys.stderr.isatty():
                print(f"{len(found)} pairs", end="\r", file=sys.stderr, flush=True)
        print_pairs(found, metrics.others)
        print_agreement(found, metrics.others)
        print(f"{time.monotonic() - began:.0f} s")
        return 0
    finally:
        shutil.rmtree(folder)


if __name__ == "__main__":
    sys.exit(main())
