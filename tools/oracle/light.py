"""Light of lamps, emitting surfaces, an even sky and reflections by paths of rays, for tools/oracle/oracle.

Written from the physics, not from the engine: the luminance that leaves a matt surface is its reflectance times its
illuminance / pi; illuminance is the integral of luminance over the hemisphere, weighted by the cosine (Kajiya 1986).
Every surface reflects as if matt, on both sides, by its base colour. What holds a lamp emits nothing and reflects
nothing of this lamp: its intensities have that light. SPDX-License-Identifier: MIT"""

import tempfile
from pathlib import Path

import numpy as np
import OpenEXR

from rays import OFF_SURFACE, lamp_light, unit
from scene import LUMINANCE, BadInput

CUBE = 5.0           # m, of space in which sources are chosen alike
HALF = CUBE * 0.87   # m, from its centre to its corners, at most
LAMP_TRIES = 8       # lamps, and places on emitters, of which one is chosen by the light that it may give
EMITTER_TRIES = 4
SURE_REFLECTIONS = 3  # from then on chance ends paths
MOST_REFLECTIONS = 64
BATCH = 1 << 16      # paths
LAMPS, EMITTERS, SKY = range(3)


class Materials:
    """Reflectance and emission of places on triangles, RGB; emission in cd/m^2."""

    def __init__(self, scene):
        self.scene = scene
        listed = scene.json.get("materials", [])
        transfer = scene.block.get("transfer", {"kind": "srgb"})
        self.gamma = transfer.get("gamma", 2.2) if transfer["kind"] == "gamma" else None
        luminous = {use["material"]: use for use in scene.block.get("luminous", [])}
        self.base = [self.base_of(m) for m in listed] + [(np.ones(3), None, {})]
        self.glow = [self.glow_of(m, luminous.get(i)) for i, m in enumerate(listed)] + [(np.zeros(3), None, {})]
        self.emits = np.array([(factor > 0).any() for factor, _, _ in self.glow])
        self.matt = np.array([self.is_matt(i, m) for i, m in enumerate(listed)] + [False]) & ~self.emits
        self.clear = np.array([self.is_clear(m) for m in listed] + [False]) & ~self.emits

    def picture(self, texture, decode):
        scene = self.scene
        codes = np.asarray(scene.image(scene.json["textures"][texture]["source"]))[..., :3]
        return decode(np.arange(256) / 255).astype(np.float32)[codes], scene.sampler(texture)

    def decode(self, code):
        return srgb(code) if self.gamma is None else code**self.gamma

    def base_of(self, m):
        pbr = m.get("pbrMetallicRoughness", {})
        factor = np.clip(np.array(pbr.get("baseColorFactor", [1, 1, 1, 1])[:3], float), 0, 1)
        texture = pbr.get("baseColorTexture", {}).get("index", -1)
        return (factor, *(self.picture(texture, self.decode) if texture >= 0 else (None, {})))

    def glow_of(self, m, luminous):
        if luminous:
            sampler = self.scene.json["samplers"][luminous["sampler"]] if "sampler" in luminous else {}
            return np.full(3, float(luminous["scale"])), self.luminance_picture(luminous["picture"]), sampler
        strength = m.get("extensions", {}).get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1)
        factor = np.array(m.get("emissiveFactor", [0, 0, 0]), float) * strength
        texture = m.get("emissiveTexture", {}).get("index", -1)
        return (factor, *(self.picture(texture, srgb) if texture >= 0 and factor.any() else (None, {})))

    def luminance_picture(self, number):
        data = bytes(self.scene.view(self.scene.block["luminance_pictures"][number]["bufferView"])[0])
        if data[:4] != b"\x76\x2f\x31\x01":
            raise BadInput(f"{self.scene.path}: luminance_pictures[{number}]: the oracle reads OpenEXR alone")
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "picture.exr"
            file.write_bytes(data)
            channels = OpenEXR.File(str(file), separate_channels=True).channels()
            return np.stack([channels[c].pixels.astype(np.float32) for c in "RGB"], axis=-1)

    def is_matt(self, number, m):
        """Whether the rules of pictures are those of matt surfaces."""
        pbr = m.get("pbrMetallicRoughness", {})
        other = [use["material"] for key in ("roads", "retroreflective") for use in self.scene.block.get(key, [])]
        even = pbr.get("roughnessFactor", 1) == 1 and pbr.get("metallicFactor", 1) == 0
        return even and "metallicRoughnessTexture" not in pbr and number not in other and not self.is_clear(m)

    def is_clear(self, m):
        glass = m.get("extensions", {}).get("KHR_materials_transmission", {}).get("transmissionFactor", 0) > 0
        return glass or m.get("alphaMode") == "BLEND"

    def values(self, table, triangle, weights, tint):
        scene = self.scene
        material, made = scene.material[triangle], np.empty((len(triangle), 3))
        for m in np.unique(material):
            here = np.flatnonzero(material == m)
            factor, picture, sampler = table[m]
            made[here] = factor
            if picture is not None and factor.any():
                uv = (scene.uv[triangle[here]] * weights[here, :, None]).sum(1)
                made[here] *= scene.filtered(picture, sampler, uv)
            if tint:
                made[here] *= (scene.colour[triangle[here], :, :3] * weights[here, :, None]).sum(1)
        return made

    def reflectance(self, triangle, weights):
        return self.values(self.base, triangle, weights, True)

    def emission(self, triangle, weights):
        return self.values(self.glow, triangle, weights, False)


class Choice:
    """Sources (lamps, or emitting triangles) chosen by shares that belong to cubes of space; `weigh`: weights of all of
    them for centres of cubes."""

    def __init__(self, weigh, count):
        self.weigh, self.count, self.used = weigh, count, 0
        self.keys, self.row = np.zeros(0, np.int64), np.zeros(0, np.int64)
        self.share, self.reached = np.zeros((0, count), np.float32), np.zeros((0, count))

    def rows(self, position):
        cube = np.floor(position / CUBE).astype(np.int64) + (1 << 20)
        key = cube[:, 0] << 42 | cube[:, 1] << 21 | cube[:, 2]
        fresh = np.setdiff1d(key, self.keys)
        if len(fresh):
            self.add(fresh)
        return self.row[np.searchsorted(self.keys, key)]

    def add(self, fresh):
        needed = self.used + len(fresh)
        if needed > len(self.share):
            more = max(needed, 2 * len(self.share)) - len(self.share)
            self.share = np.concatenate([self.share, np.zeros((more, self.count), np.float32)])
            self.reached = np.concatenate([self.reached, np.zeros((more, self.count))])
        cube = np.stack([fresh >> 42, fresh >> 21 & (1 << 21) - 1, fresh & (1 << 21) - 1], axis=1) - (1 << 20)
        for k in range(0, len(fresh), 256):
            weight = self.weigh((cube[k:k + 256] + 0.5) * CUBE)
            whole = weight.sum(1, keepdims=True)
            share = np.where(whole > 0, weight / np.maximum(whole, 1e-300), 1 / self.count)
            at = slice(self.used + k, self.used + k + len(share))
            self.share[at] = share
            self.reached[at] = np.arange(at.start, at.stop)[:, None] + np.minimum(np.cumsum(share, axis=1), 1)
            self.reached[at, -1] = np.arange(at.start, at.stop) + 1
        row = np.concatenate([self.row, np.arange(self.used, needed)])
        self.keys = np.concatenate([self.keys, fresh])
        order = np.argsort(self.keys)
        self.keys, self.row, self.used = self.keys[order], row[order], needed

    def choose(self, rows, random):
        """One source for each row and random number in [0, 1), and its share."""
        at = np.searchsorted(self.reached[:self.used].ravel(), rows + random, side="right")
        source = np.clip(at - rows * self.count, 0, self.count - 1)
        return source, self.share[rows, source]


class Light:
    def __init__(self, rays):
        scene = rays.scene
        self.rays, self.scene, self.materials = rays, scene, Materials(scene)
        self.refuse()
        self.front = rays.flat * scene.front[:, None]
        self.stops = ~self.materials.clear[scene.material]
        sky = scene.block.get("sky", {})
        self.sky = sky.get("luminance_cd_m2", 0) * np.array(sky.get("colour", [1, 1, 1]), float)
        self.find_emitters()
        self.lamp_choice = Choice(self.weigh_lamps, len(scene.lamps["node"]))
        self.emitter_choice = Choice(self.weigh_emitters, len(self.emitters)) if len(self.emitters) else None

    def refuse(self):
        lights = self.scene.json["extensions"]["KHR_lights_punctual"]["lights"]
        if any(light["type"] == "directional" and light.get("intensity", 1) > 0 for light in lights):
            raise BadInput(f"{self.scene.path}: a directional light: the oracle does not follow its reflections")
        if "environment" in self.scene.block:
            raise BadInput(f"{self.scene.path}: a picture of the sky: the oracle takes an even sky alone")

    def find_emitters(self):
        scene, order = self.scene, self.scene.node_order
        holds = np.zeros(len(order), bool)
        for first, last in np.unique(np.stack([scene.lamps["first"], scene.lamps["last"]], axis=1), axis=0):
            holds |= (order >= first) & (order < last)
        edges = scene.corners[:, 1:] - scene.corners[:, :1]
        area = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1) / 2
        self.emitters = np.flatnonzero(self.materials.emits[scene.material] & ~holds & (area > 1e-10))
        self.number = np.full(len(order), -1)
        self.number[self.emitters] = np.arange(len(self.emitters))
        t = self.emitters
        self.area, self.centre = area[t], scene.corners[t].mean(1)
        self.twofold = scene.both_sides[scene.material[t]]
        side = np.arange(6) / 6 + 1 / 12
        u, v = (grid.ravel() for grid in np.meshgrid(side, side))
        weights = corner_weights(np.where(u + v > 1, 1 - u, u), np.where(u + v > 1, 1 - v, v))
        self.mean_emission = np.mean([self.materials.emission(t, np.tile(w, (len(t), 1))) for w in weights], axis=0)
        most = np.array([self.glow_peak(m) for m in scene.material[t]])
        self.mean = np.maximum(self.mean_emission @ LUMINANCE, 0.05 * most)

    def mean_reflectance(self, triangle, noise):
        root, v = np.sqrt(noise.random(len(triangle))), noise.random(len(triangle))
        return self.materials.reflectance(triangle, np.stack([1 - root, root * (1 - v), root * v], axis=1)).mean(0)

    def glow_peak(self, material):
        factor, picture, _ = self.materials.glow[material]
        return float(factor @ LUMINANCE) * (1 if picture is None else float(picture.max()))

    # Weights for cubes: as from the best place in them, so that none that counts is left out

    def weigh_lamps(self, centre):
        lamps = self.scene.lamps
        every = np.arange(len(lamps["node"]))
        to = lamps["place"] - centre[:, None]
        away = np.linalg.norm(to, axis=2)
        angle = np.arccos(np.clip(-(lamps["axis"] * to).sum(2) / np.maximum(away, 1e-9), -1, 1))
        best = np.maximum(angle - np.arcsin(np.clip(HALF / np.maximum(away, HALF), 0, 1)), 0)
        # A lamp of this kind over a surface at 1 m, turned by the best angle from its axis.
        flat = {key: lamps[key] for key in ("intensity", "slope", "offset", "exponent")}
        weight = np.empty(away.shape)
        for row in range(len(centre)):
            down = np.stack([np.sin(best[row]), -np.cos(best[row]), np.zeros(len(every))], axis=1)
            over = {**flat, "place": np.tile([0.0, 1, 0], (len(every), 1)), "axis": down}
            weight[row] = lamp_light(over, every, np.zeros((len(every), 3)), np.tile([0.0, 1, 0], (len(every), 1)))
        return weight / np.maximum(away, HALF) ** 2

    def weigh_emitters(self, centre):
        to = centre[:, None] - self.centre
        away = np.linalg.norm(to, axis=2)
        cosine = (self.front[self.emitters] * to).sum(2) / np.maximum(away, 1e-9)
        cosine = np.where(self.twofold, np.abs(cosine), cosine)
        far = np.maximum(away - np.sqrt(self.area), HALF)
        angle = np.arccos(np.clip(cosine, -1, 1)) - np.arcsin(np.clip(HALF / far, 0, 1))
        return self.mean * self.area * np.maximum(np.cos(np.maximum(angle, 0)), 0.01) / far**2

    # Paths

    def passes(self, rays, t, u, v):
        return ~self.stops[t] | self.rays.open(t, u, v)

    def free(self, origin, target, lamp=None):
        """Whether nothing is between places; a lamp's fixture counts for nothing."""
        order, lamps = self.scene.node_order, self.scene.lamps

        def passes(rays, t, u, v):
            gone = self.passes(rays, t, u, v)
            if lamp is not None:
                gone |= (order[t] >= lamps["first"][lamp[rays]]) & (order[t] < lamps["last"][lamp[rays]])
            return gone

        to, reach = target - origin, np.ones(len(origin))
        if lamp is None:
            reach -= 2 * OFF_SURFACE / np.maximum(np.linalg.norm(to, axis=1), 1e-2)
        return self.rays.first_hits(origin, to, reach, passes)[0] < 0

    def traced(self, seen, reflectance, side, noise, most=np.inf):
        """Luminance of matt surfaces but for what lamps give directly, cd/m^2, by side x side paths each: means of
        (point, reflections before, kind of source), and the variance of the whole of a path. `most`: reflections."""
        count, each = len(seen["depth"]), side * side
        parts, square = np.zeros((count, SURE_REFLECTIONS + 2, 3)), np.zeros(count)
        step = max(BATCH // each, 1)
        for first in range(0, count, step):
            at = np.arange(first, min(first + step, count))
            walk = Walk(self, np.repeat(at, each), seen, reflectance, side, noise, most)
            parts[at] = walk.sums(at, each) / each
            square[at] = (walk.whole.reshape(len(at), each) ** 2).mean(1)
        return parts, np.maximum(square - parts.sum((1, 2)) ** 2, 0)


class Walk:
    """Paths from points, all at once: those alive have a place, normals, and a throughput (RGB)."""

    def __init__(self, light, point, seen, reflectance, side, noise, most):
        self.light, self.noise = light, noise
        self.found = np.zeros((len(point), SURE_REFLECTIONS + 2, 3))
        self.path = np.arange(len(point))
        self.normal, self.flat = seen["normal"][point], seen["flat"][point]
        self.place = seen["position"][point] + OFF_SURFACE * self.flat
        self.through, self.on = reflectance[point], np.full(len(point), -1)
        self.depth, strata = 0, np.arange(len(point)) % (side * side)
        random = (np.stack([strata % side, strata // side]) + noise.random((2, len(point)))) / side
        while len(self.path):
            if self.depth > 0:
                self.add_lamps()
            if light.emitter_choice:
                self.add_emitters()
            self.step(random, most)
            self.depth += 1
            random = noise.random((2, len(self.path)))
        self.whole = self.found.sum((1, 2))

    def sums(self, at, each):
        return self.found.reshape(len(at), each, *self.found.shape[1:]).sum(1)

    def add(self, which, source, rgb):
        order = min(self.depth, SURE_REFLECTIONS + 1)
        self.found[self.path[which], order, source] += (self.through[which] * rgb) @ LUMINANCE

    def keep(self, which):
        for name in ("path", "normal", "flat", "place", "through", "on"):
            setattr(self, name, getattr(self, name)[which])

    def tried(self, choice, rows, tries):
        source, share = zip(*(choice.choose(rows, self.noise.random(len(rows))) for _ in range(tries)))
        return np.array(source), np.array(share, float)

    def resampled(self, worth):
        """Which of the tries (tries, n) is taken, as an index, and the mean worth."""
        reached = np.cumsum(worth, axis=0)
        taken = (self.noise.random(len(worth[0])) * reached[-1] >= reached).sum(0).clip(0, len(worth) - 1)
        return (taken, np.arange(len(taken))), reached[-1] / len(worth)

    def add_lamps(self):
        """One lamp of some (Talbot, Cline and Egbert 2005), without what holds the surface."""
        light, lamps = self.light, self.light.scene.lamps
        source, share = self.tried(light.lamp_choice, light.lamp_choice.rows(self.place), LAMP_TRIES)
        order = light.scene.node_order[self.on]
        lit = np.stack([lamp_light(lamps, k, self.place, self.normal) for k in source])
        lit[(order >= lamps["first"][source]) & (order < lamps["last"][source])] = 0
        taken, mean = self.resampled(lit / np.maximum(share, 1e-30))
        lamp = source[taken]
        some = np.flatnonzero(mean > 0)
        some = some[light.free(self.place[some], lamps["place"][lamp[some]], lamp[some])]
        self.add(some, LAMPS, lamps["colour"][lamp[some]] * (mean[some] / np.pi)[:, None])

    def add_emitters(self):
        """A place on one of some emitters, weighted against rays that meet it by chance (Veach and Guibas 1995)."""
        light, scene = self.light, self.light.scene
        choice = light.emitter_choice
        source, share = self.tried(choice, choice.rows(self.place), EMITTER_TRIES)
        root, v = np.sqrt(self.noise.random(source.shape)), self.noise.random(source.shape)
        weights = np.stack([1 - root, root * (1 - v), root * v], axis=-1)
        there = (scene.corners[light.emitters[source]] * weights[..., None]).sum(2)
        to = there - self.place
        square = np.maximum((to * to).sum(-1), 1e-9)
        to = to / np.sqrt(square)[..., None]
        here = np.maximum((to * self.normal).sum(-1), 0) * ((to * self.flat).sum(-1) > 0)
        cosine = -(to * light.front[light.emitters[source]]).sum(-1)
        cosine = np.where(light.twofold[source], np.abs(cosine), np.maximum(cosine, 0))
        per_area = here * cosine / square
        worth = per_area * light.area[source] / np.maximum(share, 1e-30) * light.mean[source]
        worth *= looked_for(share, light.area[source], cosine, square, here)
        taken, mean = self.resampled(worth)
        some = np.flatnonzero(mean > 0)
        source, there, weights = (values[taken][some] for values in (source, there, weights))
        free = light.free(self.place[some], there)
        some, source, weights = some[free], source[free], weights[free]
        shown = light.materials.emission(light.emitters[source], weights)
        self.add(some, EMITTERS, shown * (mean[some] / light.mean[source] / np.pi)[:, None])

    def step(self, random, most):
        """On by chance, as cosines: to the sky, or to a surface that may emit, and that reflects."""
        light, scene = self.light, self.light.scene
        direction = cosines(self.normal, random)
        above = np.flatnonzero((direction * self.flat).sum(1) > 0)
        self.keep(above)
        direction = direction[above]
        far = np.full(len(above), 1e5)
        t, along, u, v = light.rays.first_hits(self.place, direction, far, light.passes)
        self.add(np.flatnonzero(t < 0), SKY, light.sky)
        hit = np.flatnonzero(t >= 0)
        t, along, direction, weights = t[hit], along[hit], direction[hit], corner_weights(u[hit], v[hit])
        self.add_met(hit, t, along, direction, weights)
        if self.depth >= most:
            return self.keep(hit[:0])
        self.keep(hit)
        self.on = t
        flat = light.rays.flat[t]
        self.flat = self.normal = np.where(((flat * direction).sum(1) > 0)[:, None], -flat, flat)
        self.place = self.place + direction * along[:, None] + OFF_SURFACE * self.flat
        self.through = self.through * light.materials.reflectance(t, weights)
        self.roulette()

    def add_met(self, hit, t, along, direction, weights):
        light = self.light
        number = light.number[t]
        cosine = -(light.front[t] * direction).sum(1)
        some = np.flatnonzero(number >= 0)
        some = some[light.twofold[number[some]] | (cosine[some] > 0)]
        if len(some) == 0:
            return
        number, cosine, which = number[some], np.abs(cosine[some]), hit[some]
        choice = light.emitter_choice
        share = choice.share[choice.rows(self.place[which]), number]
        here = (direction[some] * self.normal[which]).sum(1)
        part = 1 - looked_for(share, light.area[number], cosine, along[some] ** 2, here)
        self.add(which, EMITTERS, light.materials.emission(t[some], weights[some]) * part[:, None])

    def roulette(self):
        strength = self.through @ LUMINANCE
        alive = strength > 0
        if self.depth >= MOST_REFLECTIONS:
            alive[:] = False
        elif self.depth >= SURE_REFLECTIONS:
            lives = np.clip(2 * strength, 0.05, 0.95)
            alive &= self.noise.random(len(strength)) < lives
            self.through = self.through / lives[:, None]
        self.keep(np.flatnonzero(alive))


def looked_for(share, area, cosine, square, here):
    """Weight of looking at a place on an emitter against meeting it along cosines."""
    look = EMITTER_TRIES * share / area * square
    meet = here * cosine / np.pi
    return look / np.maximum(look + meet, 1e-30)


def corner_weights(u, v):
    return np.stack([1 - u - v, u, v], axis=1)


def cosines(normal, random):
    """Directions distributed as cosines about normals (Malley 1988)."""
    across = unit(np.cross(normal, np.where(np.abs(normal[:, :1]) < 0.9, [1.0, 0, 0], [0, 1.0, 0])))
    radius, angle = np.sqrt(random[0]), 2 * np.pi * random[1]
    x, y, z = radius * np.cos(angle), radius * np.sin(angle), np.sqrt(np.maximum(1 - random[0], 0))
    return x[:, None] * across + y[:, None] * np.cross(normal, across) + z[:, None] * normal


def srgb(code):
    return np.where(code <= 0.04045, code / 12.92, ((code + 0.055) / 1.055) ** 2.4)
