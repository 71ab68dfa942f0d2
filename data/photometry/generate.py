#!/usr/bin/env python3
# Makes the distributions of this folder: a road luminaire and a pair of headlamp beams. SPDX-License-Identifier: MIT
"""Standard library only. Run it in this folder; the files come out the same each time."""
import base64
import json
import math
import struct


def smooth(x, low, high):
    """1 below low, 0 above high, with no corner between."""
    t = min(max((x - low) / (high - low), 0.0), 1.0)
    return 1 - t * t * (3 - 2 * t)


def gauss(x, width):
    return math.exp(-((x / width) ** 2))


def street_lamp(c, gamma):
    """Relative intensity. C0 and C180 along the road, C90 across the street, C270 to the houses."""
    along = math.cos(math.radians(c))
    across = math.sin(math.radians(c))
    # Two wings along the road, turned a little to the street: C about 17 and 163, gamma about 63.
    turned = min(abs(c - 17), abs(c - 163), abs(c - 377))
    wings = gauss(turned, 32) * gauss(gamma - 68, 16 if gamma < 68 else 8)
    # What lies below and beside: even illuminance, less of it behind the pole.
    side = 1.0 if across >= 0 else 1 - 0.72 * abs(across) ** 0.7
    reach = 66 if across >= 0 else 66 - 24 * abs(across)
    below = 0.3 * min(math.cos(math.radians(gamma)) ** -1.5 if gamma < 80 else 1e3, 2.4)
    below *= smooth(gamma, reach - 26, reach + 8)
    bridge = 0.16 * abs(along) * gauss(gamma - 50, 18)
    return (wings + bridge + below * side_of(side, gamma)) * smooth(gamma, 74, 89)


def side_of(side, gamma):
    """At the nadir all planes are one direction."""
    return 1 + (side - 1) * min(gamma / 30, 1)


def low_beam(h, v):
    """Passing beam for right-hand traffic, cd; H > 0 right, V > 0 up, deg. Cut-off 0.57 deg below the horizon on the
    left, rising by 15 deg on the right."""
    cut = -0.57 + (min(math.tan(math.radians(15)) * h, 1.6) if h > 0 else 0)
    pool = 24000 * gauss(h - 1.6, 4.5) * gauss(v + 1.1, 1.3) + 5000 * gauss(h, 20) * gauss(v + 2.5, 3)
    return pool / (1 + math.exp(-max(min((cut - v) / 0.12, 500), -500))) + 180 * gauss(h, 12) * gauss(max(v, 0), 5)


def high_beam(h, v):
    """Driving beam, cd."""
    return 45000 * gauss(h, 4) * gauss(v, 1.8) + 12000 * gauss(h, 12) * gauss(v, 3)


def front_fog(h, v):
    """Front fog lamp, cd: wide, with a cut-off 1 deg below the horizon."""
    pool = 4000 * gauss(h, 26) * gauss(v + 2.5, 2.6)
    return pool / (1 + math.exp(max(min((v + 1) / 0.15, 500), -500))) + 60 * gauss(h, 30) * gauss(max(v, 0), 6)


def flux(c_step, gamma_step, value):
    total = 0.0
    for c in range(0, 360, c_step):
        for gamma in range(0, 90, gamma_step):
            band = math.cos(math.radians(gamma)) - math.cos(math.radians(gamma + gamma_step))
            corners = [value(c + i, gamma + j) for i in (0, c_step) for j in (0, gamma_step)]
            total += sum(corners) / 4 * band * math.radians(c_step)
    return total


def write_street_lamp(name, lumens):
    planes, gammas = list(range(0, 361, 5)), [2.5 * i for i in range(37)]
    scale = lumens / flux(5, 1, lambda c, g: street_lamp(c % 360, g))
    lines = [
        "IES:LM-63-2019",
        "[TEST] made by generate.py",
        "[TESTLAB] none: a design, not a measurement",
        "[ISSUEDATE] none",
        "[MANUFAC] Vesper",
        "[LUMINAIRE] road luminaire, two-sided, tilt 0",
        "[_ORIENTATION] C0 along the road, C90 across the street (CIE)",
        "TILT=NONE",
        f"1 -1 1 {len(gammas)} {len(planes)} 1 2 0.45 0.2 0",
        "1 1.00001 60",
    ]
    rows = [gammas, planes] + [[round(scale * street_lamp(c % 360, g), 1) for g in gammas] for c in planes]
    for row in rows:
        for i in range(0, len(row), 19):
            lines.append(" ".join(f"{x:g}" for x in row[i : i + 19]))
    with open(name, "w", newline="") as file:
        file.write("\r\n".join(lines) + "\r\n")


def axis(*ranges):
    """Angles from (first, last, step) pieces, made symmetrical about 0 where they begin at 0."""
    angles = set()
    for first, last, step in ranges:
        for i in range(round((last - first) / step) + 1):
            angles.add(round(first + i * step, 4))
    return sorted(angles | {-a for a in angles} if min(angles) >= 0 else angles)


def write_beam(name, title, value, hs, vs):
    with open(name, "w", newline="") as file:
        file.write(f"# {title}\n# cd; columns H > 0 right, rows V > 0 up, deg; SPDX-License-Identifier: MIT\n")
        file.write(",".join(["A"] + [f"{h:g}" for h in hs]) + "\n")
        for v in reversed(vs):
            cells = [value(h, v) for h in hs]
            file.write(",".join([f"{v:g}"] + [f"{c:.0f}" if c >= 1000 else f"{round(c, 2):g}" for c in cells]) + "\n")


def quad(*corners):
    """Four corners, counter-clockwise as seen, as six vertices."""
    return [corners[i] for i in (0, 1, 2, 0, 2, 3)]


def write_yard(name):
    """A road along -Z, its left half wet, with lamps on its right and an oncoming car, and 30 m aside a car before a wall. Y up, m."""
    surfaces = {
        "asphalt_wet": quad((-4, 0, 20), (0, 0, 20), (0, 0, -160), (-4, 0, -160)),
        "asphalt_dry": quad((0, 0, 20), (4, 0, 20), (4, 0, -160), (0, 0, -160)) + quad((20, 0, 10), (40, 0, 10), (40, 0, -12), (20, 0, -12)),
        "plaster": quad((20, 0, -12), (40, 0, -12), (40, 4, -12), (20, 4, -12)),
    }
    places = {f"street_lamp_{i}/light": (4.5, 8, -30 - 30 * i) for i in range(4)}
    places |= {f"parked_car/headlamp_{i}": (30 + x, 0.65, 0) for i, x in (("left", -0.6), ("right", 0.6))}
    nodes = [{"name": name, "translation": at} for name, at in places.items()]
    # A half turn about Y: it comes towards the road's observer.
    nodes += [{"name": f"oncoming_car/headlamp_{i}", "translation": (-2 + x, 0.65, -70), "rotation": (0, 1, 0, 0)} for i, x in (("left", 0.6), ("right", -0.6))]
    nodes += [{"name": "wall", "translation": (30.4, 1.2, 2), "camera": 0}, {"name": "sheen", "translation": (0, 1.5, 0), "camera": 1}]
    document = {
        "asset": {"version": "2.0", "generator": "generate.py"},
        "cameras": [{"name": n, "type": "perspective", "perspective": {"yfov": f, "znear": 0.1}} for n, f in (("wall", 0.55), ("sheen", 0.2))],
        "materials": [], "meshes": [{"primitives": []}], "accessors": [], "bufferViews": [],
    }
    data = b""
    for material, points in surfaces.items():
        index = len(document["materials"])
        document["materials"].append({"name": material, "pbrMetallicRoughness": {"baseColorFactor": [0.6, 0.6, 0.6, 1] if material == "plaster" else [0.08, 0.08, 0.08, 1], "metallicFactor": 0, "roughnessFactor": 1}})
        document["meshes"][0]["primitives"].append({"attributes": {"POSITION": index}, "material": index})
        bounds = {"min": [min(p[i] for p in points) for i in range(3)], "max": [max(p[i] for p in points) for i in range(3)]}
        document["accessors"].append({"bufferView": index, "componentType": 5126, "count": len(points), "type": "VEC3"} | bounds)
        document["bufferViews"].append({"buffer": 0, "byteOffset": len(data), "byteLength": 12 * len(points)})
        data += b"".join(struct.pack("<3f", *p) for p in points)
    document["buffers"] = [{"byteLength": len(data), "uri": "data:application/octet-stream;base64," + base64.b64encode(data).decode()}]
    document["nodes"] = [{"name": "yard", "mesh": 0}] + nodes
    document["scenes"] = [{"nodes": list(range(len(document["nodes"])))}]
    document["scene"] = 0
    with open(name, "w") as file:
        json.dump(document, file, indent=1)
        file.write("\n")


def main():
    write_street_lamp("street-lamp.ies", 8000)
    write_yard("yard.gltf")
    hs = axis((0, 4, 0.25), (4, 12, 0.5), (12, 30, 1), (30, 60, 2.5))
    vs = axis((-30, -15, 2.5), (-15, -6, 1), (-6, -3, 0.5), (-3, -2, 0.25), (-2, 2, 0.1), (2, 5, 0.5), (5, 15, 1))
    write_beam("low-beam.csv", "Passing beam, right-hand traffic, cut-off at -0.57 deg on the left", low_beam, hs, vs)
    hs = axis((0, 5, 0.25), (5, 12, 0.5), (12, 30, 1), (30, 40, 2.5))
    write_beam("high-beam.csv", "Driving beam", high_beam, hs, axis((0, 3, 0.25), (3, 6, 0.5), (6, 11, 1)))
    hs = axis((0, 40, 2), (40, 60, 4))
    vs = axis((-15, -6, 1), (-6, -2, 0.5), (-2, 0, 0.1), (0, 5, 0.5), (5, 15, 1))
    write_beam("front-fog.csv", "Front fog lamp, cut-off at -1 deg", front_fog, hs, vs)


if __name__ == "__main__":
    main()
