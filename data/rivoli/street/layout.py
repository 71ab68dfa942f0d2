"""Dimensions of the street in metres, world axes: Y up, the street along Z, driving direction -Z, +X right.

The carriageway is the plane y = 0. Right-hand traffic: lanes towards -Z have x > 0.
"""

import random

LANE = 3.1
LANE_CENTRES = (1.55, 4.65)  # |x| of the inner and the outer lane
PARKING_X = 7.2  # |x| of the parked cars' axis
KERB_X = 8.3  # |x| of the kerb line
KERB_WIDTH = 0.3
FACADE_X = 12.3  # |x| of the building line
PAVEMENT_Y = 0.12  # kerb height
LAMP_X = 9.0  # |x| of the lamp columns
LAMP_Y = 6.5  # height of the light points above the carriageway
LAMP_COUNT = 60

Z_NEAR, Z_FAR = 120.0, -320.0
END_STREET = 12.0  # width of the cross streets that close both ends
SIDE_DEPTH = 22.5  # length of the side streets' facades
END_DEPTH = 11.25  # the same at the ends of the street
SIDE_PAVEMENT = 2.5
JUNCTIONS = ((62.0, 50.0), (-40.0, -52.0), (-172.0, -184.0))
BLOCKS = ((120.0, 62.0), (50.0, -40.0), (-52.0, -172.0), (-184.0, -320.0))
GARDEN_BLOCK = 2  # index of the left-hand block that is the garden
GARDEN_DEPTH = 46.0

CROSSING_LENGTH = 4.0  # along Z
CROSSINGS = tuple(z for near, far in JUNCTIONS for z in (near + 3.0, far - 3.0))  # centres
STOP_GAP = 3.2  # from a crossing's centre to the stop line

# parking bays of scooters: (side of the street, z of the first, how many), 0.95 m apart towards -Z
SCOOTER_BAYS = ((1, -22.0, 5), (-1, -62.5, 6), (1, -150.0, 5), (-1, 24.0, 4))
SCOOTER_PITCH = 0.95

# What the drive adds: a tunnel through the houses at the far end, a quay behind it.
TUNNEL_NEAR, TUNNEL_FAR = Z_FAR - END_STREET, -428.0
TUNNEL_HALF, TUNNEL_HEIGHT = 7.0, 5.0  # inside, between the walls and above the road
PORTAL_HALF = 7.5  # of the gap that the facades leave
QUAY_NEAR, QUAY_FAR = TUNNEL_FAR - END_STREET, -528.0

EGO_Z = 0.0
DRIVE_SECONDS = 12.0


def stream(*key):
    """A random generator of its own for every place that needs one; the key is its seed."""
    return random.Random(":".join(str(part) for part in key))


def near_junction(z, margin):
    """True within ``margin`` metres of a side street, an end of the street, or their crossings."""
    if z > Z_NEAR - margin or z < Z_FAR + margin:
        return True
    return any(far - margin < z < near + margin for near, far in JUNCTIONS)
