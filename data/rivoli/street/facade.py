"""Upper floors of a facade: one 3.75 m bay with three windows, and the window itself.

Local frame of all facade pieces: x along the wall, y up from the carriageway, z outwards, origin at the
foot of the bay's left edge; the wall face is z = 0.
"""

from .geometry import Mesh
from .tex_openings import WINDOW_COLUMNS, WINDOW_ROWS

BAY = 3.75
GROUND_TOP = 5.7
WALL_TOP = 16.2
TINTS = ("limestone_a", "limestone_b", "limestone_c")
STYLES = ("plain", "top_balcony")
WINDOW_WIDTH, WINDOW_HEIGHT = 1.36, 2.6  # the window mesh; nodes scale it to the openings below
WINDOW_RECESS = 0.24
OPENINGS = ((6.05, 2.85), (9.95, 2.45), (13.3, 2.05))  # sill height and clear height per floor
WINDOW_KINDS = {"window_glass": 8, "window_lit_warm": 6, "window_lit_cool": 4}

CORNICE = [(0.0, 15.75), (0.08, 15.75), (0.12, 16.0), (0.42, 16.12), (0.5, 16.4), (0.5, 16.5), (-0.3, 16.55)]
STRINGS = (
    [(0.0, 9.45), (0.12, 9.5), (0.14, 9.66), (0.0, 9.72)],
    [(0.0, 12.88), (0.10, 12.92), (0.12, 13.05), (0.0, 13.1)],
)
BALCONY = [(0.0, 5.52), (0.16, 5.56), (0.2, 5.72), (0.78, 5.86), (0.8, 6.0), (0.0, 6.02)]
TOP_BALCONY = [(0.0, 12.78), (0.4, 12.92), (0.42, 13.04), (0.0, 13.06)]


def _wall(mesh, material):
    left, right = (BAY - WINDOW_WIDTH) / 2.0, (BAY + WINDOW_WIDTH) / 2.0

    def panel(x0, y0, x1, y1):
        mesh.quad(material, (x0, y0, 0.0), (x1, y0, 0.0), (x1, y1, 0.0), (x0, y1, 0.0))

    panel(0.0, GROUND_TOP, left, WALL_TOP)
    panel(right, GROUND_TOP, BAY, WALL_TOP)
    below = GROUND_TOP
    for sill, height in OPENINGS:
        panel(left, below, right, sill)
        below = sill + height
    panel(left, below, right, WALL_TOP)


def _surrounds(mesh):
    """Reveals, which run out to the architraves' faces, and the architraves around every window."""
    left, right = (BAY - WINDOW_WIDTH) / 2.0, (BAY + WINDOW_WIDTH) / 2.0
    back, face = -WINDOW_RECESS, 0.07
    for floor, (sill, height) in enumerate(OPENINGS):
        top, crown = sill + height, sill + height + 0.22
        mesh.quad("stone_trim", (left, sill, face), (left, sill, back), (left, top, back), (left, top, face))
        mesh.quad("stone_trim", (right, sill, back), (right, sill, face), (right, top, face), (right, top, back))
        mesh.quad("stone_trim", (left, top, back), (right, top, back), (right, top, face), (left, top, face))
        mesh.quad("stone_trim", (left, sill, face), (right, sill, face), (right, sill, back), (left, sill, back))
        mesh.box("stone_trim", (left - 0.2, sill, 0), (left, crown, face), skip="-z-y+y+x")
        mesh.box("stone_trim", (right, sill, 0), (right + 0.2, crown, face), skip="-z-y+y-x")
        mesh.quad("stone_trim", (left, top, face), (right, top, face), (right, crown, face), (left, crown, face))
        if floor < 2:
            hood = [(face, crown), (0.26, crown + 0.1), (0.26, crown + 0.16), (0.0, crown + 0.22)]
            mesh.moulding("stone_trim", hood, left - 0.28, right + 0.28)
        else:
            mesh.quad(
                "stone_trim",
                (left - 0.2, crown, face),
                (right + 0.2, crown, face),
                (right + 0.2, crown, 0),
                (left - 0.2, crown, 0),
            )


def _railing(mesh, x0, x1, y0, height, z, repeats):
    mesh.quad("railing", (x0, y0, z), (x1, y0, z), (x1, y0 + height, z), (x0, y0 + height, z), (0.0, 0.0, repeats, 1.0))


def upper_bay(tint, style):
    """Three floors of one bay: wall, window surrounds, mouldings, balconies with alpha-masked railings."""
    mesh = Mesh(f"upper_bay_{tint}_{style}")
    _wall(mesh, tint)
    _surrounds(mesh)
    mesh.moulding("stone_trim", CORNICE, 0.0, BAY, ends=False)
    mesh.moulding("stone_trim", BALCONY, 0.0, BAY, ends=False)
    mesh.moulding("stone_trim", STRINGS[0], 0.0, BAY, ends=False)
    console = [(0.0, 5.05), (0.1, 5.1), (0.16, 5.45), (0.45, 5.62), (0.45, 5.8), (0.0, 5.8)]
    mesh.moulding("stone_trim", console, 0.0, 0.2)
    _railing(mesh, 0.0, BAY, 6.0, 0.98, 0.74, 4)
    middle = BAY / 2.0
    _railing(mesh, middle - 0.72, middle + 0.72, OPENINGS[1][0], 0.85, 0.1, 2)
    if style == "top_balcony":
        mesh.moulding("stone_trim", TOP_BALCONY, 0.0, BAY, ends=False)
        _railing(mesh, 0.0, BAY, 13.05, 0.95, 0.38, 4)
    else:
        mesh.moulding("stone_trim", STRINGS[1], 0.0, BAY, ends=False)
        _railing(mesh, middle - 0.72, middle + 0.72, OPENINGS[2][0], 0.85, 0.1, 2)
    return mesh


def corner():
    """Fills the notch between the mouldings of two facades that meet at a convex corner (x and z > 0)."""
    mesh = Mesh("facade_corner")
    for profile in (CORNICE, BALCONY, STRINGS[0]):
        for (z0, y0), (z1, y1) in zip(profile, profile[1:]):
            if min(z0, z1) >= 0.0:
                mesh.quad("stone_trim", (0, y0, z0), (z0, y0, z0), (z1, y1, z1), (0, y1, z1))
                mesh.quad("stone_trim", (z0, y0, z0), (z0, y0, 0), (z1, y1, 0), (z1, y1, z1))
    mesh.quad("stone_trim", (0, 16.5, 0.5), (0.5, 16.5, 0.5), (0.5, 16.5, 0), (0, 16.5, 0))
    _railing(mesh, 0.0, 0.74, 6.0, 0.98, 0.74, 1)
    mesh.quad("railing", (0.74, 6.0, 0.74), (0.74, 6.0, 0), (0.74, 6.98, 0), (0.74, 6.98, 0.74), (0.0, 0.0, 1.0, 1.0))
    return mesh


def moulding_ends():
    """Closes the mouldings' ends at x = 0 towards both sides, for the joint between two buildings."""
    mesh = Mesh("moulding_ends")
    for profile in (CORNICE, BALCONY):
        points = [(0.0, y, z) for z, y in profile]
        hub = len(profile) - 1
        fan = [(hub, i, i + 1) for i in range(hub - 1)]
        mesh.add("stone_trim", points, fan + [(a, c, b) for a, b, c in fan])
    return mesh


def window(kind, variant):
    """A French window of two leaves, origin at the middle of its sill; pane texture cell ``variant``."""
    mesh = Mesh(f"{kind}_{variant}")
    half, height = WINDOW_WIDTH / 2.0, WINDOW_HEIGHT
    column, row = variant % WINDOW_COLUMNS, variant // WINDOW_COLUMNS
    inset = 0.004
    cell = (
        (column + inset) / WINDOW_COLUMNS,
        (row + inset) / WINDOW_ROWS,
        (column + 1 - inset) / WINDOW_COLUMNS,
        (row + 1 - inset) / WINDOW_ROWS,
    )
    mesh.quad(kind, (-half, 0, 0), (half, 0, 0), (half, height, 0), (-half, height, 0), cell)
    bars = [
        (-half, 0.0, -half + 0.09, height),
        (half - 0.09, 0.0, half, height),
        (-0.06, 0.0, 0.06, height),
        (-half, 0.0, half, 0.16),
        (-half, height - 0.09, half, height),
        (-half, 0.71 * height, half, 0.74 * height),
    ]
    for x0, y0, x1, y1 in bars:
        mesh.quad("window_frame", (x0, y0, 0.04), (x1, y0, 0.04), (x1, y1, 0.04), (x0, y1, 0.04))
    return mesh
