"""What the drive adds to the street: a tunnel through the houses at its far end, and a quay to come out on."""

from . import furniture
from .geometry import Mesh, quaternion
from .greenery import tree
from .ground import crosswalk_bars, lane_marks, pavement, road_tile, strip
from .layout import (
    END_DEPTH,
    END_STREET,
    FACADE_X,
    KERB_X,
    LAMP_X,
    LAMP_Y,
    PAVEMENT_Y,
    PORTAL_HALF,
    QUAY_FAR,
    QUAY_NEAR,
    SIDE_PAVEMENT,
    TUNNEL_FAR,
    TUNNEL_HALF,
    TUNNEL_HEIGHT,
    TUNNEL_NEAR,
    stream,
)

EAVES = 16.5
PIECE = 6.0  # of the tunnel, along Z; each has two luminaires
WALK_X = 6.5  # |x| of the kerb in the tunnel
WALK_Y = 0.25
LUMINAIRE = (0.18, 1.2)  # width and length of its glass
LUMINAIRE_X = 3.1
WALK_Z = -312.0  # of the crosswalk before the tunnel
REACH = FACADE_X + END_DEPTH


def place_tunnel(document, placer):
    """The tunnel and the quay; ``placer`` goes on with the facades."""
    _place_road(document)
    root = document.node("tunnel")
    piece, count = _tunnel_piece(), round((TUNNEL_NEAR - TUNNEL_FAR) / PIECE)
    for k in range(count):
        z = TUNNEL_NEAR - k * PIECE
        document.node(f"tunnel_piece_{k:02d}", root, piece, (0, 0, z))
        for side, x in (("left", -LUMINAIRE_X), ("right", LUMINAIRE_X)):
            document.node(
                f"tunnel_lamp_{side}_{k:02d}",
                root,
                translation=(x, TUNNEL_HEIGHT - 0.09, z - PIECE / 2),
                rotation=quaternion("x", -90.0),
            )
    portal = _portal()
    document.node("portal_near", root, portal, (0, 0, TUNNEL_NEAR))
    document.node("portal_far", root, portal, (0, 0, TUNNEL_FAR), quaternion("y", 180.0))
    roof = Mesh("tunnel_roof")
    roof.quad(
        "roof_zinc", (-REACH, EAVES, TUNNEL_NEAR), (REACH, EAVES, TUNNEL_NEAR), (REACH, EAVES, TUNNEL_FAR), (-REACH, EAVES, TUNNEL_FAR)
    )
    document.node(roof.name, root, roof)
    _place_quay(document, placer)


def _tunnel_piece():
    """Walls, walks, ceiling and two luminaires; z from 0 to -PIECE."""
    mesh = Mesh("tunnel_piece")
    h, w, length = TUNNEL_HEIGHT, TUNNEL_HALF, PIECE
    for s in (-1, 1):
        # Corners turn counter-clockwise seen from the road on the left side (s < 0), clockwise on the right.
        for material, (xa, ya), (xb, yb) in (
            ("granite", (WALK_X, 0.0), (WALK_X, WALK_Y)),
            ("granite", (WALK_X, WALK_Y), (w, WALK_Y)),
            ("tunnel_tiles", (w, WALK_Y), (w, 3.2)),
            ("tunnel_concrete", (w, 3.2), (w, h)),
        ):
            corners = [(s * xa, ya, 0), (s * xa, ya, -length), (s * xb, yb, -length), (s * xb, yb, 0)]
            mesh.quad(material, *(corners if s < 0 else corners[::-1]))
    mesh.quad("tunnel_concrete", (-w, h, -length), (w, h, -length), (w, h, 0), (-w, h, 0))
    half_width, half_length = LUMINAIRE[0] / 2, LUMINAIRE[1] / 2
    for x in (-LUMINAIRE_X, LUMINAIRE_X):
        mesh.box(
            "tunnel_lamp_glass",
            (x - half_width, h - 0.08, -length / 2 - half_length),
            (x + half_width, h, -length / 2 + half_length),
            skip="+y",
        )
    return mesh


def _portal():
    """The wall over the mouth and beside it, towards +Z, and the reveal behind it."""
    mesh = Mesh("portal")
    inner, outer, h = TUNNEL_HALF, PORTAL_HALF, TUNNEL_HEIGHT
    mesh.quad("limestone_b", (-outer, h, 0.05), (outer, h, 0.05), (outer, EAVES, 0.05), (-outer, EAVES, 0.05))
    for a, b in ((-outer, -inner), (inner, outer)):
        mesh.quad("stone_trim", (a, 0, 0.05), (b, 0, 0.05), (b, h, 0.05), (a, h, 0.05))
    mesh.box("stone_trim", (-outer, h, 0.0), (outer, h + 0.45, 0.35))
    mesh.box("stone_trim", (-outer, EAVES - 0.4, 0.0), (outer, EAVES, 0.5))
    return mesh


def _place_road(document):
    root = document.node("drive_ground")
    road, length = road_tile(), 20.0
    for k in range(11):
        document.node(f"drive_road_{k:02d}", root, road, (0, 0, TUNNEL_NEAR - k * length))
    end = strip("end_road", "asphalt", REACH, END_STREET)
    for near in (TUNNEL_FAR, QUAY_FAR):
        for x in (-REACH, 0.0):
            document.node("quay_cross_road", root, end, (x, 0.001, near))
    marks = lane_marks()
    for k in range(9):
        document.node(f"tunnel_marks_{k}", root, marks, (0, 0, TUNNEL_NEAR - 3.0 - 10.0 * k))
    for k in range(8):
        document.node(f"quay_marks_{k}", root, marks, (0, 0, QUAY_NEAR - 4.0 - 10.0 * k))
    document.node("drive_crosswalk", root, crosswalk_bars(), (0, 0, WALK_Z))


def _place_quay(document, placer):
    """Pavements, lamps, trees and houses along the road behind the tunnel."""
    root = document.node("quay")
    near, far = QUAY_NEAR - SIDE_PAVEMENT, QUAY_FAR + SIDE_PAVEMENT
    length = (near - far) / 4
    for k in range(4):
        piece = pavement(f"quay_pavement_{int(k == 0)}{int(k == 3)}", FACADE_X - KERB_X, length, (k == 0, k == 3))
        mirrored = pavement(f"quay_pavement_{int(k == 3)}{int(k == 0)}", FACADE_X - KERB_X, length, (k == 3, k == 0))
        document.node(f"quay_right_{k}", root, piece, (KERB_X, 0, near - k * length))
        document.node(f"quay_left_{k}", root, mirrored, (-KERB_X, 0, near - (k + 1) * length), quaternion("y", 180.0))
    lamp, trees, random = furniture.street_lamp(), [tree(variant) for variant in range(3)], stream("quay")
    for k in range(6):
        z = near - 6.0 - 14.6 * k
        for s, side in enumerate((1, -1)):
            name = f"street_lamp_{60 + 2 * k + s:03d}"
            node = document.node(
                name, mesh=lamp, translation=(side * LAMP_X, PAVEMENT_Y, z), rotation=quaternion("y", 0.0 if side > 0 else 180.0)
            )
            document.node(
                f"{name}/light", node, translation=(0, LAMP_Y - PAVEMENT_Y, 0), rotation=quaternion("x", -90.0)
            )
            size = random.uniform(0.6, 0.75)
            document.node(
                f"quay_tree_{k}_{s}", root, random.choice(trees), (side * 10.4, PAVEMENT_Y, z - 7.3), quaternion("y", random.uniform(0, 360)), (size,) * 3
            )
    placer.run((-PORTAL_HALF, TUNNEL_FAR), 180.0, REACH - PORTAL_HALF, "shops")
    placer.run((REACH, TUNNEL_FAR), 180.0, REACH - PORTAL_HALF, "shops")
    placer.run((FACADE_X, QUAY_FAR), -90.0, QUAY_NEAR - QUAY_FAR, "shops", (True, True))
    placer.run((-FACADE_X, QUAY_NEAR), 90.0, QUAY_NEAR - QUAY_FAR, "shops", (True, True))
    placer.run((-REACH, QUAY_FAR - END_STREET), 0.0, 2 * REACH, "arcade")
    for start in (TUNNEL_FAR, QUAY_FAR):
        placer.run((REACH, start - END_STREET), -90.0, END_STREET, "shops")
        placer.run((-REACH, start), 90.0, END_STREET, "shops")
