"""Trees, hedges and the garden's railing on the left-hand side."""

import math

import numpy as np

from .geometry import Mesh, quaternion
from .layout import BLOCKS, FACADE_X, GARDEN_BLOCK, PAVEMENT_Y, stream

WALL_HEIGHT = 0.75
PANEL = 6.0


def tree(variant):
    """A plane tree of about 11 m: tapering trunk, four limbs, foliage cards about an ellipsoidal crown."""
    mesh = Mesh(f"tree_{variant}")
    random = stream("tree", variant)
    height = 4.2 + 0.5 * variant
    mesh.tube(
        "bark", [(0, -0.1, 0), (0.03, 0.5, 0), (0.1, 2.2, 0.05), (0.05, height, 0.02)], [0.34, 0.24, 0.2, 0.16], 7
    )
    crown = np.array([0.05, height + 2.6, 0.0])
    radii = np.array([3.0, 3.3, 3.0])
    for k in range(4):
        bearing = math.tau * (k + random.random() * 0.6) / 4.0
        tip = crown + np.array([math.cos(bearing) * 1.7, random.uniform(-0.6, 1.0), math.sin(bearing) * 1.7])
        middle = np.array([0.05, height, 0.0]) * 0.4 + tip * 0.6 - np.array([0.0, 0.5, 0.0])
        mesh.tube("bark", [(0.05, height - 0.3, 0.02), middle, tip], [0.13, 0.09, 0.03], 5)
    for k in range(34):
        up = 1.0 - 2.0 * (k + 0.5) / 34.0
        bearing = k * 2.39996
        ring = math.sqrt(1.0 - up * up)
        direction = np.array([ring * math.cos(bearing), up, ring * math.sin(bearing)])
        centre = crown + direction * radii * random.uniform(0.5, 0.82)
        _card(mesh, centre, direction, random.uniform(1.15, 1.6), random)
    return mesh


def _card(mesh, centre, outward, half, random):
    """A tilted leaf card whose normals point away from the crown, so that the crown shades as a volume."""
    facing = outward + np.array([random.uniform(-0.7, 0.7) for _ in range(3)])
    facing /= np.linalg.norm(facing)
    right = np.cross((0.0, 1.0, 0.0) if abs(facing[1]) < 0.9 else (1.0, 0.0, 0.0), facing)
    right *= half / np.linalg.norm(right)
    up = np.cross(facing, right)
    points = [centre - right - up, centre + right - up, centre + right + up, centre - right + up]
    normals = [outward + 0.35 * (p - centre) / half for p in points]
    normals = [n / np.linalg.norm(n) for n in normals]
    mesh.add("foliage", points, [(0, 1, 2), (0, 2, 3)], [(0, 1), (1, 1), (1, 0), (0, 0)], normals=normals)


def _railing_panel():
    """Six metres of spear railing on a low stone wall, x from 0 to 6, a pier at each start."""
    mesh = Mesh("garden_railing_6m")
    y = PAVEMENT_Y
    mesh.box("stone_trim", (0, y, -0.2), (PANEL, y + WALL_HEIGHT - 0.12, 0.2), skip="-y-x+x")
    mesh.box("stone_trim", (0, y + WALL_HEIGHT - 0.12, -0.26), (PANEL, y + WALL_HEIGHT, 0.26), skip="-x+x")
    low = y + WALL_HEIGHT
    mesh.quad(
        "garden_railing", (0.3, low, 0), (PANEL, low, 0), (PANEL, low + 1.95, 0), (0.3, low + 1.95, 0), (0, 0, 3, 1)
    )
    mesh.box("stone_trim", (-0.3, y, -0.32), (0.3, low + 1.7, 0.32), skip="-y")
    mesh.box("stone_trim", (-0.38, low + 1.7, -0.4), (0.38, low + 1.9, 0.4))
    mesh.lathe(
        "stone_trim",
        [
            (0.0, low + 1.88),
            (0.16, low + 1.9),
            (0.11, low + 2.05),
            (0.24, low + 2.3),
            (0.2, low + 2.48),
            (0.0, low + 2.56),
        ],
        8,
    )
    return mesh


def _hedge():
    mesh = Mesh("hedge_12m")
    mesh.box("hedge", (-0.5, 0, -12), (0.5, 1.3, 0), skip="-y")
    return mesh


def place_greenery(document):
    """The garden: railing along the pavement and both side streets, five rows of trees, hedges."""
    root = document.node("garden")
    near, far = BLOCKS[GARDEN_BLOCK]
    panel, hedge = _railing_panel(), _hedge()
    for k in range(round((near - far) / PANEL)):
        document.node(
            f"garden_railing_{k:02d}", root, panel, (-FACADE_X - 0.4, 0, near - k * PANEL), quaternion("y", 90.0)
        )
    for k in range(5):
        document.node(f"garden_railing_near_{k}", root, panel, (-FACADE_X - 6.4 - k * PANEL, 0, near - 0.4))
        document.node(
            f"garden_railing_far_{k}", root, panel, (-FACADE_X - 0.4 - k * PANEL, 0, far + 0.4), quaternion("y", 180.0)
        )
    trees = [tree(variant) for variant in range(3)]
    random = stream("planting")
    rows = (-FACADE_X - 5.0, -FACADE_X - 10.5, -FACADE_X - 29.0, -FACADE_X - 36.0, -FACADE_X - 43.0)
    for r, x in enumerate(rows):
        for k in range(14):
            z = near - 6.0 - k * 8.3 - (4.0 if r % 2 else 0.0)
            size = random.uniform(0.88, 1.12)
            document.node(
                f"tree_{r}_{k:02d}",
                root,
                random.choice(trees),
                (x + random.uniform(-0.3, 0.3), PAVEMENT_Y, z),
                quaternion("y", random.uniform(0, 360)),
                (size, size * random.uniform(0.94, 1.08), size),
            )
    for k in range(10):
        document.node(f"hedge_{k}", root, hedge, (-FACADE_X - 46.0, PAVEMENT_Y, near - 12.0 * k), scale=(1.0, 2.6, 1.0))
        document.node(
            f"hedge_lawn_{k}", root, hedge, (-FACADE_X - 12.6, PAVEMENT_Y, near - 12.0 * k - 1.0), scale=(0.7, 0.5, 0.8)
        )
