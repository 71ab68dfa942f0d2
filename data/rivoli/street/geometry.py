"""Triangle meshes by material: construction, automatic texture coordinates and creased normals.

All lengths are metres, Y is up, front faces wind counter-clockwise.
"""

import math

import numpy as np

from .materials import tile_metres


class Mesh:
    """A named mesh: per material one indexed triangle list with normals and texture coordinates."""

    def __init__(self, name):
        self.name = name
        self._parts = {}

    def add(self, material, positions, triangles, uvs=None, crease_deg=1.0, normals=None):
        """Append triangles. Without ``uvs`` the texture is box-projected at the material's scale.

        Faces meeting at less than ``crease_deg`` share a smooth normal, unless unit ``normals`` are given
        per position.
        """
        corners = np.asarray(positions, float)[np.asarray(triangles, int)]
        if uvs is None:
            texture = box_projection(corners, tile_metres(material))
        else:
            texture = np.asarray(uvs, float)[np.asarray(triangles, int)]
        area_normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        sound = np.linalg.norm(area_normals, axis=1) > 1e-9
        corners, texture, area_normals = corners[sound], texture[sound], area_normals[sound]
        if normals is None:
            shading = creased_normals(corners, area_normals, crease_deg)
        else:
            shading = np.asarray(normals, float)[np.asarray(triangles, int)][sound]
        self._parts.setdefault(material, []).append((corners, shading, texture))

    def quad(self, material, a, b, c, d, uv=None):
        """A planar quadrilateral a-b-c-d; ``uv`` is (u0, v0, u1, v1) with (u0, v1) at corner a."""
        uvs = None
        if uv is not None:
            u0, v0, u1, v1 = uv
            uvs = [(u0, v1), (u1, v1), (u1, v0), (u0, v0)]
        self.add(material, [a, b, c, d], [(0, 1, 2), (0, 2, 3)], uvs)

    def box(self, material, low, high, skip=""):
        """An axis-aligned box; ``skip`` lists faces to leave out, e.g. ``"-y+x"``."""
        (x0, y0, z0), (x1, y1, z1) = low, high
        faces = {
            "+x": [(x1, y0, z1), (x1, y0, z0), (x1, y1, z0), (x1, y1, z1)],
            "-x": [(x0, y0, z0), (x0, y0, z1), (x0, y1, z1), (x0, y1, z0)],
            "+y": [(x0, y1, z1), (x1, y1, z1), (x1, y1, z0), (x0, y1, z0)],
            "-y": [(x0, y0, z0), (x1, y0, z0), (x1, y0, z1), (x0, y0, z1)],
            "+z": [(x0, y0, z1), (x1, y0, z1), (x1, y1, z1), (x0, y1, z1)],
            "-z": [(x1, y0, z0), (x0, y0, z0), (x0, y1, z0), (x1, y1, z0)],
        }
        skipped = {skip[i : i + 2] for i in range(0, len(skip), 2)}
        for name, face in faces.items():
            if name not in skipped:
                self.quad(material, *face)

    def loft(self, material, rings, closed=True, crease_deg=50.0, cap_start=False, cap_end=False, uvs=None):
        """Skin a list of equal-length point rings; rings turn counter-clockwise seen from the sweep's end."""
        rings = np.asarray(rings, float)
        count, points = rings.shape[:2]
        triangles = []
        for i in range(count - 1):
            for j in range(points if closed else points - 1):
                k = (j + 1) % points
                a, b = i * points + j, i * points + k
                c, d = b + points, a + points
                triangles += [(a, b, c), (a, c, d)]
        if cap_start:
            triangles += [(0, j + 1, j) for j in range(1, points - 1)]
        if cap_end:
            base = (count - 1) * points
            triangles += [(base, base + j, base + j + 1) for j in range(1, points - 1)]
        self.add(material, rings.reshape(-1, 3), triangles, uvs, crease_deg)

    def lathe(self, material, profile, segments=8, centre=(0.0, 0.0, 0.0), crease_deg=50.0, phase=0.0):
        """Revolve (radius, height) points, given from the bottom up, about a vertical axis."""
        rings = []
        for radius, height in profile:
            angles = phase + 2.0 * math.pi * np.arange(segments) / segments
            ring = np.stack([radius * np.sin(angles), np.full(segments, height), radius * np.cos(angles)], 1)
            rings.append(ring + np.asarray(centre, float))
        self.loft(material, rings, crease_deg=crease_deg)

    def tube(self, material, path, radii, sides=6, crease_deg=80.0, cap_end=False):
        """A round bar along ``path`` with one radius per point."""
        path = np.asarray(path, float)
        tangents = np.gradient(path, axis=0)
        upright = abs(tangents[0][1]) > abs(tangents[0][2])
        reference = np.array([0.0, 0.0, 1.0] if upright else [0.0, 1.0, 0.0])
        rings = []
        for point, tangent, radius in zip(path, tangents, radii):
            axis = tangent / np.linalg.norm(tangent)
            right = np.cross(axis, reference)
            right /= np.linalg.norm(right)
            up = np.cross(right, axis)
            angles = 2.0 * math.pi * np.arange(sides) / sides
            rings.append(point + radius * (np.cos(angles)[:, None] * right - np.sin(angles)[:, None] * up))
        self.loft(material, rings, crease_deg=crease_deg, cap_end=cap_end)

    def moulding(self, material, profile, x0, x1, ends=True):
        """Sweep a (z, y) profile, listed from the bottom up on its outer side, along X."""
        left = [(x0, y, z) for z, y in profile]
        right = [(x1, y, z) for z, y in profile]
        for i in range(len(profile) - 1):
            self.quad(material, left[i], right[i], right[i + 1], left[i + 1])
        if ends:
            hub = len(profile) - 1
            fan = [(hub, i, i + 1) for i in range(hub - 1)]
            self.add(material, right, [(a, c, b) for a, b, c in fan])
            self.add(material, left, fan)

    def merge(self, other, matrix):
        """Append a copy of ``other`` under a rigid or scaling 4x4 ``matrix``."""
        linear = matrix[:3, :3]
        cofactor = np.linalg.inv(linear).T
        for material, chunks in other._parts.items():
            for corners, normals, texture in chunks:
                turned = normals @ cofactor.T
                turned /= np.linalg.norm(turned, axis=2, keepdims=True)
                moved = corners @ linear.T + matrix[:3, 3]
                self._parts.setdefault(material, []).append((moved, turned, texture))

    def primitives(self):
        """Yield (material, positions, normals, uvs, indices) as float32 arrays and an index array."""
        for material in sorted(self._parts):
            chunks = self._parts[material]
            columns = [np.concatenate(arrays).reshape(-1, arrays[0].shape[-1]) for arrays in zip(*chunks)]
            table = np.concatenate(columns, axis=1).astype(np.float32) + np.float32(0.0)  # no negative zeros
            unique, indices = np.unique(np.round(table, 5), axis=0, return_inverse=True)
            normals = unique[:, 3:6].astype(float)
            normals /= np.linalg.norm(normals, axis=1, keepdims=True)
            yield (
                material,
                np.ascontiguousarray(unique[:, :3]),
                normals.astype(np.float32),
                np.ascontiguousarray(unique[:, 6:8]),
                indices.reshape(-1),
            )

    def lowest(self):
        """The smallest y of all triangles."""
        return min(float(chunk[0][..., 1].min()) for chunks in self._parts.values() for chunk in chunks)

    def triangle_count(self):
        """Number of triangles over all materials."""
        return sum(len(chunk[0]) for chunks in self._parts.values() for chunk in chunks)


def box_projection(corners, tile):
    """Texture coordinates from each face's dominant axis; ``tile`` is metres per texture period."""
    normal = np.abs(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    axis = np.argmax(normal + np.array([1e-7, 0.0, 2e-7]), axis=1)
    x, y, z = corners[..., 0], corners[..., 1], corners[..., 2]
    u = np.where((axis == 0)[:, None], z, x)
    v = np.where((axis == 1)[:, None], z, -y)
    return np.stack([u, v], axis=2) / tile


def creased_normals(corners, area_normals, crease_deg):
    """Corner normals: area-weighted mean of the faces at a point that lie within the crease angle."""
    unit = area_normals / np.linalg.norm(area_normals, axis=1, keepdims=True)
    normals = np.repeat(unit[:, None, :], 3, axis=1)
    if crease_deg <= 1.0:
        return normals
    limit = math.cos(math.radians(crease_deg))
    _, point = np.unique(np.round(corners.reshape(-1, 3), 4), axis=0, return_inverse=True)
    point = point.reshape(-1)
    order = np.argsort(point, kind="stable")
    starts = np.searchsorted(point[order], np.arange(point.max() + 2))
    flat = normals.reshape(-1, 3)
    for k in range(len(starts) - 1):
        slots = order[starts[k] : starts[k + 1]]
        faces = slots // 3
        near = unit[faces] @ unit[faces].T >= limit
        mean = near @ area_normals[faces]
        length = np.linalg.norm(mean, axis=1, keepdims=True)
        flat[slots] = np.where(length > 1e-12, mean / np.maximum(length, 1e-12), unit[faces])
    return flat.reshape(-1, 3, 3)


def translation(x, y, z):
    """4x4 translation by metres."""
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix


def rotation(axis, degrees):
    """4x4 right-handed rotation about ``"x"``, ``"y"`` or ``"z"``."""
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    matrix = np.eye(4)
    matrix[i, i] = matrix[j, j] = c
    matrix[i, j], matrix[j, i] = -s, s
    return matrix


def scaling(x, y, z):
    """4x4 scale."""
    return np.diag([x, y, z, 1.0])


def quaternion(axis, degrees):
    """glTF rotation [x, y, z, w] about a coordinate axis."""
    half = math.radians(degrees) / 2.0
    value = [0.0, 0.0, 0.0, round(math.cos(half), 7)]
    value["xyz".index(axis)] = round(math.sin(half), 7)
    return value
