"""The street to drive in: scene, photometry and world of the simulator (docs/simulator.md)."""

import json
import math

from . import materials
from .buildings import place_buildings
from .gltf import Document
from .greenery import place_greenery
from .ground import place_ground
from .layout import (
    CROSSINGS,
    END_DEPTH,
    FACADE_X,
    KERB_X,
    LANE,
    LANE_CENTRES,
    PAVEMENT_Y,
    QUAY_FAR,
    QUAY_NEAR,
    TUNNEL_FAR,
    TUNNEL_HALF,
    TUNNEL_HEIGHT,
    TUNNEL_NEAR,
    Z_FAR,
    Z_NEAR,
)
from .people import person
from .photometry import HALOGEN, HEADLAMP, TAIL, TAIL_RED, beam, coloured, measured_photometry, spot
from .scene import PERSON_MESHES, place_cameras, place_furniture, place_people, place_signals, place_street_lamps
from .traffic import place_traffic
from .tunnel import LUMINAIRE, WALK_X, WALK_Z, place_tunnel

SPEED = 50.0  # km/h
AMBER = [1.0, 0.38, 0.0]
CLEARANCE = 0.95  # half a parked car's width
TURNS = ((4.2, 14.0), (7.2, 12.0))  # of either lane at both ends: radius, and length of the swing to it
# (lane, heading along Z, z, km/h) of the 17 cars that move; the driver starts at START.
START = -205.0
CARS = (
    (0, -1, -262.0, 50), (0, -1, -150.0, 45), (0, -1, -60.0, 45), (0, -1, 40.0, 40),
    (1, -1, -238.0, 36), (1, -1, -310.0, 40), (1, -1, -390.0, 46), (1, -1, -100.0, 45), (1, -1, 20.0, 40),
    (0, 1, -300.0, 48), (0, 1, -378.0, 48), (0, 1, -452.0, 46), (0, 1, -120.0, 45),
    (1, 1, -330.0, 45), (1, 1, -412.0, 45), (1, 1, -500.0, 44), (1, 1, -180.0, 45),
)  # fmt: skip
FORGOTTEN = 10  # has not dipped
WISHES = {0: 1.0, 4: 0.68, 5: 0.8, 6: 0.85}  # of the allowed speed, where it is not drawn
WALKS = ((WALK_Z, 11.7), (CROSSINGS[4], 0.0), (CROSSINGS[5], 0.0), (CROSSINGS[3], 0.0))  # z, m already walked


def build_drive():
    """The document of the drive."""
    document = Document(materials.gltf_materials(drive=True), [f"textures/{file}" for file in materials.image_files()])
    place_ground(document)
    placer = place_buildings(document, tunnel=True)
    place_greenery(document)
    place_street_lamps(document)
    place_signals(document, ends="green")
    place_furniture(document)
    place_people(document)
    cars = place_traffic(document, animated=False)
    for k in range(len(WALKS)):
        document.node(f"walker_{k}", mesh=person((5 * k) % PERSON_MESHES), translation=(0, PAVEMENT_Y, Z_NEAR))
    place_cameras(document)
    place_tunnel(document, placer)
    return document, cars.parked


def drive_photometry():
    """The measured night with every lamp that a moving car has, and those of the tunnel."""
    document = measured_photometry()
    moving = ["car_ego", "car_traffic_*"]
    headlamps, tails = [f"{car}/headlamp_*" for car in moving], [f"{car}/tail_*" for car in moving]
    gone = ("low beam", "high beam", "tail lamp")
    indicator = {"width_m": 0.14, "height_m": 0.08}
    lamps = [lamp for lamp in document["lamps"] if lamp["name"] not in gone]
    lamps += [
        beam("low beam", headlamps, "low-beam.csv"),
        beam("high beam", headlamps, "high-beam.csv"),
        coloured("tail lamp", tails, 5, (10, 55), TAIL_RED, TAIL),
        # UN Regulation 7: 60 to 185 cd on the axis of a stop lamp.
        coloured("brake lamp", tails, 80, (10, 55), TAIL_RED, TAIL),
    ]
    for side in ("left", "right"):
        # UN Regulation 6: at least 175 cd to the front, 50 cd to the rear.
        front = coloured(f"{side} front indicator", [f"{car}/headlamp_{side}" for car in moving], 200, (15, 60), AMBER, indicator)
        rear = coloured(f"{side} rear indicator", [f"{car}/tail_{side}" for car in moving], 100, (15, 60), AMBER, indicator)
        lamps += [front | {"offset_m": [0, -0.14, 0]}, rear | {"offset_m": [0, -0.19, 0]}]
    opening = {"width_m": LUMINAIRE[0], "height_m": LUMINAIRE[1]}
    lamps.append(spot("tunnel lamp", "tunnel_lamp_*", 420, (55, 85), 4000, opening=opening))
    document["lamps"] = lamps
    document["emitters"].append({"name": "tunnel lamp", "materials": "tunnel_lamp_glass", "lamp": "tunnel lamp"})
    return document


def _turn(x, radius, swing, centre, end):
    """From the lane at ``x`` round to the other side; ``end`` is -1 at the far end of the street, 1 at the near one."""
    heading = end  # along Z
    side = 1 if end < 0 else -1  # of the lane that arrives
    steps = 12
    arrive = [
        (x + (radius - x) * (t * t * (3 - 2 * t)), centre - heading * swing * (1 - t)) for t in (k / steps for k in range(steps))
    ]
    points = [(side * px, pz) for px, pz in arrive]
    points += [
        (side * radius * math.cos(a), centre + heading * radius * math.sin(a))
        for a in (math.pi * k / 30 for k in range(31))
    ]
    return points + [(-side * px, pz) for px, pz in reversed(arrive)]


def _loop(lane):
    """A lane down the street, round its far end, up again and round the near end."""
    x, (radius, swing) = LANE_CENTRES[lane], TURNS[lane]
    far, near = QUAY_FAR - 3.2, Z_NEAR + 1.2
    points = []

    def straight(side, start, stop):
        count = max(1, round(abs(stop - start) / 5.0))
        points.extend((side * x, start + (stop - start) * k / count) for k in range(1, count))

    straight(1, near - swing, far + swing)
    points += _turn(x, radius, swing, far, -1)
    straight(-1, far + swing, near - swing)
    points += _turn(x, radius, swing, near, 1)
    return [[round(px, 4), 0.0, round(pz, 4)] for px, pz in points]


def _along(points, x, z):
    """Where a point of a straight part lies along a loop."""
    best, length = (1e9, 0.0), 0.0
    for (ax, _, az), (bx, _, bz) in zip(points, points[1:]):
        step = math.hypot(bx - ax, bz - az)
        t = max(0.0, min(1.0, ((x - ax) * (bx - ax) + (z - az) * (bz - az)) / step**2))
        best = min(best, (math.hypot(x - ax - t * (bx - ax), z - az - t * (bz - az)), length + t * step))
        length += step
    return round(best[1], 3)


def _barriers(parked):
    """Kerbs, walls and parked cars in plan."""
    reach, barriers = FACADE_X + END_DEPTH, []
    for s in (1, -1):
        barriers.append([[s * reach, Z_NEAR + 9.5], [s * reach, Z_NEAR], [s * KERB_X, Z_NEAR], [s * KERB_X, Z_FAR]])
        barriers[-1] += [[s * reach, Z_FAR], [s * reach, TUNNEL_NEAR], [s * WALK_X, TUNNEL_NEAR], [s * WALK_X, TUNNEL_FAR]]
        barriers[-1] += [[s * reach, TUNNEL_FAR], [s * reach, QUAY_NEAR], [s * KERB_X, QUAY_NEAR], [s * KERB_X, QUAY_FAR]]
        barriers[-1] += [[s * reach, QUAY_FAR], [s * reach, QUAY_FAR - 12.0]]
    barriers.append([[-reach, Z_NEAR + 9.5], [reach, Z_NEAR + 9.5]])
    barriers.append([[-reach, QUAY_FAR - 12.0], [reach, QUAY_FAR - 12.0]])
    for x, z in parked:
        a, b, c, d = (round(v, 2) for v in (x - CLEARANCE, x + CLEARANCE, z - 2.3, z + 2.3))
        barriers.append([[a, c], [b, c], [b, d], [a, d], [a, c]])
    return barriers


def drive_world(parked):
    """What moves, and where."""
    loops = [_loop(lane) for lane in range(2)]
    names = ("inner", "outer")
    lanes = [
        {"name": names[k], "closed": True, "width_m": LANE, "speed_km_h": SPEED, ("right", "left")[k]: names[1 - k], "points": loops[k]}
        for k in range(2)
    ]
    cars = []
    for k, (lane, heading, z, speed) in enumerate(CARS):
        x = LANE_CENTRES[lane] * (1 if heading < 0 else -1)
        cars.append({"node": f"car_traffic_{k:03d}", "lane": names[lane], "at_m": _along(loops[lane], x, z), "speed_km_h": speed})
    cars[FORGOTTEN]["beam"] = "high"
    for k, wish in WISHES.items():
        cars[k]["wish"] = wish
    y = PAVEMENT_Y
    paths = [
        {"name": f"crossing {k}", "points": [[10.4, y, z], [KERB_X, y, z], [KERB_X - 0.2, 0, z], [0.2 - KERB_X, 0, z], [-KERB_X, y, z], [-10.4, y, z]]}
        for k, (z, _) in enumerate(WALKS)
    ]
    return {
        "version": 1,
        "scene": "rivoli-drive.gltf",
        "photometry": "rivoli-drive.photometry.json",
        "driver": {"node": "car_ego", "camera": "driver", "lane": "inner", "at_m": _along(loops[0], LANE_CENTRES[0], START), "speed_km_h": SPEED},
        "lamps": {
            "low": ["low beam"],
            "high": ["high beam"],
            "tail": ["tail lamp"],
            "brake": ["brake lamp"],
            "left": ["left front indicator", "left rear indicator"],
            "right": ["right front indicator", "right rear indicator"],
        },
        "lit_by_day": ["tunnel lamp", "red signal", "green signal"],
        "tunnels": [{"from": [0, 0, TUNNEL_NEAR], "to": [0, 0, TUNNEL_FAR], "width_m": 2 * TUNNEL_HALF, "height_m": TUNNEL_HEIGHT}],
        "lanes": lanes,
        "paths": paths,
        "cars": cars,
        "walkers": [{"node": f"walker_{k}", "path": f"crossing {k}", "wait_s": 2.0 + 3.0 * k} | ({"at_m": at} if at else {}) for k, (_, at) in enumerate(WALKS)],
        "barriers": _barriers(parked),
    }


def write_drive(folder):
    """Write the four files of the drive."""
    document, parked = build_drive()
    document.write(folder, "rivoli-drive")
    (folder / "rivoli-drive.photometry.json").write_text(json.dumps(drive_photometry(), indent=2) + "\n")
    text = json.dumps(drive_world(parked), separators=(", ", ": "))
    (folder / "rivoli.world.json").write_text(text.replace('], "', '],\n"').replace('}, {"', '},\n{"') + "\n")
    return document.statistics()
