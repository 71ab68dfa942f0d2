"""Rays through a scene with Embree, and the direct light of lamps, for tools/oracle/oracle. SPDX-License-Identifier: MIT"""

import numpy as np
from embreex.mesh_construction import TriangleMesh
from embreex.rtcore_scene import EmbreeScene

SHADOW_MEMORY = 192  # MiB
MOST_TEXELS = 10469 << 12  # that it has room for
LEAST_SIDE, MOST_SIDE, MOST_ZOOM, FAINTEST, WIDEST_FLAT = 64, 2048, 8, 0.01, np.pi / 6  # docs/design/shadows.md
OFF_SURFACE = 1e-3   # m, from a surface to where its rays begin
PAST_HIT = 1e-4      # m, from a hit that does not count to where its ray goes on
MOST_HITS = 200      # of one ray that do not count
CHUNK = 1 << 20      # rays


def unit(v):
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-300)


class Rays:
    def __init__(self, scene):
        self.scene = scene
        self.embree = EmbreeScene(robust=True)
        self.mesh = TriangleMesh(self.embree, np.ascontiguousarray(scene.corners, np.float32))
        self.flat = unit(np.cross(scene.corners[:, 1] - scene.corners[:, 0], scene.corners[:, 2] - scene.corners[:, 0]))
        self.masked = scene.cutoff[scene.material] >= 0
        self.cast = 0

    def first_hits(self, origin, direction, reach, passes):
        """The first hit of each ray that counts: triangle (-1: none), distance in lengths of `direction`, u, v. `passes(rays,
        triangles, along, u, v)`: which hits do not count."""
        n = len(origin)
        triangle, distance, u, v = np.full(n, -1), np.full(n, np.inf), np.zeros(n), np.zeros(n)
        left, start = np.arange(n), np.zeros(n)
        length = np.linalg.norm(direction, axis=1)
        for _ in range(MOST_HITS):
            if len(left) == 0:
                break
            self.cast += len(left)
            begin = origin[left] + direction[left] * start[left, None]
            got = self.embree.run(begin.astype(np.float32), direction[left].astype(np.float32),
                                  dists=np.maximum(reach[left] - start[left], 0).astype(np.float32), query="INTERSECT", output=True)
            hit = got["primID"] >= 0
            left = left[hit]
            t, along = got["primID"][hit], start[left] + got["tfar"][hit]
            hu, hv = got["u"][hit].astype(float), got["v"][hit].astype(float)
            gone = passes(left, t, hu, hv)
            done = left[~gone]
            triangle[done], distance[done], u[done], v[done] = t[~gone], along[~gone], hu[~gone], hv[~gone]
            left, along = left[gone], along[gone]
            start[left] = along + PAST_HIT / length[left]
            left = left[start[left] < reach[left]]
        return triangle, distance, u, v

    def surfaces(self, camera, pixels, size):
        """What pixels see, as an object with position, normal (towards the eye), flat normal, triangle and depth, m."""
        turn, eye, fov, near = camera
        high = np.tan(fov / 2)
        scale = np.array([2 * high * size[0] / size[1] / size[0], -2 * high / size[1]])
        ray = np.concatenate([(pixels + 0.5) * scale + [-high * size[0] / size[1], high], -np.ones((len(pixels), 1))], axis=1)
        direction = ray @ turn.T
        material = self.scene.material

        def passes(rays, t, u, v):
            behind = (self.flat[t] * direction[rays]).sum(1) * self.scene.front[t] > 0
            return (behind & ~self.scene.both_sides[material[t]]) | self.open(t, u, v)

        t, depth, u, v = self.first_hits(eye + direction * near, direction, np.full(len(pixels), 1e5), passes)
        depth = depth + near
        weights = np.stack([1 - u - v, u, v], axis=1)
        normal = unit((self.scene.normals[t] * weights[..., None]).sum(1))
        behind = (self.flat[t] * direction).sum(1) * self.scene.front[t] > 0
        normal[behind] *= -1
        flat = self.flat[t] * -np.sign((self.flat[t] * direction).sum(1))[:, None]
        return {"triangle": t, "depth": depth, "position": eye + direction * np.where(t >= 0, depth, 0)[:, None], "normal": normal,
                "flat": flat, "pixel": pixels, "eye": eye}

    def open(self, t, u, v):
        gone = np.zeros(len(t), bool)
        some = np.flatnonzero(self.masked[t])
        if len(some):
            gone[some] = self.scene.open_at(t[some], u[some], v[some])
        return gone

    def blocked(self, origin, target, lamp):
        """Whether something but the lamp's fixture is between points and places of lamps, and the triangle that is (-1)."""
        first, last, order = self.scene.lamps["first"][lamp], self.scene.lamps["last"][lamp], self.scene.node_order
        found = np.full(len(origin), -1)
        for k in range(0, len(origin), CHUNK):
            here = slice(k, k + CHUNK)
            f, l = first[here], last[here]

            def passes(rays, t, u, v):
                own = (order[t] >= f[rays]) & (order[t] < l[rays])
                return own | self.open(t, u, v)

            found[here] = self.first_hits(origin[here], target[here] - origin[here], np.ones(len(f)), passes)[0]
        return found >= 0, found


def select(surfaces, which):
    return {key: value if key == "eye" else value[which] for key, value in surfaces.items()}


def lamp_light(lamps, k, position, normal):
    """Illuminance that lamps `k` give surfaces, lx, as if nothing stood between; arrays that go together."""
    to = lamps["place"][k] - position
    square = np.maximum((to * to).sum(-1), 1e-12)
    direction = to / np.sqrt(square)[..., None]
    cosine = -(lamps["axis"][k] * direction).sum(-1)
    ramp = np.clip(lamps["slope"][k] * cosine + lamps["offset"][k], 0, 1) ** 2
    power = np.where(cosine > 0, np.maximum(cosine, 1e-30) ** np.maximum(lamps["exponent"][k], 0), 0)
    intensity = lamps["intensity"][k] * np.where(lamps["exponent"][k] >= 0, power, ramp)
    return intensity * np.maximum((normal * direction).sum(-1), 0) / square


def pairs_of(lamps, surfaces, threshold):
    """Pairs of a surface and a lamp that gives it the threshold or more: their numbers, and the illuminance, lx."""
    points, lit, light = [], [], []
    for k in range(len(lamps["node"])):
        e = lamp_light(lamps, np.int64(k), surfaces["position"], surfaces["normal"])
        here = np.flatnonzero(e >= threshold)
        points.append(here), lit.append(np.full(len(here), k)), light.append(e[here])
    return np.concatenate(points), np.concatenate(lit), np.concatenate(light)


def disc(lamps, k, position, turn, sample, count):
    """Places on discs of the openings' areas, facing along the lamps' axes, or to the surface for lamps that shine to all
    sides: point `sample` of a spiral of `count`, turned by an angle."""
    facing = np.where((lamps["outer"][k] < 3)[:, None], lamps["axis"][k], unit(position - lamps["place"][k]))
    across = unit(np.cross(facing, np.where(np.abs(facing[:, :1]) < 0.9, [1.0, 0, 0], [0, 1.0, 0])))
    angle = turn + sample * np.pi * (3 - np.sqrt(5))
    radius = np.sqrt(lamps["area"][k] / np.pi * (sample + 0.5) / count)
    return lamps["place"][k] + radius[:, None] * (np.cos(angle)[:, None] * across + np.sin(angle)[:, None] * np.cross(facing, across))


def visible_share(rays, surfaces, points, lit, samples=0, noise=None, contact=0):
    """Share of each lamp that a surface sees: 0 or 1 of lamps as points (samples = 0), else of points on their openings.
    Nothing nearer than `contact`, m, along the ray to the lamp hides it."""
    lamps = rays.scene.lamps
    origin = surfaces["position"][points] + OFF_SURFACE * surfaces["flat"][points]
    if contact > 0:
        origin = origin + contact * unit(lamps["place"][lit] - origin)
    if samples == 0:
        return 1.0 - rays.blocked(origin, lamps["place"][lit], lit)[0]
    turn = noise.uniform(0, 2 * np.pi, len(points))
    seen = np.zeros(len(points))
    for s in range(samples):
        seen += ~rays.blocked(origin, disc(lamps, lit, origin, turn, s, samples), lit)[0]
    return seen / samples


class Maps:
    """Where points lie on the shadow maps of lamps that an eye sees, by the rules of docs/design/shadows.md and
    glsl/shared/shadow_map.h: needed only to say how many texels away a silhouette is."""

    def __init__(self, lamps, eye):
        self.lamps = lamps
        outer = lamps["outer"]
        sine = np.sqrt(2) * np.sin(outer)
        with np.errstate(divide="ignore"):
            self.zoom = np.where(outer >= np.pi / 2, 1, np.clip(0.98 * (sine + np.maximum(np.cos(outer), 0)) / sine, 1, MOST_ZOOM))
        self.fold = np.where(outer <= WIDEST_FLAT, 0.0, 1.0)
        flat_zoom = np.minimum(0.98 / (np.sqrt(2) * np.tan(np.minimum(outer, 1.0))), MOST_ZOOM)
        self.zoom = np.where(self.fold == 0, flat_zoom, self.zoom)
        hemispheres = np.where(outer > np.pi / 2 + 1e-3, 2, 1)
        wanted = np.sqrt(np.sqrt(lamps["intensity"] / FAINTEST)) / np.maximum(np.linalg.norm(lamps["place"] - eye, axis=1), 1)
        scale = 12 * 30 * 16.0
        while True:
            self.side = np.clip(2 ** np.round(np.log2(np.maximum(scale * wanted, 1))), LEAST_SIDE, MOST_SIDE)
            if (hemispheres * self.side**2).sum() <= MOST_TEXELS or scale < 1:
                break
            scale /= np.sqrt(2)
        z = lamps["axis"]
        x = lamps["right"] - (lamps["right"] * z).sum(1, keepdims=True) * z
        self.frame = np.stack([unit(x), np.cross(z, unit(x)), z], axis=1)

    def place(self, lit, position):
        """Texels from the corner of the square, and whether the direction is in the second hemisphere."""
        q = np.einsum("nij,nj->ni", self.frame[lit], position - self.lamps["place"][lit])
        fold = self.fold[lit, None]
        o = q / np.maximum(fold * np.abs(q[:, :2]).sum(1, keepdims=True) + np.abs(q[:, 2:]), 1e-9)
        square = self.zoom[lit, None] * np.stack([o[:, 0] + o[:, 1], o[:, 0] - o[:, 1]], axis=1)
        return (0.5 * square + 0.5) * self.side[lit, None], q[:, 2] < 0

    def direction(self, lit, texel, second):
        square = (2 * texel / self.side[lit, None] - 1) / self.zoom[lit, None]
        x, y = (square[:, 0] + square[:, 1]) / 2, (square[:, 0] - square[:, 1]) / 2
        z = np.maximum(1 - self.fold[lit] * (np.abs(x) + np.abs(y)), 0) * np.where(second, -1, 1)
        return np.einsum("nij,ni->nj", self.frame[lit], np.stack([x, y, z], axis=1))


def near_silhouette(rays, maps, surfaces, points, lit, seen, texels):
    """Whether rays to the surface's plane along directions up to so many texels of the lamp's map away disagree with `seen`,
    of the lamp as a point."""
    place = rays.scene.lamps["place"][lit]
    position, flat = surfaces["position"][points], surfaces["flat"][points]
    texel, second = maps.place(lit, position)
    near = np.zeros(len(points), bool)
    away = ((position - place) * flat).sum(1)
    for k in range(16):
        angle, radius = k * np.pi / 4 + (k // 8) * np.pi / 8, texels * (1 if k < 8 else 0.5)
        left = np.flatnonzero(~near)
        direction = maps.direction(lit[left], texel[left] + radius * np.array([np.cos(angle), np.sin(angle)]), second[left])
        with np.errstate(divide="ignore", invalid="ignore"):
            depth = away[left] / (direction * flat[left]).sum(1)
        # Of a surface seen from its edge nothing farther than it bends.
        usual = np.linalg.norm(position[left] - place[left], axis=1) / np.linalg.norm(direction, axis=1)
        depth = np.where((depth > 0.5 * usual) & (depth < 2 * usual), depth, usual)
        there = place[left] + direction * depth[:, None] + OFF_SURFACE * flat[left]
        near[left] = rays.blocked(there, place[left], lit[left])[0] == (seen[left] > 0.5)
    return near
