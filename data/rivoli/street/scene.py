"""Assembles the street: ground, buildings, garden, furniture, cars, people, sun and cameras."""

from . import furniture, materials
from .buildings import place_buildings
from .geometry import quaternion
from .gltf import Document
from .greenery import place_greenery
from .ground import place_ground
from .layout import (
    CROSSINGS,
    FACADE_X,
    JUNCTIONS,
    KERB_X,
    LAMP_COUNT,
    LAMP_X,
    LAMP_Y,
    PARKING_X,
    PAVEMENT_Y,
    SCOOTER_BAYS,
    SCOOTER_PITCH,
    Z_FAR,
    Z_NEAR,
    near_junction,
    stream,
)
from .people import person
from .traffic import place_traffic

PERSON_MESHES = 12
PEOPLE_COUNT = 24


def build_scene():
    """Build the document; returns it with a dictionary of counts for the report."""
    document = Document(materials.gltf_materials(), [f"textures/{file}" for file in materials.image_files()])
    place_ground(document)
    arcade_lamps = place_buildings(document).arcade_lamps
    place_greenery(document)
    place_street_lamps(document)
    place_signals(document)
    place_furniture(document)
    place_people(document)
    cars = place_traffic(document).counts
    place_cameras(document)
    document.node(
        "sun", translation=(0, 60, 0), rotation=quaternion("x", -55.0), extensions={"KHR_lights_punctual": {"light": 0}}
    )
    counts = document.statistics()
    counts.update(
        {
            "street lamps": LAMP_COUNT,
            "arcade lamps": arcade_lamps,
            "parked cars": cars["parked"],
            "traffic cars": cars["traffic"],
            "pedestrians": PEOPLE_COUNT,
        }
    )
    return document, counts


def place_street_lamps(document):
    """Thirty lanterns along each pavement, facing each other, clear of the side streets.

    The light nodes' -Z points down; their -X points across the street, towards its axis.
    """
    mesh = furniture.street_lamp()
    per_side = LAMP_COUNT // 2
    step = (Z_NEAR - Z_FAR) / per_side
    for k in range(per_side):
        z = Z_NEAR - (k + 0.5) * step
        z = _clear_of_side_streets(z)
        for s, side in enumerate((1, -1)):
            name = f"street_lamp_{2 * k + s:03d}"
            lamp = document.node(
                name,
                mesh=mesh,
                translation=(side * LAMP_X, PAVEMENT_Y, z),
                rotation=quaternion("y", 0.0 if side > 0 else 180.0),
            )
            document.node(
                f"{name}/light", lamp, translation=(0, LAMP_Y - PAVEMENT_Y, 0), rotation=quaternion("x", -90.0)
            )


def _clear_of_side_streets(z):
    """Move a position that falls into a side street's mouth to its nearer corner."""
    for near, far in JUNCTIONS:
        if far - 0.5 < z < near + 0.5:
            return near + 1.0 if z > (near + far) / 2 else far - 1.0
    return z


def place_signals(document, ends="red"):
    """Signals at every stop line: junctions show green, the ends what is asked for."""
    meshes = {state: furniture.signal(state) for state in ("red", "green")}
    places = []
    for k, z in enumerate(CROSSINGS):
        places.append(
            (KERB_X + 0.35, z + 2.6, 0.0, "green") if k % 2 == 0 else (-KERB_X - 0.35, z - 2.6, 180.0, "green")
        )
    places += [(KERB_X + 0.35, Z_FAR + 0.6, 0.0, ends), (-KERB_X - 0.35, Z_NEAR - 0.6, 180.0, ends)]
    for near, far in JUNCTIONS:
        places.append((FACADE_X - 0.8, near + 0.6, 90.0, "red"))
    for k, (x, z, degrees, state) in enumerate(places):
        node = document.node(
            f"signal_{k:02d}", mesh=meshes[state], translation=(x, PAVEMENT_Y, z), rotation=quaternion("y", degrees)
        )
        document.node(
            f"signal_{k:02d}/{state}",
            node,
            translation=(0, furniture.SIGNAL_HEADS[state], 0.46),
            rotation=quaternion("y", 180.0),
        )


def place_furniture(document):
    """Signs, bollards, bins, benches, advertising columns and scooters."""
    root = document.node("furniture")

    def put(mesh, x, z, degrees=0.0):
        document.node(mesh.name, root, mesh, (x, PAVEMENT_Y, z), quaternion("y", degrees))

    crossing = furniture.road_sign("crossing", "plate", 2.3)
    no_parking = furniture.road_sign("no_parking", "disc", 2.2)
    no_entry = furniture.road_sign("no_entry", "disc", 2.1)
    speed = furniture.road_sign("speed", "disc", 2.2)
    parking = furniture.road_sign("parking", "plate", 2.2)
    for k, z in enumerate(CROSSINGS):
        put(crossing, KERB_X + 1.2, z + 1.2)
        put(crossing, -KERB_X - 1.2, z - 1.2, 180.0)
    for near, far in JUNCTIONS:
        put(no_entry, FACADE_X - 0.5, far - 1.9, -90.0)
        put(no_entry, -FACADE_X + 0.5, near + 1.9, 90.0)
    for k, z in enumerate((28.0, -82.0, -120.0, -215.0, -262.0)):
        put((no_parking, parking, speed)[k % 3], KERB_X + 0.45, z)
        put((parking, speed, no_parking)[k % 3], -KERB_X - 0.45, z - 12.0, 180.0)
    bollard = furniture.bollard()
    for near, far in JUNCTIONS:
        for corner in (near + 2.2, near + 0.8, far - 0.8, far - 2.2):
            for side in (1, -1):
                put(bollard, side * (KERB_X + 0.5), corner)
                put(bollard, side * (FACADE_X - 1.6), near + 2.1 if corner > far else far - 2.1)
    litter, bench, column = furniture.bin_bag(), furniture.bench(), furniture.kiosk()
    for k in range(14):
        z = Z_NEAR - (2 * k + 1) * (Z_NEAR - Z_FAR) / (LAMP_COUNT // 2)  # half-way between lamps
        if not near_junction(z, 7.0):
            put(litter, KERB_X + 0.55, z - 3.0, -90.0)
            put(litter, -KERB_X - 0.55, z + 3.0, 90.0)
            put(bench, KERB_X + 0.7 if k % 2 else -KERB_X - 0.7, z, 90.0 if k % 2 else -90.0)
    for x, z in ((KERB_X + 1.3, 20.0), (-KERB_X - 1.3, -100.0), (KERB_X + 1.3, -200.0), (-KERB_X - 1.3, -290.0)):
        put(column, x, z)
    cross = furniture.pharmacy_cross()
    for x, z in ((FACADE_X, 23.75), (FACADE_X, -86.5), (-FACADE_X, -214.0), (-FACADE_X, 12.5)):
        document.node(cross.name, root, cross, (x, 4.6, z), quaternion("y", -90.0 if x > 0 else 90.0))
    plate = furniture.street_name_plate()
    for near, far in JUNCTIONS:
        document.node(plate.name, root, plate, (FACADE_X - 0.05, 4.98, near + 0.8), quaternion("y", -90.0))
        document.node(plate.name, root, plate, (FACADE_X - 0.05, 4.98, far - 0.8), quaternion("y", -90.0))
    _place_scooters(document, root)


def _place_scooters(document, root):
    random = stream("scooters")
    meshes = [furniture.scooter(paint) for paint in ("paint_black", "paint_red", "paint_silver")]
    for side, first, count in SCOOTER_BAYS:
        for k in range(count):
            degrees = random.uniform(-6, 6) - 90.0 * side
            document.node(
                "scooter",
                root,
                random.choice(meshes),
                (side * (PARKING_X + 0.15), 0, first - SCOOTER_PITCH * k),
                quaternion("y", degrees),
            )


def place_people(document):
    """Two dozen pedestrians on the pavements, at the crossings' kerbs and crossing."""
    root = document.node("pedestrians")
    random = stream("people")
    meshes = [person(k) for k in range(PERSON_MESHES)]
    spots = [
        (10.9, -9.0, 0),
        (10.4, -10.1, 10),
        (10.8, -17.5, 180),
        (13.8, -21.0, 0),
        (9.6, -26.0, 175),
        (11.3, -31.0, 0),
        (9.1, -36.2, 80),
        (9.2, -37.8, 95),
        (-9.0, -36.6, -90),
        (-9.2, -37.6, -85),
        (-10.6, -14.0, 0),
        (-11.2, -22.0, 180),
        (-10.0, -29.0, 180),
        (-10.8, -61.0, 0),
        (-10.2, -66.0, 10),
        (10.6, -58.0, 180),
        (11.2, -66.0, 0),
        (14.0, -72.0, 180),
        (10.2, -88.0, 0),
        (-10.9, -95.0, 180),
        (10.9, -110.0, 180),
        (-10.4, -140.0, 0),
        (10.5, 30.0, 0),
        (-10.6, 24.0, 180),
    ]
    for k, (x, z, heading) in enumerate(spots[:PEOPLE_COUNT]):
        document.node(
            f"pedestrian_{k:02d}",
            root,
            meshes[k % PERSON_MESHES],
            (x, PAVEMENT_Y, z),
            quaternion("y", heading + random.uniform(-8, 8)),
        )


def place_cameras(document):
    """The fixed cameras; the driver's belongs to the ego car."""
    document.camera("pedestrian", 45.0, translation=(9.9, PAVEMENT_Y + 1.6, -15.7), rotation=quaternion("y", 45.0))
    document.camera("overview", 40.0, translation=(3.0, 11.0, 34.0), rotation=quaternion("x", -6.0))
    document.camera("crossing", 40.0, translation=(-7.4, 1.65, -51.2), rotation=quaternion("y", -16.0))
