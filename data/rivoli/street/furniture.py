"""Street furniture meshes: lanterns, signals, signs, bollards, benches, bins, scooters. Origins at the foot."""

import math

from .cars import PLAIN_PANEL
from .geometry import Mesh, rotation, translation
from .layout import LAMP_Y, PAVEMENT_Y
from .tex_small import SIGN_CELLS

COLUMN_TOP = LAMP_Y - PAVEMENT_Y - 0.42
SIGNAL_HEADS = {"red": 3.32, "amber": 3.04, "green": 2.76}  # heights of the three lenses


def street_lamp():
    """A Parisian lantern on a fluted column; the light point is LAMP_Y above the carriageway."""
    mesh = Mesh("street_lamp")
    top = COLUMN_TOP
    mesh.lathe(
        "iron",
        [
            (0.24, 0.0),
            (0.24, 0.18),
            (0.16, 0.3),
            (0.16, 0.95),
            (0.2, 1.02),
            (0.085, 1.25),
            (0.06, top - 0.35),
            (0.1, top - 0.28),
            (0.05, top - 0.2),
            (0.05, top),
        ],
        7,
    )
    mesh.box("iron", (-0.42, top - 0.62, -0.02), (0.42, top - 0.58, 0.02))
    base, crown = top, top + 0.72
    mesh.lathe("iron", [(0.05, base - 0.08), (0.17, base), (0.17, base + 0.04)], 6)
    mesh.lathe("lamp_glass", [(0.155, base + 0.04), (0.27, crown)], 6, crease_deg=20.0)
    mesh.lathe(
        "iron",
        [
            (0.30, crown - 0.02),
            (0.31, crown + 0.04),
            (0.15, crown + 0.2),
            (0.12, crown + 0.24),
            (0.13, crown + 0.3),
            (0.03, crown + 0.38),
            (0.0, crown + 0.5),
        ],
        6,
        crease_deg=30.0,
    )
    for k in range(6):
        angle = math.tau * k / 6.0
        across = (0.014 * math.cos(angle), 0.0, -0.014 * math.sin(angle))
        foot = (0.162 * math.sin(angle), base + 0.02, 0.162 * math.cos(angle))
        head = (0.28 * math.sin(angle), crown, 0.28 * math.cos(angle))
        mesh.quad(
            "iron",
            *(
                [p[i] + sign * across[i] for i in range(3)]
                for p, sign in ((foot, -1), (foot, 1), (head, 1), (head, -1))
            ),
        )
    return mesh


def signal(state):
    """A traffic signal facing +Z; ``state`` is the lens that is lit, "red" or "green"."""
    mesh = Mesh(f"signal_{state}")
    mesh.lathe("iron", [(0.11, 0), (0.11, 0.5), (0.06, 0.6), (0.05, 3.6)], 8)
    mesh.box("car_black", (-0.15, 2.58, 0.06), (0.15, 3.5, 0.28))
    for name, height in SIGNAL_HEADS.items():
        material = f"signal_{name}" if name == state else "signal_off"
        lens = [
            (0.10 * math.cos(math.tau * k / 10), height + 0.10 * math.sin(math.tau * k / 10), 0.295) for k in range(10)
        ]
        mesh.add(material, lens, [(0, k, k + 1) for k in range(1, 9)])
        hood = [
            (0.125 * math.cos(math.pi * k / 6), height + 0.125 * math.sin(math.pi * k / 6), z)
            for k in range(7)
            for z in (0.28, 0.44)
        ]
        strip = [t for k in range(0, 12, 2) for t in ((k, k + 1, k + 3), (k, k + 3, k + 2))]
        mesh.add("car_black", hood, strip + [(a, c, b) for a, b, c in strip])
    return mesh


def road_sign(name, shape, low):
    """A sign on a tube, facing +Z; ``shape`` is "disc" or "plate", ``low`` its lower edge in metres."""
    mesh = Mesh(f"road_sign_{name}")
    size = 0.65
    mesh.lathe("grey_metal", [(0.03, 0.0), (0.03, low + size)], 6)
    index = SIGN_CELLS[name]
    u, v = (index % 4) / 4.0, (index // 4) / 2.0
    centre = low + size / 2.0
    if shape == "disc":
        outline = [(math.cos(math.tau * k / 16), math.sin(math.tau * k / 16)) for k in range(16)]
        scale = 0.484
    else:
        outline, scale = [(-1, -1), (1, -1), (1, 1), (-1, 1)], 0.496
    points = [(x * size / 2, centre + y * size / 2, 0.05) for x, y in outline]
    uvs = [(u + 0.125 + x * scale / 4, v + 0.25 - y * scale / 2) for x, y in outline]
    fan = [(0, k, k + 1) for k in range(1, len(outline) - 1)]
    mesh.add("road_signs", points, fan, uvs)
    mesh.add("grey_metal", [(x, y, 0.04) for x, y, _ in points], [(a, c, b) for a, b, c in fan])
    return mesh


def street_name_plate():
    """The blue enamel plate on a corner house, 0.9 m by 0.5 m, in the plane z = 0."""
    mesh = Mesh("street_name_plate")
    index = SIGN_CELLS["street_name"]
    u, v = (index % 4) / 4.0, (index // 4) / 2.0
    mesh.quad(
        "road_signs",
        (-0.45, 0, 0.03),
        (0.45, 0, 0.03),
        (0.45, 0.5, 0.03),
        (-0.45, 0.5, 0.03),
        (u + 0.004, v + 0.06, u + 0.246, v + 0.44),
    )
    return mesh


def pharmacy_cross():
    """The green cross of a pharmacy, hung out 0.9 m from a wall in the plane z = 0; origin at the arm's foot."""
    mesh = Mesh("pharmacy_cross")
    mesh.box("iron", (-0.02, -0.02, 0.0), (0.02, 0.02, 0.4))
    for x in (-0.09, 0.09):
        outward = 1 if x > 0 else -1
        for (y0, y1), (z0, z1) in (
            ((-0.42, 0.42), (0.7, 0.98)),
            ((-0.14, 0.14), (0.42, 0.7)),
            ((-0.14, 0.14), (0.98, 1.26)),
        ):
            corners = [(x, y0, z1), (x, y0, z0), (x, y1, z0), (x, y1, z1)]
            mesh.quad("sign_cross", *(corners if outward > 0 else corners[::-1]))
    outline = [
        (0.42, -0.14),
        (0.7, -0.14),
        (0.7, -0.42),
        (0.98, -0.42),
        (0.98, -0.14),
        (1.26, -0.14),
        (1.26, 0.14),
        (0.98, 0.14),
        (0.98, 0.42),
        (0.7, 0.42),
        (0.7, 0.14),
        (0.42, 0.14),
    ]
    for (z0, y0), (z1, y1) in zip(outline, outline[1:] + outline[:1]):
        mesh.quad("iron", (-0.09, y0, z0), (0.09, y0, z0), (0.09, y1, z1), (-0.09, y1, z1))
    return mesh


def bollard():
    """A Parisian cast-iron bollard, 1.05 m."""
    mesh = Mesh("bollard")
    mesh.lathe("iron", [(0.075, 0.0), (0.07, 0.15), (0.045, 0.2), (0.04, 0.85), (0.07, 0.95), (0.0, 1.06)], 6)
    return mesh


def bin_bag():
    """A municipal litter bin: post, hoop and green bag."""
    mesh = Mesh("litter_bin")
    mesh.lathe("grey_metal", [(0.04, 0.0), (0.04, 1.1), (0.0, 1.12)], 6)
    mesh.lathe("bin_green", [(0.16, 0.22), (0.22, 0.3), (0.23, 0.85)], 9, (0.0, 0.0, 0.26))
    mesh.lathe(
        "grey_metal",
        [(0.23, 0.85), (0.26, 0.87), (0.25, 0.93), (0.21, 0.93), (0.19, 0.7), (0.0, 0.68)],
        9,
        (0.0, 0.0, 0.26),
    )
    return mesh


def bench():
    """A slatted double bench, 1.9 m along x."""
    mesh = Mesh("bench")
    for x in (-0.8, 0.8):
        mesh.box("iron", (x - 0.03, 0, -0.22), (x + 0.03, 0.43, -0.16), skip="-y")
        mesh.box("iron", (x - 0.03, 0, 0.16), (x + 0.03, 0.86, 0.22), skip="-y")
        mesh.box("iron", (x - 0.03, 0.38, -0.16), (x + 0.03, 0.43, 0.16))
    for z in (-0.22, -0.08, 0.06):
        mesh.box("bench_wood", (-0.95, 0.43, z), (0.95, 0.47, z + 0.11))
    for y in (0.56, 0.72):
        mesh.box("bench_wood", (-0.95, y, 0.12), (0.95, y + 0.11, 0.16))
    return mesh


def kiosk():
    """A Morris column: dark green drum, posters, domed cap."""
    mesh = Mesh("morris_column")
    mesh.lathe("shop_green", [(0.75, 0.0), (0.75, 0.45), (0.66, 0.5)], 12)
    mesh.lathe("awning", [(0.64, 0.5), (0.64, 2.9)], 12)
    mesh.lathe(
        "shop_green",
        [
            (0.66, 2.9),
            (0.92, 2.98),
            (0.92, 3.1),
            (0.7, 3.2),
            (0.6, 3.5),
            (0.3, 3.8),
            (0.1, 3.9),
            (0.06, 4.2),
            (0.0, 4.35),
        ],
        12,
    )
    return mesh


def scooter(paint):
    """A parked motor scooter, front towards -Z, leaning on its stand."""
    mesh = Mesh(f"scooter_{paint}")
    for z in (-0.62, 0.58):
        disc = Mesh("wheel")
        disc.lathe(
            "car_black", [(0.0, -0.07), (0.2, -0.05), (0.25, 0.0), (0.2, 0.05), (0.0, 0.07)], 10, crease_deg=40.0
        )
        mesh.merge(disc, translation(0, 0.25, z) @ rotation("z", 90.0))
    mesh.box("car_black", (-0.15, 0.26, -0.28), (0.15, 0.33, 0.3))
    tail = [_slab(0.34, 0.16, 0.66, 0.11), _slab(0.52, 0.06, 0.84, 0.17), _slab(0.72, 0.0, 0.9, 0.13)]
    shield = [_shield(0.28, -0.30, 0.16), _shield(0.62, -0.40, 0.22), _shield(1.0, -0.5, 0.12)]
    for rings in (tail, shield):
        mesh.loft(paint, rings, cap_end=True, crease_deg=60.0, uvs=[PLAIN_PANEL] * 12)
    mesh.loft("car_black", [_slab(0.71, -0.04, 0.80, 0.13), _slab(0.80, 0.0, 0.72, 0.10)], cap_end=True)
    fender = [(-0.07, 0.5, -0.40), (0.07, 0.5, -0.40), (0.07, 0.46, -0.86), (-0.07, 0.46, -0.86)]
    mesh.loft(
        paint, [fender, [(x * 0.6, y + 0.06, z * 0.96) for x, y, z in fender]], cap_end=True, uvs=[PLAIN_PANEL] * 8
    )
    mesh.tube("car_black", [(-0.33, 1.06, -0.4), (0.33, 1.06, -0.4)], [0.022, 0.022], 5)
    mesh.tube("grey_metal", [(0, 0.25, -0.62), (0, 1.05, -0.44)], [0.04, 0.04], 5)
    mesh.box("grey_metal", (-0.07, 0.88, -0.6), (0.07, 0.99, -0.5))
    mesh.box("signal_off", (-0.07, 0.58, 0.84), (0.07, 0.65, 0.9))
    return mesh


def _slab(y, front, back, half):
    """A horizontal ring of the scooter's body from z = ``front`` to ``back``."""
    return [(-half, y, back), (half, y, back), (half, y, front), (-half, y, front)]


def _shield(y, z, half):
    """A horizontal ring of the scooter's leg shield."""
    return [(-half, y, z + 0.1), (half, y, z + 0.1), (half * 0.6, y, z - 0.06), (-half * 0.6, y, z - 0.06)]
