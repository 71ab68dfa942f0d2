"""Luminances of pixels with light between surfaces, against traced light, for tools/oracle/oracle --indirect.

SPDX-License-Identifier: MIT"""

import time

import numpy as np

import rays as tracing
from light import EMITTERS, LAMPS, SKY, SURE_REFLECTIONS, Light
from scene import LUMINANCE, BadInput

RADIANCE_PATHS = 2048
SAME_REFLECTANCE = 0.03          # of all pixels in the median; textures are filtered in pictures only
PILOT_SIDE, MORE_SIDE = 16, 32   # roots of paths
WANTED_ERROR = 0.02              # standard error of a pixel at which no more paths are followed
MORE_SURFACES = 8                # random pixels for one that is compared
SHARES = (5, 10, 20, 50)         # %
LEAST_OF_KIND, WORST = 8, 12     # pixels, of a row by surface, and of the last table


class Pixels:
    """What is known of pixels of all cameras: arrays of the same length."""

    def __init__(self):
        self.known = {}

    def add(self, **values):
        for name, value in values.items():
            self.known.setdefault(name, []).append(np.asarray(value))

    def joined(self):
        return {name: np.concatenate(values) for name, values in self.known.items()}


class Comparison:
    def __init__(self, oracle):
        self.oracle, self.a, self.scene = oracle, oracle.a, oracle.scene
        self.light = Light(oracle.rays)
        self.scene.even_copy(oracle.folder / "even.gltf")
        stated = self.scene.block.get("ambient", {})
        self.constant = stated.get("illuminance_lx", 0) * np.array(stated.get("colour", [1, 1, 1]), float)
        self.pixels = Pixels()
        self.radiance = None
        if self.a.radiance > 0:
            import radiance
            self.radiance = radiance.Radiance(self.scene, oracle.folder, self.light)

    def pictures(self, camera):
        o = self.oracle
        return {"grey": o.picture(camera, "off") @ LUMINANCE,
                "even": o.luminance(camera, o.folder / "even.gltf", "off"),
                "on": o.luminance(camera, self.a.scene, "cached"), "off": o.luminance(camera, self.a.scene, "off")}

    def matt_pixels(self, camera, grey):
        """Random pixels of matt surfaces that both see."""
        seen, _, _ = self.oracle.surfaces(camera, MORE_SURFACES * self.a.indirect, grey)
        matt = np.flatnonzero(self.light.materials.matt[self.scene.material[seen["triangle"]]])
        if len(matt) == 0:
            raise BadInput(f"{self.a.scene}: camera '{camera}': no matt surface is seen")
        noise = self.oracle.noise
        return tracing.select(seen, np.sort(noise.choice(matt, min(self.a.indirect, len(matt)), replace=False)))

    def own_reflectance(self, seen):
        """By this reader, at the middle of the pixel: to compare alone."""
        t = seen["triangle"]
        corners = self.scene.corners[t]
        to = seen["position"] - corners[:, 0]
        first, second = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
        normal = np.cross(first, second)
        square = (normal * normal).sum(1)
        u = (np.cross(to, second) * normal).sum(1) / square
        v = (np.cross(first, to) * normal).sum(1) / square
        return self.light.materials.reflectance(t, np.stack([1 - u - v, u, v], axis=1))

    def lamps(self, seen, reflectance):
        """Luminance that lamps give directly, exactly."""
        lamps, count = self.scene.lamps, len(seen["depth"])
        points, lit, light = tracing.pairs_of(lamps, seen, 1e-9)
        light = light * tracing.visible_share(self.oracle.rays, seen, points, lit)
        shown = (reflectance[points] * lamps["colour"][lit]) @ LUMINANCE / np.pi
        return np.bincount(points, shown * light, count)

    def trace(self, seen, reflectance, lamps):
        """Means of the parts and standard errors; more paths where the error is large."""
        count, side = len(lamps), PILOT_SIDE
        left, paths = np.arange(count), np.zeros(count)
        parts, spread = np.zeros((count, SURE_REFLECTIONS + 2, 3)), np.zeros(count)
        while len(left):
            got, variance = self.light.traced(tracing.select(seen, left), reflectance[left], side, self.oracle.noise)
            parts[left] += got * side**2
            spread[left] += variance * side**2
            paths[left] += side**2
            side = MORE_SIDE
            whole = lamps + parts.sum((1, 2)) / np.maximum(paths, 1)
            error = np.sqrt(spread) / np.maximum(paths, 1)
            left = np.flatnonzero((error > WANTED_ERROR * whole) & (paths + side**2 <= self.a.paths))
        return parts / paths[:, None, None], error, paths

    def by_radiance(self, seen, reflectance):
        """Luminance of some pixels by Radiance, of -ab 1 and -ab 4; NaN for the others."""
        got = np.full((len(seen["depth"]), 2), np.nan)
        if self.radiance:
            some = self.oracle.noise.permutation(len(got))[:self.a.radiance]
            few = tracing.select(seen, some)
            place = few["position"] + tracing.OFF_SURFACE * few["flat"]
            for k, bounces in enumerate((1, 4)):
                lit = self.radiance.all_light(place, few["normal"], bounces, RADIANCE_PATHS)
                got[some, k] = (lit * reflectance[some]) @ LUMINANCE / np.pi
        return got

    def measure(self, camera):
        seconds = time.perf_counter()
        shown = self.pictures(camera)
        rendered = time.perf_counter() - seconds
        cast = self.oracle.rays.cast
        seen = self.matt_pixels(camera, shown["grey"])
        at = seen["pixel"][:, 1], seen["pixel"][:, 0]
        reflectance = shown["even"][at]
        lamps = self.lamps(seen, reflectance)
        parts, error, paths = self.trace(seen, reflectance, lamps)
        off = shown["off"][at] @ LUMINANCE
        constant = (reflectance * self.constant) @ LUMINANCE / np.pi
        self.pixels.add(camera=np.full(len(lamps), camera), pixel=seen["pixel"], position=seen["position"],
                        normal=seen["normal"], material=self.scene.material[seen["triangle"]], lamps=lamps, parts=parts,
                        error=error, paths=paths, on=shown["on"][at] @ LUMINANCE, off=off, direct=off - constant,
                        reflectance=reflectance @ LUMINANCE, own=self.own_reflectance(seen) @ LUMINANCE,
                        radiance=self.by_radiance(seen, reflectance))
        return rendered, time.perf_counter() - seconds - rendered, (self.oracle.rays.cast - cast) / 1e6


def traced(p):
    return p["lamps"] + p["parts"].sum((1, 2))


def rows(table, column, p):
    truth, of_lamps = traced(p), p["lamps"]
    whole = truth.sum()
    relative = p["error"] / np.maximum(truth, 1e-12)
    table.add("pixels", column, len(truth), "{}")
    own = np.median(p["own"] / np.maximum(p["reflectance"], 1e-9))
    table.add("reflectance here / vesper's, median", column, own, "{:.4f}")
    table.add("paths, mean", column, p["paths"].mean(), "{:.0f}")
    table.add("error of paths, mean", column, 100 * relative.mean(), "{:.2f} %")
    table.add("error of paths, percentile 95", column, 100 * np.quantile(relative, 0.95), "{:.2f} %")
    for name, got in (("cached", p["on"]), ("off", p["off"])):
        off_by = np.abs(got - truth) / np.maximum(truth, 1e-12)
        for share in SHARES:
            table.add(f"{name}: within {share} %", column, 100 * (off_by <= share / 100).mean(), "{:.1f} %")
        table.add(f"{name}: light / traced light", column, got.sum() / whole, "{:.4f}")
        table.add(f"{name}: median of light / traced", column, np.median(got / np.maximum(truth, 1e-12)), "{:.4f}")
    table.add("of lamps directly: light / traced", column, p["direct"].sum() / of_lamps.sum(), "{:.4f}")
    rest = whole - of_lamps.sum()
    table.add("all other: light / traced", column, (p["on"] - p["direct"]).sum() / rest, "{:.4f}")
    table.add("all other: standard error", column, np.sqrt((p["error"] ** 2).sum()) / rest, "{:.4f}")
    direct, later = p["parts"][:, 0].sum(0), p["parts"][:, 1:].sum((0, 1))
    table.add("traced: lamps directly", column, 100 * of_lamps.sum() / whole, "{:.1f} %")
    table.add("traced: emitters directly", column, 100 * direct[EMITTERS] / whole, "{:.1f} %")
    table.add("traced: sky directly", column, 100 * direct[SKY] / whole, "{:.1f} %")
    for name, source in (("lamps", LAMPS), ("emitters", EMITTERS), ("sky", SKY)):
        table.add(f"traced: {name}, reflected", column, 100 * later[source] / whole, "{:.1f} %")
    often = 100 * p["parts"][:, -1].sum() / whole
    table.add(f"traced: reflected over {SURE_REFLECTIONS} times", column, often, "{:.2f} %")


def radiance_rows(table, column, p):
    """-ab 1 has what lamps give, reflected once, and emitters and sky directly; -ab 4 some 0.3 % less than all."""
    truth = traced(p)
    once = p["lamps"] + p["parts"][:, 0].sum(1) + p["parts"][:, 1, LAMPS]
    for name, got, want in (("-ab 1", p["radiance"][:, 0], once), ("-ab 4", p["radiance"][:, 1], truth)):
        some = np.isfinite(got)
        off_by = np.abs(want[some] / got[some] - 1)
        table.add(f"Radiance {name}: traced / it", column, want[some].sum() / got[some].sum(), "{:.4f}")
        table.add(f"Radiance {name}: median of traced / it", column, np.median(want[some] / got[some]), "{:.4f}")
        table.add(f"Radiance {name}: traced within 10 %", column, 100 * (off_by <= 0.1).mean(), "{:.1f} %")
    some = np.isfinite(p["radiance"][:, 1])
    shown, it = p["on"][some], p["radiance"][some, 1]
    off_by = np.abs(shown / it - 1)
    table.add("Radiance -ab 4: pixels", column, some.sum(), "{}")
    table.add("Radiance -ab 4: cached / it", column, shown.sum() / it.sum(), "{:.4f}")
    for share in SHARES:
        table.add(f"Radiance -ab 4: cached within {share} %", column, 100 * (off_by <= share / 100).mean(), "{:.1f} %")


def kinds(scene, p):
    """Names of parts of the pixels, and which these are."""
    up = p["normal"][:, 1]
    yield "faces up", up > 0.7
    yield "faces down", up < -0.7
    yield "faces across", np.abs(up) <= 0.7
    lamps = p["lamps"] / np.maximum(traced(p), 1e-12)
    yield "lamps give over 2/3 directly", lamps > 2 / 3
    yield "lamps give under 1/3 directly", lamps < 1 / 3
    order = np.argsort(traced(p) / np.maximum(p["reflectance"], 1e-9))
    for k, name in enumerate(("darkest third", "middle third", "brightest third")):
        some = np.zeros(len(order), bool)
        some[order[k * len(order) // 3:(k + 1) * len(order) // 3]] = True
        yield name, some
    for m in np.unique(p["material"]):
        yield scene.json["materials"][m].get("name", f"material {m}"), p["material"] == m


def print_kinds(make_table, scene, p):
    table = make_table(["pixels", "light / traced", "other / traced", "standard error", "median", "within 20 %"])
    truth = traced(p)
    for name, some in kinds(scene, p):
        if some.sum() < LEAST_OF_KIND:
            continue
        whole, rest = truth[some].sum(), (truth - p["lamps"])[some].sum()
        table.add(name, "pixels", some.sum(), "{}")
        table.add(name, "light / traced", p["on"][some].sum() / whole, "{:.3f}")
        table.add(name, "other / traced", (p["on"] - p["direct"])[some].sum() / rest, "{:.3f}")
        table.add(name, "standard error", np.sqrt((p["error"][some] ** 2).sum()) / rest, "{:.3f}")
        table.add(name, "median", np.median(p["on"][some] / truth[some]), "{:.3f}")
        table.add(name, "within 20 %", 100 * (np.abs(p["on"] / truth - 1)[some] <= 0.2).mean(), "{:.0f} %")
    table.print()


def print_worst(scene, p):
    """lx are pi L / reflectance."""
    truth, scale = traced(p), np.pi / np.maximum(p["reflectance"], 1e-9)
    off_by = np.abs(p["on"] - truth) / np.maximum(truth, 1e-12)
    for k in np.argsort(-off_by)[:WORST]:
        place, normal = (" ".join(f"{c:.2f}" for c in p[key][k]) for key in ("position", "normal"))
        name = scene.json["materials"][p["material"][k]].get("name", "")
        direct = p["parts"][k, 0]
        lx = scale[k] * np.array([p["on"][k], truth[k], p["error"][k], p["lamps"][k], p["direct"][k], direct[EMITTERS],
                                  direct[SKY], p["parts"][k, 1:].sum()])
        print("{} {},{} {} at {} m, normal {}: ".format(p["camera"][k], *p["pixel"][k], name, place, normal)
              + "{:.4g}, traced {:.4g} +- {:.2g}: lamps {:.4g} (vesper {:.4g}), emitters {:.4g}, sky {:.4g}, "
                "reflected {:.4g}".format(*lx))


def compare(oracle, table):
    made = Comparison(oracle)
    for camera in oracle.a.camera:
        rendered, tracing_took, cast = made.measure(camera)
        table.add("seconds: vesper", camera, rendered, "{:.1f}")
        table.add("seconds: oracle", camera, tracing_took, "{:.1f}")
        table.add("million rays", camera, cast, "{:.2f}")
    p = made.pixels.joined()
    for camera in oracle.a.camera:
        rows(table, camera, {key: value[p["camera"] == camera] for key, value in p.items()})
    rows(table, "all", p)
    if made.radiance:
        radiance_rows(table, "all", p)
    table.print()
    off_by = np.median(p["own"] / np.maximum(p["reflectance"], 1e-9)) - 1
    if not abs(off_by) < SAME_REFLECTANCE:
        oracle.broken.append(f"reflectances differ by {100 * off_by:.3g} % in the median")
    print("\nby surface")
    print_kinds(type(table), oracle.scene, p)
    print("\nfarthest from the traced light; illuminances, lx")
    print_worst(oracle.scene, p)
    if oracle.a.save:
        np.savez(oracle.a.save, **p)
