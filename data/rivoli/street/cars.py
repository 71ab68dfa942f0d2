"""Car bodies as lofts of cross sections, with glass, wheels, lamps and plates.

The front looks to -Z, the origin lies on the ground below the middle.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from .geometry import Mesh, rotation, translation
from .tex_small import PLATE_COUNT

PAINTS = ("paint_white", "paint_silver", "paint_grey", "paint_black", "paint_blue", "paint_red", "paint_beige")
SILL = 0.2
TRACK_INSET = 0.11
PANEL_KNOTS = (0.0, 0.28, 0.50, 0.74, 1.0)  # texture u of front, cowl, pillar, end of roof and rear
PANEL_SHARE = 0.75  # part of the panel texture's height that shows the side view
PLAIN_PANEL = (0.5, 0.9)  # where that texture is plain


@dataclass(frozen=True)
class Body:
    """Side view in metres; stations are distances from the front bumper."""

    name: str
    length: float
    width: float
    height: float
    cowl: float  # foot of the windscreen
    roof_front: float
    roof_rear: float
    rear_foot: float  # foot of the rear window
    nose_height: float
    cowl_height: float
    deck_height: float
    wheels: tuple
    wheel_radius: float

    @property
    def pillar(self):
        """Station of the middle door pillar."""
        return (self.roof_front + self.roof_rear) / 2

    def top(self, s):
        """Height of the outline at station ``s``."""
        knots = [
            (0.0, self.nose_height),
            (0.18, self.nose_height + 0.09),
            (self.cowl, self.cowl_height),
            (self.roof_front, self.height - 0.05),
            (self.pillar, self.height),
            (self.roof_rear, self.height - 0.06),
            (self.rear_foot, self.deck_height),
            (self.length - 0.12, self.deck_height - 0.05),
            (self.length, self.deck_height - 0.14),
        ]
        return float(np.interp(s, *zip(*knots)))

    def half_width(self, s):
        """Half width of the body at station ``s``."""
        end = self.length
        knots = [(0.0, 0.76), (0.18, 0.90), (0.7, 0.985), (1.3, 1.0), (end - 0.9, 1.0), (end - 0.15, 0.95), (end, 0.86)]
        return self.width / 2 * float(np.interp(s, *zip(*knots)))

    def lamp_points(self):
        """Node-local positions of the right headlamp and tail lamp."""
        head = (0.60 * self.width / 2, self.nose_height - 0.10, -self.length / 2 - 0.03)
        tail = (0.70 * self.width / 2, self.deck_height - 0.30, self.length / 2 + 0.04)
        return head, tail


BODIES = {
    "sedan": Body("sedan", 4.55, 1.80, 1.45, 1.28, 2.08, 3.10, 3.85, 0.72, 0.95, 1.02, (0.86, 3.55), 0.32),
    "hatchback": Body("hatchback", 3.95, 1.72, 1.48, 1.02, 1.78, 3.15, 3.78, 0.74, 0.98, 0.98, (0.76, 3.25), 0.30),
    "suv": Body("suv", 4.45, 1.86, 1.68, 1.22, 1.92, 3.70, 4.25, 0.86, 1.10, 1.12, (0.86, 3.50), 0.36),
    "van": Body("van", 4.75, 1.92, 2.02, 0.92, 1.62, 4.45, 4.68, 0.86, 1.14, 1.2, (0.88, 3.75), 0.33),
}
# The driver's car: a lower scuttle and a flatter bonnet, which show from the driver's seat.
EGO_BODY = replace(BODIES["hatchback"], name="ego", nose_height=0.76, cowl_height=0.90)


def _stations(body):
    """Distances from the front where the loft has a cross section."""
    marks = [0.0, 0.16, body.cowl, body.roof_front, body.roof_rear, body.rear_foot, body.length - 0.12, body.length]
    arch = body.wheel_radius + 0.07
    for centre in body.wheels:
        marks += [centre + arch * f for f in (-1.0, -0.8, -0.4, 0.4, 0.8, 1.0)]
    marks += [body.pillar - 0.045, body.pillar + 0.045]
    return sorted(marks)


def _section(body, s):
    """Right-hand half of the section at ``s`` (x, y): sill, flank, belt, pillar foot, roof edge, centre."""
    half, top = body.half_width(s), body.top(s)
    arch = body.wheel_radius + 0.07
    bottom = SILL + (0.06 if s < 0.1 or s > body.length - 0.1 else 0.0)
    for centre in body.wheels:
        inside = 1.0 - ((s - centre) / arch) ** 2
        if inside > 0.0:
            bottom = max(bottom, SILL + (body.wheel_radius + arch - SILL) * math.sqrt(inside))
    flank = max(0.60, bottom + 0.03)
    cabin = float(np.clip((top - body.cowl_height) / (body.height - body.cowl_height), 0.0, 1.0))
    belt = max(min(body.cowl_height + 0.01, top - 0.08), flank + 0.02)
    shoulder = half * (0.90 - 0.16 * cabin)
    edge = half * (0.80 - 0.17 * cabin)
    drop = 0.03 + 0.05 * cabin
    return [
        (half * 0.955, bottom),
        (half, flank),
        (half * 0.965, belt),
        (shoulder, max(top - drop, belt + 0.01)),
        (edge, top),
        (0.0, top + 0.025),
    ]


def _cell_kind(body, s, j):
    """What the loft cell at station ``s`` between section points j and j + 1 is made of."""
    if j < 2:
        return "side"
    if j == 2 and body.cowl < s < body.roof_rear and abs(s - body.pillar) > 0.05:
        return "panel" if body.name == "van" and s > body.pillar else "glass"
    if j == 4 and body.cowl < s < body.roof_front:
        return "windscreen"
    if j == 4 and body.roof_rear < s < body.rear_foot:
        return "glass"
    return "panel"


def _shell(body):
    """The body's points, their side-view texture coordinates, and its triangles by kind of cell."""
    stations = _stations(body)
    points, uvs = [], []
    for s in stations:
        half = _section(body, s)
        points += [(sign * x, y, s - body.length / 2) for sign in (1, -1) for x, y in half]
        u = float(np.interp(s, (0.0, body.cowl, body.pillar, body.roof_rear, body.length), PANEL_KNOTS))
        uvs += [(u, PANEL_SHARE * (1.2 - y) / 1.05) for _ in (1, -1) for _, y in half]
    count = len(points) // len(stations) // 2
    triangles = {"side": [], "panel": [], "glass": [], "windscreen": []}
    for i in range(len(stations) - 1):
        middle = (stations[i] + stations[i + 1]) / 2
        for j in range(count - 1):
            for side in (0, count):
                a = 2 * count * i + side + j
                quad = (a, a + 1, a + 1 + 2 * count, a + 2 * count)
                if side:
                    quad = quad[::-1]
                triangles[_cell_kind(body, middle, j)] += [quad[:3], (quad[0], quad[2], quad[3])]
    last = 2 * count * (len(stations) - 1)
    for base, flip in ((0, False), (last, True)):
        ring = [base + k for k in range(count)] + [base + count + k for k in range(count - 2, -1, -1)]
        hub = count - 1
        fan = [
            (ring[hub], ring[(k + 1) % len(ring)], ring[k])
            for k in range(len(ring))
            if hub not in (k, (k + 1) % len(ring))
        ]
        triangles["panel"] += [(a, c, b) if flip else (a, b, c) for a, b, c in fan]
    return points, uvs, triangles


def paint_mesh(body, paint):
    """The painted panels, one primitive; the sides carry the door gaps of the panel texture."""
    mesh = Mesh(f"car_{body.name}_{paint}")
    points, uvs, triangles = _shell(body)
    mesh.add(paint, points, triangles["side"], uvs, crease_deg=45.0)
    mesh.add(paint, points, triangles["panel"], [PLAIN_PANEL] * len(points), crease_deg=45.0)
    return mesh


def trim_mesh(body, plate, windscreen=True):
    """Glass, mirrors, wheels, underbody, bumpers, grille and plates; ``windscreen`` False leaves that pane out."""
    mesh = Mesh(f"car_{body.name}_trim_{plate}{'' if windscreen else '_open'}")
    points, _, triangles = _shell(body)
    panes = triangles["glass"] + (triangles["windscreen"] if windscreen else [])
    mesh.add("car_glass", points, panes, crease_deg=38.0)
    front, rear, half = -body.length / 2, body.length / 2, body.width / 2
    under = half - 0.25
    mesh.box("car_black", (-under, 0.17, front + 0.2), (under, body.nose_height - 0.08, rear - 0.2), skip="+y")
    for side in (-1, 1):
        low, high = sorted((side * half * 0.93, side * (half + 0.12)))
        z = body.cowl + 0.36 + front
        mesh.box(
            "car_black",
            (low, body.cowl_height + 0.03, z),
            (high, body.cowl_height + 0.15, z + 0.1),
            skip="-x" if side > 0 else "+x",
        )
    bumper = half * 0.80
    mesh.box("car_black", (-bumper, 0.24, front - 0.03), (bumper, 0.44, front + 0.1), skip="+z")
    mesh.box("car_black", (-half * 0.86, 0.26, rear - 0.1), (half * 0.86, 0.46, rear + 0.03), skip="-z")
    mesh.box(
        "car_black",
        (-0.34, body.nose_height - 0.17, front - 0.015),
        (0.34, body.nose_height - 0.05, front + 0.1),
        skip="+z",
    )
    _plate(mesh, plate, 0.34, front - 0.036, -1)
    _plate(mesh, plate, 0.37 if body.name == "suv" else body.deck_height - 0.40, rear + 0.036, 1)
    for centre in body.wheels:
        for side in (-1, 1):
            turn = rotation("z", -90.0 if side > 0 else 90.0)
            place = translation(side * (half - TRACK_INSET), body.wheel_radius, front + centre)
            mesh.merge(_wheel(body.wheel_radius), place @ turn)
    return mesh


def _plate(mesh, plate, y, z, facing):
    """A 0.52 m number plate on a dark backing, facing +Z or -Z."""
    v0, v1 = (plate + 0.05) / PLATE_COUNT, (plate + 0.95) / PLATE_COUNT
    a, b = -0.26 * facing, 0.26 * facing
    back = z - 0.004 * facing
    mesh.quad(
        "car_black",
        (a * 1.08, y - 0.075, back),
        (b * 1.08, y - 0.075, back),
        (b * 1.08, y + 0.075, back),
        (a * 1.08, y + 0.075, back),
    )
    mesh.quad("plates", (a, y - 0.055, z), (b, y - 0.055, z), (b, y + 0.055, z), (a, y + 0.055, z), (0.0, v0, 1.0, v1))


def _wheel(radius):
    """A wheel lying on its axis Y, outer face up."""
    mesh = Mesh("wheel")
    segments = 11
    mesh.lathe("car_black", [(radius, -0.09), (radius, 0.07), (radius * 0.93, 0.1)], segments)
    angles = [math.tau * k / segments for k in range(segments)]
    rim = [(radius * 0.93 * math.sin(a), 0.1, radius * 0.93 * math.cos(a)) for a in angles]
    uvs = [(0.5 + 0.48 * math.sin(a), 0.5 + 0.48 * math.cos(a)) for a in angles]
    mesh.add("wheel", rim, [(0, k, k + 1) for k in range(1, segments - 1)], uvs)
    return mesh


def lamp_mesh(body, parked):
    """Headlamp and tail-lamp glasses, of the driving or the parked materials."""
    suffix = "_parked" if parked else ""
    mesh = Mesh(f"car_{body.name}_lamps{suffix}")
    (hx, hy, hz), (tx, ty, tz) = body.lamp_points()
    for side in (-1, 1):
        a, b = sorted((side * (hx - 0.15), side * (hx + 0.11)))
        mesh.box(f"headlamp_glass{suffix}", (a, hy - 0.07, hz + 0.005), (b, hy + 0.07, hz + 0.16), skip="+z")
        a, b = sorted((side * (tx - 0.09), side * (tx + 0.11)))
        mesh.box(f"tail_glass{suffix}", (a, ty - 0.13, tz - 0.14), (b, ty + 0.13, tz - 0.01), skip="-z")
    return mesh


def cockpit_mesh(body):
    """What the driver of the ego car sees of its inside: dashboard, instrument hood, wheel rim; seat at x = -0.37."""
    mesh = Mesh("car_ego_cockpit")
    z = body.cowl - body.length / 2
    half = body.width / 2 - 0.10
    y = body.cowl_height
    mesh.quad(
        "car_black",
        (-half, y - 0.05, z + 0.50),
        (half, y - 0.05, z + 0.50),
        (half, y + 0.04, z - 0.02),
        (-half, y + 0.04, z - 0.02),
    )
    mesh.quad(
        "car_black",
        (-half, 0.45, z + 0.55),
        (half, 0.45, z + 0.55),
        (half, y - 0.05, z + 0.50),
        (-half, y - 0.05, z + 0.50),
    )
    mesh.box("car_black", (-0.56, y - 0.08, z + 0.34), (-0.18, y + 0.035, z + 0.52))
    angles = [math.tau * k / 20 for k in range(21)]
    centre = (-0.37, 0.84, z + 0.72)
    rim = [
        (centre[0] + 0.185 * math.cos(a), centre[1] + 0.17 * math.sin(a), centre[2] - 0.075 * math.sin(a))
        for a in angles
    ]
    mesh.tube("car_black", rim, [0.015] * len(rim), 5)
    return mesh
