"""Mansard roofs per bay with mitred corners, dormers, and party walls with chimneys. Frame as in facade.py."""

import math

from .facade import BAY
from .geometry import Mesh
from .materials import tile_metres

ZINC = [(-0.3, 16.55), (-0.42, 17.3), (-0.75, 18.2), (-1.3, 19.0), (-2.1, 19.6), (-3.6, 20.1)]
SLATE = [(-0.3, 16.55), (-1.15, 19.25)]
SLATE_TOP = [(-1.02, 19.22), (-1.25, 19.42), (-3.6, 20.1)]
PIECES = ("middle", "start", "end")
DORMER_FACE = -0.4


def roof_bay(kind, piece):
    """One bay of ``zinc`` (curved) or ``slate`` roof; ``start``/``end`` are mitred at a street corner."""
    mesh = Mesh(f"roof_{kind}_{piece}")
    if kind == "zinc":
        _sweep(mesh, "roof_zinc", ZINC, piece, 35.0)
    else:
        _sweep(mesh, "roof_slate", SLATE, piece, 1.0)
        _sweep(mesh, "roof_zinc", SLATE_TOP, piece, 1.0)
    return mesh


def _sweep(mesh, material, profile, piece, crease_deg):
    points, length = [], [0.0]
    for (z0, y0), (z1, y1) in zip(profile, profile[1:]):
        length.append(length[-1] + math.hypot(z1 - z0, y1 - y0))
    for z, y in profile:
        points.append((-z if piece == "start" else 0.0, y, z))
        points.append((BAY + z if piece == "end" else BAY, y, z))
    triangles = [t for k in range(0, 2 * len(profile) - 2, 2) for t in ((k, k + 1, k + 3), (k, k + 3, k + 2))]
    tile = tile_metres(material)
    uvs = [(points[2 * k + side][0] / tile, -s / tile) for k, s in enumerate(length) for side in (0, 1)]
    mesh.add(material, points, triangles, uvs, crease_deg)


def dormer(kind):
    """A dormer with an arched zinc (or pedimented slate) cap; its window is a separate node."""
    mesh = Mesh(f"dormer_{kind}")
    x0, x1, low, top = BAY / 2 - 0.66, BAY / 2 + 0.66, 16.62, 18.45
    depth = -1.6
    mesh.box("stone_trim", (x0, low, DORMER_FACE), (x0 + 0.16, top, DORMER_FACE + 0.1), skip="-z-y+y")
    mesh.box("stone_trim", (x1 - 0.16, low, DORMER_FACE), (x1, top, DORMER_FACE + 0.1), skip="-z-y+y")
    mesh.quad(
        "stone_trim",
        (x0, top - 0.1, DORMER_FACE + 0.1),
        (x1, top - 0.1, DORMER_FACE + 0.1),
        (x1, top, DORMER_FACE + 0.1),
        (x0, top, DORMER_FACE + 0.1),
    )
    for x, flip in ((x0, True), (x1, False)):
        side = [(x, low, DORMER_FACE), (x, low, depth), (x, top, depth), (x, top, DORMER_FACE)]
        mesh.quad("roof_zinc", *(side[::-1] if flip else side))
    steps = 6 if kind == "zinc" else 2
    cap = []
    for k in range(steps + 1):
        angle = math.pi * k / steps
        x = BAY / 2 + 0.78 * math.cos(angle)
        cap.append((x, top + (0.5 if kind == "zinc" else 0.42) * math.sin(angle)))
    front = DORMER_FACE + 0.22
    points = [(x, y, z) for x, y in cap for z in (front, -2.2)]
    strip = [t for k in range(0, 2 * steps, 2) for t in ((k, k + 1, k + 3), (k, k + 3, k + 2))]
    mesh.add("roof_zinc", points, strip, crease_deg=35.0)
    fan = [(x, y, front) for x, y in cap]
    mesh.add("stone_trim", fan, [(0, k, k + 1) for k in range(1, steps)])
    mesh.quad(
        "stone_trim",
        (cap[-1][0], top, front),
        (cap[-1][0], top, DORMER_FACE),
        (cap[0][0], top, DORMER_FACE),
        (cap[0][0], top, front),
    )
    return mesh


def chimney_wall():
    """The party wall between two buildings, standing proud of the roofs, with a chimney stack and pots."""
    mesh = Mesh("chimney_wall")
    outline = [(-0.12, 16.5), (-0.2, 17.4), (-0.5, 18.5), (-1.05, 19.4), (-1.9, 20.0), (-3.6, 20.5)]
    mesh.moulding("plaster", outline + [(-3.6, 16.5)], -0.2, 0.2)
    mesh.box("chimney_brick", (-0.36, 19.0, -3.5), (0.36, 22.1, -1.5), skip="-y")
    mesh.box("stone_trim", (-0.44, 22.1, -3.58), (0.44, 22.28, -1.42))
    for k in range(4):
        mesh.lathe("terracotta", [(0.13, 22.28), (0.1, 22.85), (0.12, 22.9)], 6, (0.0, 0.0, -1.75 - 0.5 * k))
    return mesh
