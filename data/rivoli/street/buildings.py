"""Places facade pieces into runs: buildings of several bays, corners, lit windows, shops."""

from . import facade, groundfloor, roofs
from .facade import BAY, OPENINGS, WINDOW_HEIGHT, WINDOW_RECESS
from .geometry import quaternion
from .layout import (
    BLOCKS,
    END_DEPTH,
    END_STREET,
    FACADE_X,
    GARDEN_BLOCK,
    JUNCTIONS,
    PORTAL_HALF,
    SIDE_DEPTH,
    Z_FAR,
    Z_NEAR,
    stream,
)

LIT_SHARE = 0.23
WARM_SHARE = 0.75


class FacadePlacer:
    """Adds facade runs to a document, sharing each distinct mesh."""

    def __init__(self, document):
        self.document = document
        self.arcade_lamps = 0
        self._runs = 0
        self._meshes = {}

    def run(self, origin, degrees, length, ground, corners=(False, False)):
        """Build a straight facade from ``origin`` (x, z), turned by ``degrees`` about Y, ``length`` metres.

        ``ground``: "arcade", "shops" or "return" (shops after an open arch at the corner end).
        ``corners``: whether the run starts / ends at a convex street corner.
        """
        random = stream("run", self._runs)
        root = self.document.node(
            f"facade_{self._runs:02d}", translation=(origin[0], 0.0, origin[1]), rotation=quaternion("y", degrees)
        )
        self._runs += 1
        total = max(1, round(length / BAY))
        stretch = length / (total * BAY)
        first = 0
        for index, bays in enumerate(_partition(total, random)):
            rise = (
                1.0
                if (corners[0] and first == 0) or (corners[1] and first + bays == total)
                else random.choice((0.985, 1.0, 1.0, 1.02))
            )
            building = self.document.node(
                f"building_{self._runs - 1:02d}_{index}",
                root,
                translation=(first * BAY * stretch, 0.0, 0.0),
                scale=(stretch, rise, 1.0),
            )
            look = _Look(random, ground)
            for bay in range(bays):
                at = first + bay
                piece = "start" if corners[0] and at == 0 else "end" if corners[1] and at == total - 1 else "middle"
                open_arch = ground == "return" and piece != "middle"
                self._bay(building, bay, look, piece, random, open_arch)
            if index > 0 or not corners[0]:
                self._add(building, roofs.chimney_wall, (0.0, 0.0, 0.0))
            if index > 0:
                self._add(building, facade.moulding_ends, (0.0, 0.0, 0.0))
            first += bays
        if corners[1]:
            self._add(root, facade.corner, (length, 0.0, 0.0))
        return root

    def _add(self, parent, make, translation, *arguments, **placement):
        key = (make.__name__, *arguments)
        if key not in self._meshes:
            self._meshes[key] = make(*arguments)
        mesh = self._meshes[key]
        return self.document.node(mesh.name, parent, mesh, translation, **placement)

    def _bay(self, building, bay, look, piece, random, open_arch):
        x = bay * BAY
        self._add(building, facade.upper_bay, (x, 0, 0), look.tint, look.style)
        self._add(building, roofs.roof_bay, (x, 0, 0), look.roof, piece)
        if bay % look.dormer_every == 0 and piece == "middle":
            self._add(building, roofs.dormer, (x, 0, 0), look.roof)
            self._window(building, x, 16.68, 1.72, 0.72, roofs.DORMER_FACE + 0.03, random)
        for sill, height in OPENINGS:
            self._window(building, x, sill, height, 1.0, -WINDOW_RECESS, random)
        if open_arch:
            self._add(building, groundfloor.arcade_front, (x, 0, 0), look.tint)
        elif look.ground == "arcade":
            self._add(building, groundfloor.arcade_front, (x, 0, 0), look.tint)
            self._add(building, groundfloor.arcade_walk, (x, 0, 0))
            self._add(building, groundfloor.shop, (x, 0, -groundfloor.WALK_DEPTH), look.shop(random))
            if bay % 3 == 1:
                self._arcade_lamp(building, x)
        elif bay == look.door_bay:
            self._add(building, groundfloor.door_front, (x, 0, 0), look.tint)
        else:
            self._add(building, groundfloor.plain_front, (x, 0, 0), look.tint)
            self._add(building, groundfloor.shop, (x, 0, -0.4), look.shop(random))
            if look.awnings:
                self._add(building, groundfloor.awning, (x, 0, 0.0))

    def _arcade_lamp(self, building, x):
        name = f"arcade_lamp_{self.arcade_lamps:03d}"
        self.arcade_lamps += 1
        lantern = self._add(building, groundfloor.arcade_lantern, (x + BAY / 2, 4.0, -2.2))
        self.document.nodes[lantern]["name"] = name
        self.document.node(f"{name}/light", lantern, rotation=quaternion("x", -90.0))

    def _window(self, building, x, sill, height, width_scale, z, random):
        kind = "window_glass"
        if random.random() < LIT_SHARE:
            kind = "window_lit_warm" if random.random() < WARM_SHARE else "window_lit_cool"
        variant = random.randrange(facade.WINDOW_KINDS[kind])
        self._add(
            building,
            facade.window,
            (x + BAY / 2, sill, z),
            kind,
            variant,
            scale=(width_scale, height / WINDOW_HEIGHT, 1.0),
        )


class _Look:
    """What the bays of one building have in common."""

    def __init__(self, random, ground):
        self.tint = random.choice(facade.TINTS)
        self.style = random.choice(facade.STYLES)
        self.roof = random.choice(("zinc", "zinc", "slate"))
        self.dormer_every = random.choice((1, 1, 2))
        self.ground = "arcade" if ground == "arcade" else "shops"
        self.door_bay = random.randrange(1, 4)
        self.awnings = random.random() < 0.4
        self._shop = random.randrange(groundfloor.SHOP_COUNT)
        self._same = 0

    def shop(self, random):
        """The shop variant of the next bay; a shop is one or two bays wide."""
        if self._same == 0:
            self._shop = (self._shop + random.randrange(1, groundfloor.SHOP_COUNT)) % groundfloor.SHOP_COUNT
            self._same = random.randrange(1, 3)
        self._same -= 1
        return self._shop


def _partition(total, random):
    """Split ``total`` bays into buildings of 5 to 9 bays."""
    parts = []
    while total > 0:
        size = random.randrange(5, 10)
        if total - size < 5:
            size = total
        parts.append(size)
        total -= size
    return parts


def place_buildings(document, tunnel=False):
    """All facades of the street, its side streets and its ends; with a gap for the ``tunnel``. Returns the placer."""
    placer = FacadePlacer(document)
    for index, (near, far) in enumerate(BLOCKS):
        length = near - far
        placer.run((FACADE_X, far), -90.0, length, "arcade", (True, True))
        _returns(placer, 1, near, far)
        if index == GARDEN_BLOCK:
            continue
        ground = "shops" if index == 0 else "arcade"
        placer.run((-FACADE_X, near), 90.0, length, ground, (True, True))
        _returns(placer, -1, near, far, ground)
    for near, far in JUNCTIONS:
        placer.run((FACADE_X + SIDE_DEPTH, far), -90.0, near - far, "shops")
        placer.run((-FACADE_X - SIDE_DEPTH, near), 90.0, near - far, "shops")
    reach = FACADE_X + END_DEPTH
    placer.run((reach, Z_NEAR + END_STREET), 180.0, 2 * reach, "shops")
    if tunnel:
        placer.run((-reach, Z_FAR - END_STREET), 0.0, reach - PORTAL_HALF, "arcade")
        placer.run((PORTAL_HALF, Z_FAR - END_STREET), 0.0, reach - PORTAL_HALF, "arcade")
    else:
        placer.run((-reach, Z_FAR - END_STREET), 0.0, 2 * reach, "arcade")
    for near in (Z_NEAR + END_STREET, Z_FAR):
        placer.run((reach, near - END_STREET), -90.0, END_STREET, "shops")
        placer.run((-reach, near), 90.0, END_STREET, "shops")
    return placer


def _returns(placer, side, near, far, ground="arcade"):
    """The facades of one block that turn into the side streets at its two corners; ``side`` is the sign of x."""
    kind = "return" if ground == "arcade" else "shops"
    first, last = (True, False), (False, True)
    near_depth = END_DEPTH if near == Z_NEAR else SIDE_DEPTH
    far_depth = END_DEPTH if far == Z_FAR else SIDE_DEPTH
    near_x = FACADE_X if side > 0 else -FACADE_X - near_depth
    far_x = FACADE_X + far_depth if side > 0 else -FACADE_X
    placer.run((near_x, near), 0.0, near_depth, kind, first if side > 0 else last)
    placer.run((far_x, far), 180.0, far_depth, kind, last if side > 0 else first)
