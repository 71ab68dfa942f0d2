"""Cars: parked along the kerbs, driving in the lanes, the ego car, their lamps and the "drive" animation."""

from .cars import BODIES, EGO_BODY, PAINTS, cockpit_mesh, lamp_mesh, paint_mesh, trim_mesh
from .geometry import quaternion
from .layout import (
    BLOCKS,
    DRIVE_SECONDS,
    EGO_Z,
    LANE_CENTRES,
    PARKING_X,
    SCOOTER_BAYS,
    SCOOTER_PITCH,
    Z_FAR,
    Z_NEAR,
    stream,
)

CAR_COUNT = 100
PLATE_VARIANTS = 2  # number plates per body; every one costs four draw batches
EGO_SPEED = 12.0  # m/s
DIP_DEG = 1.0  # low beams aim below the horizon
EYE = (-0.37, 1.2, -0.1)  # driver's eye in the ego car
PAINT_WEIGHTS = (4, 4, 4, 4, 3, 2, 1)
FLEET = ("hatchback",) * 5 + ("sedan",) * 4 + ("suv",) * 3 + ("van",) * 2
# (lane index, direction of travel in z, speed m/s, starting z values)
MOVING = (
    (0, -1, 12.0, (-27.0, -84.0, 52.0)),
    (1, -1, 10.5, (-11.0, -43.0, -101.0, 16.0)),
    (0, 1, 12.0, (-52.0, -78.0, -131.0, -222.0)),
    (1, 1, 11.0, (-63.0, -122.0, -166.0, -246.0)),
)
WAITING = ((0, -1, (-308.0,)), (1, 1, (108.6,)))



class CarPlacer:
    """Adds cars to a document; counts them by kind."""

    def __init__(self, document):
        self.document = document
        self.counts = {"parked": 0, "traffic": 0}
        self.parked = []
        self._meshes = {}
        self._random = stream("fleet")

    def car(self, kind, x, z, degrees):
        """Add one parked or traffic car and return its node."""
        name = f"car_{kind}_{self.counts[kind]:03d}"
        self.counts[kind] += 1
        body = BODIES[self._random.choice(FLEET)]
        paint = self._random.choices(PAINTS, PAINT_WEIGHTS)[0]
        trim = self._mesh(trim_mesh, body, self._random.randrange(PLATE_VARIANTS))
        node = self.document.node(name, translation=(x, 0.0, z), rotation=quaternion("y", degrees))
        self._equip(node, name, body, paint, kind == "parked", trim)
        return node

    def ego(self, z):
        """Add the driver's car: no windscreen pane, a cockpit, and the driver's camera."""
        body = EGO_BODY
        node = self.document.node("car_ego", translation=(LANE_CENTRES[0], 0.0, z))
        self._equip(node, "car_ego", body, "paint_blue", False, trim_mesh(body, PLATE_VARIANTS, windscreen=False))
        cockpit = cockpit_mesh(body)
        self.document.node(cockpit.name, node, cockpit)
        self.document.camera("driver", 36.87, node, translation=EYE, rotation=quaternion("x", 0.5))
        return node

    def _mesh(self, make, *arguments):
        key = (make.__name__, *(getattr(a, "name", a) for a in arguments))
        if key not in self._meshes:
            self._meshes[key] = make(*arguments)
        return self._meshes[key]

    def _equip(self, node, name, body, paint, parked, trim):
        self.document.node(f"{name}/body", node, self._mesh(paint_mesh, body, paint))
        self.document.node(f"{name}/trim", node, trim)
        self.document.node(f"{name}/lamps", node, self._mesh(lamp_mesh, body, parked))
        (hx, hy, hz), (tx, ty, tz) = body.lamp_points()
        for side, sign in (("left", -1), ("right", 1)):
            self.document.node(
                f"{name}/headlamp_{side}", node, translation=(sign * hx, hy, hz), rotation=quaternion("x", -DIP_DEG)
            )
            self.document.node(
                f"{name}/tail_{side}", node, translation=(sign * tx, ty, tz), rotation=quaternion("y", 180.0)
            )


def _in_scooter_bay(side, z):
    """True where a car centred on ``z`` would stand on scooters."""
    clearance = 2.9
    return any(
        side == bay_side and first - SCOOTER_PITCH * count - clearance < z < first + clearance
        for bay_side, first, count in SCOOTER_BAYS
    )


def _parking_places():
    """Yield (x, z, heading) along both kerbs, leaving gaps, crossings and the scooters' bays free."""
    random = stream("parking")
    for side in (1, -1):
        for near, far in BLOCKS:
            z = near - 11.0 if near < Z_NEAR else near - 6.0
            end = far + 11.0 if far > Z_FAR else far + 10.0
            while z > end + 2.5:
                if not _in_scooter_bay(side, z - 2.4):
                    yield side * PARKING_X, z - 2.4, 0.0 if side > 0 else 180.0
                z -= random.choice((5.2, 5.4, 5.6, 5.9, 11.5))


def place_traffic(document, animated=True):
    """Place the 100 cars and animate them if wanted; returns the placer, which knows how many and where."""
    placer = CarPlacer(document)
    ego = placer.ego(EGO_Z)
    times = (0.0, DRIVE_SECONDS)

    def drive(node, z, velocity):
        if not animated:
            return
        x = document.nodes[node]["translation"][0]
        document.animate(node, "translation", times, [(x, 0.0, z), (x, 0.0, z + velocity * DRIVE_SECONDS)])

    drive(ego, EGO_Z, -EGO_SPEED)
    for lane, direction, speed, starts in MOVING:
        for z in starts:
            node = placer.car("traffic", -direction * LANE_CENTRES[lane], z, 0.0 if direction < 0 else 180.0)
            drive(node, z, direction * speed)
    for lane, direction, places in WAITING:
        for z in places:
            placer.car("traffic", -direction * LANE_CENTRES[lane], z, 0.0 if direction < 0 else 180.0)
    wanted = CAR_COUNT - 1 - placer.counts["traffic"]
    random = stream("parked")
    # fill the kerbs along the driver's way first, the rest more and more sparsely
    places = sorted(_parking_places(), key=lambda place: abs(place[1] + 70.0) * random.uniform(0.5, 1.5))
    for x, z, degrees in places[:wanted]:
        placer.parked.append((x, z))
        placer.car(
            "parked",
            x + random.uniform(-0.12, 0.12),
            z + random.uniform(-0.2, 0.2),
            degrees + random.uniform(-1.2, 1.2),
        )
    return placer
