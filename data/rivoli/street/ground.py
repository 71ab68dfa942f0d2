"""Carriageway, kerbs, pavements, markings, covers and the garden floor, in pieces short enough to cull."""

from .geometry import Mesh, quaternion
from .layout import (
    BLOCKS,
    CROSSING_LENGTH,
    CROSSINGS,
    END_DEPTH,
    END_STREET,
    FACADE_X,
    GARDEN_BLOCK,
    GARDEN_DEPTH,
    JUNCTIONS,
    KERB_WIDTH,
    KERB_X,
    LANE,
    LANE_CENTRES,
    PAVEMENT_Y,
    SIDE_DEPTH,
    SIDE_PAVEMENT,
    STOP_GAP,
    Z_FAR,
    Z_NEAR,
    near_junction,
    stream,
)
from .materials import tile_metres

TILE = 20.0
PAINT_Y = 0.006
DECAL_Y = 0.003
UNDERLAY_Y = -0.04


def _sheet(mesh, material, x0, x1, z0, z1, y, offset=(0.0, 0.0)):
    """A horizontal rectangle facing up; ``offset`` shifts the texture (in metres)."""
    tile = tile_metres(material)
    uv = [((x + offset[0]) / tile, (z + offset[1]) / tile) for x, z in ((x0, z1), (x1, z1), (x1, z0), (x0, z0))]
    mesh.add(material, [(x0, y, z1), (x1, y, z1), (x1, y, z0), (x0, y, z0)], [(0, 1, 2), (0, 2, 3)], uv)


def road_tile():
    mesh = Mesh("road_20m")
    for x0, x1 in ((-KERB_X, 0.0), (0.0, KERB_X)):
        _sheet(mesh, "asphalt", x0, x1, -TILE, 0.0, 0.0)
    return mesh


def strip(name, material, width, length):
    """A flat asphalt strip, x from 0 to ``width``, z from 0 to -``length``."""
    mesh = Mesh(name)
    _sheet(mesh, material, 0.0, width, -length, 0.0, 0.0)
    return mesh


def pavement(name, width, length, kerb_ends=(False, False)):
    """Kerb at x = 0 and flags up to ``width``; z from 0 to -``length``; ends closed with kerbs on demand."""
    mesh = Mesh(name)
    y = PAVEMENT_Y
    mesh.quad("granite", (0, 0, -length), (0, 0, 0), (0, y, 0), (0, y, -length))
    _sheet(mesh, "granite", 0.0, KERB_WIDTH, -length, 0.0, y)
    _sheet(mesh, "paving", KERB_WIDTH, width, -length, 0.0, y)
    if kerb_ends[0]:
        mesh.quad("granite", (0, 0, 0), (width, 0, 0), (width, y, 0), (0, y, 0))
    if kerb_ends[1]:
        mesh.quad("granite", (width, 0, -length), (0, 0, -length), (0, y, -length), (width, y, -length))
    return mesh


def lane_marks():
    """Ten metres of markings: double centre line, one dash per lane line, parking dots."""
    mesh = Mesh("lane_marks_10m")
    for x in (-0.13, 0.13):
        _sheet(mesh, "marking", x - 0.06, x + 0.06, -10.0, 0.0, PAINT_Y)
    for x in (-LANE, LANE):
        _sheet(mesh, "marking", x - 0.06, x + 0.06, -6.5, -3.5, PAINT_Y)
    for x in (-2 * LANE, 2 * LANE):
        for k in range(5):
            _sheet(mesh, "marking", x - 0.05, x + 0.05, -2 * k - 1.0, -2 * k - 0.5, PAINT_Y)
    return mesh


def crosswalk_bars():
    """Zebra bars of 0.5 m every metre across the carriageway, centred on the origin."""
    mesh = Mesh("crosswalk")
    half = CROSSING_LENGTH / 2.0
    for k in range(-8, 8):
        _sheet(mesh, "marking", k + 0.25, k + 0.75, -half, half, PAINT_Y, (0.37 * k, 0.21 * k))
    return mesh


def _stop_line():
    mesh = Mesh("stop_line")
    _sheet(mesh, "marking", 0.2, 2 * LANE, -0.25, 0.25, PAINT_Y)
    for x in LANE_CENTRES:
        _sheet(mesh, "marking", x - 0.08, x + 0.08, 5.0, 8.0, PAINT_Y)
        mesh.add("marking", [(x - 0.4, PAINT_Y, 5.0), (x + 0.4, PAINT_Y, 5.0), (x, PAINT_Y, 3.6)], [(0, 1, 2)])
    return mesh


def _decal(name, cell_u0, size):
    mesh = Mesh(name)
    half = size / 2.0
    mesh.quad(
        "covers",
        (-half, DECAL_Y, half),
        (half, DECAL_Y, half),
        (half, DECAL_Y, -half),
        (-half, DECAL_Y, -half),
        (cell_u0, 0.0, cell_u0 + 0.5, 1.0),
    )
    return mesh


def _patch():
    mesh = Mesh("asphalt_patch")
    _sheet(mesh, "asphalt_patch", -0.5, 0.5, -0.5, 0.5, DECAL_Y, (1.3, 2.1))
    return mesh


def place_ground(document):
    """Everything that lies flat."""
    root = document.node("ground")
    _place_underlay(document, root)
    _place_carriageway(document, root)
    _place_pavements(document, root)
    _place_markings(document, root)
    _place_decals(document, root)
    _place_garden_floor(document, root)


def _place_underlay(document, root):
    """A sheet just below everything, so that no background shows through the joints of the pieces above."""
    reach = FACADE_X + SIDE_DEPTH
    near, far, count = Z_NEAR + END_STREET, Z_FAR - END_STREET, 16
    length = (near - far) / count
    mesh = Mesh("underlay")
    _sheet(mesh, "asphalt", -reach, reach, -length, 0.0, UNDERLAY_Y)
    for k in range(count):
        document.node(f"underlay_{k:02d}", root, mesh, (0, 0, near - k * length))


def _place_carriageway(document, root):
    road = road_tile()
    for k in range(round((Z_NEAR - Z_FAR) / TILE)):
        document.node(f"road_{k:02d}", root, road, (0, 0, Z_NEAR - k * TILE))
    width = SIDE_DEPTH + FACADE_X - KERB_X
    side = strip("side_road", "asphalt", width, JUNCTIONS[0][0] - JUNCTIONS[0][1])
    for k, (near, _) in enumerate(JUNCTIONS):
        document.node(f"side_road_{k}_right", root, side, (KERB_X, 0, near))
        document.node(f"side_road_{k}_left", root, side, (-KERB_X - width, 0, near))
    reach = END_DEPTH + FACADE_X
    end = strip("end_road", "asphalt", reach, END_STREET)
    for k, z in enumerate((Z_NEAR + END_STREET, Z_FAR)):
        for x in (-reach, 0.0):
            document.node(f"end_road_{k}", root, end, (x, 0, z))


def _place_pavements(document, root):
    for b, (near, far) in enumerate(BLOCKS):
        start, stop = near + SIDE_PAVEMENT, far - SIDE_PAVEMENT
        count = max(1, round((start - stop) / 22.0))
        length = (start - stop) / count
        for k in range(count):
            z = start - k * length
            ends = (k == 0, k == count - 1)
            piece = pavement(f"pavement_{b}{_suffix(ends)}", FACADE_X - KERB_X, length, ends)
            document.node(f"pavement_right_{b}_{k}", root, piece, (KERB_X, 0, z))
            mirrored = pavement(f"pavement_{b}{_suffix(ends[::-1])}", FACADE_X - KERB_X, length, ends[::-1])
            document.node(f"pavement_left_{b}_{k}", root, mirrored, (-KERB_X, 0, z - length), quaternion("y", 180.0))
        _place_side_pavements(document, root, b, near, far)
    reach = FACADE_X + END_DEPTH
    end = pavement("pavement_end", SIDE_PAVEMENT, reach)
    for k in range(2):
        document.node(
            "pavement_end_near",
            root,
            end,
            (k * reach - reach, 0, Z_NEAR + END_STREET - SIDE_PAVEMENT),
            quaternion("y", -90.0),
        )
        document.node(
            "pavement_end_far",
            root,
            end,
            (reach - k * reach, 0, Z_FAR - END_STREET + SIDE_PAVEMENT),
            quaternion("y", 90.0),
        )


def _place_side_pavements(document, root, block, near, far):
    """Pavements along the returning facades; their kerbs look into the side streets."""
    for z, depth, degrees in (
        (near + SIDE_PAVEMENT, END_DEPTH if near == Z_NEAR else SIDE_DEPTH, 90.0),
        (far - SIDE_PAVEMENT, END_DEPTH if far == Z_FAR else SIDE_DEPTH, -90.0),
    ):
        mesh = pavement(f"pavement_side_{depth:g}m", SIDE_PAVEMENT, depth)
        for inner in (FACADE_X, -FACADE_X - depth):
            x = inner + depth if degrees > 0 else inner
            document.node(f"pavement_side_{block}", root, mesh, (x, 0, z), quaternion("y", degrees))


def _suffix(kerb_ends):
    return "".join("_kerb" if end else "_open" for end in kerb_ends)


def _place_markings(document, root):
    marks, crosswalk, stop = lane_marks(), crosswalk_bars(), _stop_line()
    for k in range(round((Z_NEAR - Z_FAR) / 10.0)):
        z = Z_NEAR - 10.0 * k
        if not near_junction(z - 5.0, 13.0):
            document.node(f"lane_marks_{k:02d}", root, marks, (0, 0, z))
    for k, z in enumerate(CROSSINGS):
        document.node(f"crosswalk_{k}", root, crosswalk, (0, 0, z))
        if k % 2 == 0:
            document.node(f"stop_line_{k}", root, stop, (0, 0, z + STOP_GAP))
        else:
            document.node(f"stop_line_{k}", root, stop, (0, 0, z - STOP_GAP), quaternion("y", 180.0))
    document.node("stop_line_end_far", root, stop, (0, 0, Z_FAR + 1.0))
    document.node("stop_line_end_near", root, stop, (0, 0, Z_NEAR - 1.0), quaternion("y", 180.0))


def _place_decals(document, root):
    random = stream("decals")
    manhole, gully, patch = _decal("manhole", 0.0, 0.9), _decal("gully", 0.5, 0.55), _patch()
    for k in range(26):
        z = Z_NEAR - 8.0 - k * 16.5
        x = random.choice((-4.65, -1.55, 1.55, 4.65)) + random.uniform(-0.7, 0.7)
        document.node(f"manhole_{k}", root, manhole, (x, 0, z), quaternion("y", random.choice((0, 90, 180))))
        for side in (-1, 1):
            document.node(f"gully_{k}_{side}", root, gully, (side * (KERB_X - 0.3), 0, z + 3.0))
        if k % 2 == 0:
            document.node(
                f"patch_{k}",
                root,
                patch,
                (random.uniform(-4.5, 4.5), -0.001, z - random.uniform(4.0, 8.0)),
                scale=(random.uniform(1.0, 2.4), 1.0, random.uniform(2.5, 9.0)),
            )


def _place_garden_floor(document, root):
    near, far = BLOCKS[GARDEN_BLOCK]
    count = 4
    length = (near - far) / count
    mesh = Mesh("garden_floor")
    _sheet(mesh, "gravel", -12.0, 0.0, -length, 0.0, PAVEMENT_Y)
    _sheet(mesh, "lawn", -26.0, -12.0, -length + 2.0, -2.0, PAVEMENT_Y + 0.02)
    _sheet(mesh, "gravel", -GARDEN_DEPTH, -12.0, -length, 0.0, PAVEMENT_Y)
    for k in range(count):
        document.node(f"garden_floor_{k}", root, mesh, (-FACADE_X, 0, near - k * length))
