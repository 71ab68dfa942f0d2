"""Ground floors: the arcade (arches, covered walk), plain fronts, shops and doors. Frame as in facade.py."""

import math

from .facade import BAY, GROUND_TOP
from .geometry import Mesh
from .layout import PAVEMENT_Y
from .tex_openings import SHOP_COLUMNS, SHOP_ROWS, SIGN_COLUMNS, SIGN_ROWS

PILLAR = 0.5  # half width of a pillar, half of which belongs to each bay
PILLAR_DEPTH = 0.85
SPRING = 3.75  # height where the arch begins
WALK_DEPTH = 3.6
CEILING = 5.45
SEGMENTS = 10
SHOP_COUNT = SHOP_COLUMNS * SHOP_ROWS
SHOP_PAINTS = ("shop_green", "shop_red", "shop_blue")


def _arch(radius_offset=0.0):
    """Points of the intrados from the left spring to the right one."""
    radius = BAY / 2.0 - PILLAR + radius_offset
    angles = [math.pi * (1.0 - k / SEGMENTS) for k in range(SEGMENTS + 1)]
    return [(BAY / 2.0 + radius * math.cos(a), SPRING + radius * math.sin(a)) for a in angles]


def _pierced_face(mesh, material, z, facing):
    """The wall around the arched opening; ``facing`` is +1 for outwards, -1 for the walk's side."""

    def face(points):
        corners = [(x, y, z) for x, y in points]
        mesh.quad(material, *(corners if facing > 0 else corners[::-1]))

    face([(0, 0), (PILLAR, 0), (PILLAR, SPRING), (0, SPRING)])
    face([(BAY - PILLAR, 0), (BAY, 0), (BAY, SPRING), (BAY - PILLAR, SPRING)])
    arch = _arch()
    face([(0, SPRING), arch[0], (arch[0][0], GROUND_TOP), (0, GROUND_TOP)])
    face([arch[-1], (BAY, SPRING), (BAY, GROUND_TOP), (arch[-1][0], GROUND_TOP)])
    for (x0, y0), (x1, y1) in zip(arch, arch[1:]):
        face([(x0, y0), (x1, y1), (x1, GROUND_TOP), (x0, GROUND_TOP)])


def arcade_front(tint):
    """One arch on two half pillars, with archivolt, keystone, imposts and plinths."""
    mesh = Mesh(f"arcade_front_{tint}")
    back = -PILLAR_DEPTH
    _pierced_face(mesh, tint, 0.0, 1)
    _pierced_face(mesh, tint, back, -1)
    right = BAY - PILLAR
    mesh.quad(tint, (PILLAR, 0, 0), (PILLAR, 0, back), (PILLAR, SPRING, back), (PILLAR, SPRING, 0))
    mesh.quad(tint, (right, 0, back), (right, 0, 0), (right, SPRING, 0), (right, SPRING, back))
    inner, outer = _arch(), _arch(0.3)
    count, step = len(inner), 0.07
    soffit = [(x, y, z) for x, y in inner for z in (step, back)]
    band = [(x, y, step) for pair in zip(inner, outer) for x, y in pair]
    rim = [(x, y, z) for x, y in outer for z in (step, 0.0)]
    strip = [t for k in range(0, 2 * count - 2, 2) for t in ((k, k + 1, k + 3), (k, k + 3, k + 2))]
    flipped = [(a, c, b) for a, b, c in strip]
    mesh.add("stone_trim", soffit, strip, crease_deg=40.0)
    mesh.add("stone_trim", band, flipped)
    mesh.add("stone_trim", rim, flipped, crease_deg=40.0)
    crown = inner[SEGMENTS // 2][1]
    mesh.box("stone_trim", (BAY / 2 - 0.17, crown - 0.04, 0), (BAY / 2 + 0.17, crown + 0.42, 0.17), skip="-z")
    for x0, x1, hidden in ((0.0, PILLAR + 0.05, "-x"), (right - 0.05, BAY, "+x")):
        mesh.box("stone_trim", (x0, SPRING - 0.26, back - 0.04), (x1, SPRING, 0.06), skip=hidden)
        mesh.box("stone_trim", (x0, PAVEMENT_Y, back - 0.04), (x1, 0.75, 0.06), skip="-y" + hidden)
    return mesh


def arcade_walk():
    """Floor, ceiling and cross beam of the covered walk behind one arch."""
    mesh = Mesh("arcade_walk")
    y, back = PAVEMENT_Y, -WALK_DEPTH
    mesh.quad("arcade_floor", (0, y, 0), (BAY, y, 0), (BAY, y, back), (0, y, back))
    mesh.quad(
        "plaster", (0, CEILING, back), (BAY, CEILING, back), (BAY, CEILING, -PILLAR_DEPTH), (0, CEILING, -PILLAR_DEPTH)
    )
    mesh.box("plaster", (0, 4.95, back), (0.2, CEILING, -PILLAR_DEPTH), skip="+y-z+z-x")
    mesh.box("plaster", (BAY - 0.2, 4.95, back), (BAY, CEILING, -PILLAR_DEPTH), skip="+y-z+z+x")
    return mesh


def arcade_lantern():
    """A lantern hung from the arcade ceiling, origin at its light point."""
    mesh = Mesh("arcade_lantern")
    mesh.box("iron", (-0.012, 0.25, -0.012), (0.012, 1.4, 0.012), skip="+y-y")
    mesh.lathe("iron", [(0.17, 0.18), (0.05, 0.3), (0.0, 0.32)], 6)
    mesh.lathe("arcade_lamp_glass", [(0.0, -0.2), (0.11, -0.19), (0.16, 0.18)], 6, crease_deg=20.0)
    return mesh


def shop(variant):
    """A painted timber shop front in the plane z = 0 with display ``variant`` and an entresol wall above."""
    mesh = Mesh(f"shop_{variant}")
    paint = SHOP_PAINTS[variant % len(SHOP_PAINTS)]
    base = PAVEMENT_Y
    x0, x1 = 0.3, BAY - 0.3
    mesh.quad("plaster", (0, 3.85, 0), (BAY, 3.85, 0), (BAY, CEILING, 0), (0, CEILING, 0))
    for a, b in ((0.0, x0), (x1, BAY)):
        mesh.box("stone_trim", (a, base, 0), (b, 3.85, 0.12), skip="-z-y")
    mesh.box(paint, (x0, base, 0), (x1, 0.6, 0.1), skip="-z-y-x+x")
    mesh.quad(
        "shop_window",
        (x0, 0.6, 0.02),
        (x1, 0.6, 0.02),
        (x1, 3.05, 0.02),
        (x0, 3.05, 0.02),
        _cell(variant, SHOP_COLUMNS, SHOP_ROWS, 0.004),
    )
    for x in (BAY / 2 - 0.52, BAY / 2 + 0.44):
        mesh.box(paint, (x, 0.6, 0.0), (x + 0.08, 3.05, 0.1), skip="-z-y+y")
    mesh.box(paint, (x0 - 0.08, 3.05, 0), (x1 + 0.08, 3.85, 0.16), skip="-z+y")
    mesh.box(paint, (x0 - 0.14, 3.77, 0), (x1 + 0.14, 3.92, 0.3), skip="-z")
    mesh.quad(
        "sign_lit",
        (x0 + 0.15, 3.13, 0.175),
        (x1 - 0.15, 3.13, 0.175),
        (x1 - 0.15, 3.72, 0.175),
        (x0 + 0.15, 3.72, 0.175),
        _cell(variant, SIGN_COLUMNS, SIGN_ROWS, 0.004),
    )
    return mesh


def _threshold(mesh, x0, x1, back):
    """The step into an opening: its riser and its tread at pavement level."""
    y = PAVEMENT_Y
    mesh.quad("granite", (x0, 0, 0), (x1, 0, 0), (x1, y, 0), (x0, y, 0))
    mesh.quad("paving", (x0, y, 0), (x1, y, 0), (x1, y, back), (x0, y, back))


def plain_front(tint):
    """A stone ground floor with a square shop opening of 3.15 m, to be filled by :func:`shop`."""
    mesh = Mesh(f"plain_front_{tint}")
    x0, x1, top = 0.3, BAY - 0.3, 4.1
    for a, b, y0, y1 in ((0, x0, 0, top), (x1, BAY, 0, top), (0, BAY, top, GROUND_TOP)):
        mesh.quad(tint, (a, y0, 0), (b, y0, 0), (b, y1, 0), (a, y1, 0))
    back = -0.4
    mesh.quad("stone_trim", (x0, 0, 0), (x0, 0, back), (x0, top, back), (x0, top, 0))
    mesh.quad("stone_trim", (x1, 0, back), (x1, 0, 0), (x1, top, 0), (x1, top, back))
    mesh.quad("stone_trim", (x0, top, back), (x1, top, back), (x1, top, 0), (x0, top, 0))
    _threshold(mesh, x0, x1, back)
    mesh.moulding(
        "stone_trim", [(0, top + 0.1), (0.14, top + 0.16), (0.16, top + 0.34), (0, top + 0.4)], 0, BAY, ends=False
    )
    return mesh


def door_front(tint):
    """A stone ground floor with a carriage door under a flat arch."""
    mesh = Mesh(f"door_front_{tint}")
    x0, x1, top, back = 0.85, BAY - 0.85, 4.1, -0.4
    for a, b, y0, y1 in ((0, x0, 0, top), (x1, BAY, 0, top), (0, BAY, top, GROUND_TOP)):
        mesh.quad(tint, (a, y0, 0), (b, y0, 0), (b, y1, 0), (a, y1, 0))
    mesh.quad("stone_trim", (x0, 0, 0), (x0, 0, back), (x0, top, back), (x0, top, 0))
    mesh.quad("stone_trim", (x1, 0, back), (x1, 0, 0), (x1, top, 0), (x1, top, back))
    mesh.quad("stone_trim", (x0, top, back), (x1, top, back), (x1, top, 0), (x0, top, 0))
    mesh.quad("door", (x0, PAVEMENT_Y, back), (x1, PAVEMENT_Y, back), (x1, top, back), (x0, top, back), (0, 0, 1, 1))
    _threshold(mesh, x0, x1, back)
    for a, b in ((x0 - 0.24, x0), (x1, x1 + 0.24)):
        mesh.box("stone_trim", (a, 0, 0), (b, top, 0.09), skip="-z-y+y")
    mesh.box("stone_trim", (x0 - 0.24, top, 0), (x1 + 0.24, top + 0.3, 0.09), skip="-z")
    mesh.box("stone_trim", (BAY / 2 - 0.2, top - 0.05, 0), (BAY / 2 + 0.2, top + 0.6, 0.2), skip="-z")
    return mesh


def awning():
    """A canvas awning over a shop, 3 m wide, fixed at z = 0."""
    mesh = Mesh("awning")
    x0, x1 = 0.35, BAY - 0.35
    high, low, reach = 3.75, 2.95, 1.25
    mesh.quad("awning", (x0, low, reach), (x1, low, reach), (x1, high, 0), (x0, high, 0), (0, 0, 3, 1))
    mesh.quad("awning", (x1, low, reach), (x0, low, reach), (x0, high, 0), (x1, high, 0), (0, 0, 3, 1))
    for facing in (1, -1):
        a, b = (x0, x1) if facing > 0 else (x1, x0)
        mesh.quad(
            "awning", (a, low - 0.22, reach), (b, low - 0.22, reach), (b, low, reach), (a, low, reach), (0, 0, 3, 0.2)
        )
    return mesh


def _cell(index, columns, rows, inset):
    column, row = index % columns, index // columns
    return ((column + inset) / columns, (row + inset) / rows, (column + 1 - inset) / columns, (row + 1 - inset) / rows)
