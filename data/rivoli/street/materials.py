"""The material table: name, texture, tile size, base colour factor D and roughness.

The reflectance of a surface is T^2.2 * D with T the texture's stored value; metallicFactor is always 0.
Roughness 1 is a pure Lambert surface in the renderer, less adds a dielectric lobe.
"""

from dataclasses import dataclass


@dataclass(frozen=True)
class Material:
    """One row of the table; ``tile`` is the metres covered by one texture period."""

    name: str
    texture: str | None = None
    tile: float = 1.0
    colour: tuple = (1.0, 1.0, 1.0)
    roughness: float = 1.0
    masked: bool = False
    cutoff: float = 0.5
    drive_only: bool = False


TABLE = [
    # masonry
    Material("limestone_a", "limestone.jpg", 3.75, (1.0, 0.97, 0.92)),
    Material("limestone_b", "limestone.jpg", 3.75, (0.90, 0.86, 0.79)),
    Material("limestone_c", "limestone.jpg", 3.75, (0.82, 0.81, 0.78)),
    Material("stone_trim", "stone_trim.jpg", 1.875),
    Material("plaster", "stone_trim.jpg", 1.875, (0.95, 0.92, 0.86)),
    Material("chimney_brick", "brick.jpg", 1.2),
    Material("terracotta", None, 1.0, (0.33, 0.13, 0.07)),
    # roofs
    Material("roof_zinc", "zinc.jpg", 3.75),
    Material("roof_slate", "slate.jpg", 1.875),
    # openings
    Material("window_frame", None, 1.0, (0.42, 0.41, 0.38), 1.0),
    Material("window_glass", "window_glass.jpg", roughness=0.08),
    Material("window_lit_warm", "window_lit_warm.jpg"),
    Material("window_lit_cool", "window_lit_cool.jpg"),
    Material("shop_window", "shop_window.jpg", roughness=0.1),
    Material("shop_green", "painted_wood.jpg", 1.0, (0.10, 0.22, 0.16), 1.0),
    Material("shop_red", "painted_wood.jpg", 1.0, (0.40, 0.08, 0.07), 1.0),
    Material("shop_blue", "painted_wood.jpg", 1.0, (0.09, 0.15, 0.33), 1.0),
    Material("sign_lit", "shop_sign.png"),
    Material("sign_cross", None, 1.0, (0.06, 0.40, 0.16), 1.0),
    Material("awning", "awning.jpg", 1.0),
    Material("door", "door.jpg"),
    # ground
    Material("asphalt", "asphalt.jpg", 6.0),
    Material("asphalt_patch", "asphalt.jpg", 6.0, (0.72, 0.72, 0.74), 0.8),
    Material("marking", "marking.jpg", 2.0),
    Material("paving", "paving.jpg", 4.0),
    Material("arcade_floor", "arcade_floor.jpg", 2.5),
    Material("granite", "granite.jpg", 1.0),
    Material("gravel", "gravel.jpg", 2.0),
    Material("covers", "covers.png"),
    # ironwork and street furniture
    Material("railing", "railing.png", 1.0, masked=True),
    Material("garden_railing", "garden_railing.png", 2.0, masked=True, cutoff=0.4),
    Material("iron", None, 1.0, (0.045, 0.055, 0.05), 1.0),
    Material("bin_green", None, 1.0, (0.10, 0.20, 0.12), 1.0),
    Material("bench_wood", "painted_wood.jpg", 0.8, (0.22, 0.30, 0.20), 1.0),
    Material("grey_metal", None, 1.0, (0.30, 0.31, 0.32), 1.0),
    Material("road_signs", "road_signs.png"),
    Material("lamp_glass", None, 1.0, (0.75, 0.72, 0.62), 0.3),
    Material("arcade_lamp_glass", None, 1.0, (0.75, 0.72, 0.62), 0.3),
    Material("signal_red", None, 1.0, (0.50, 0.03, 0.03), 0.3),
    Material("signal_green", None, 1.0, (0.04, 0.45, 0.25), 0.3),
    Material("signal_off", None, 1.0, (0.05, 0.04, 0.03), 1.0),
    # plants
    Material("bark", "bark.jpg", 1.0),
    Material("foliage", "foliage.png", 1.0, masked=True),
    Material("hedge", "hedge.jpg", 1.5),
    Material("lawn", "hedge.jpg", 2.5, (0.9, 1.0, 0.7)),
    # vehicles
    Material("paint_white", "car_panels.jpg", 1.0, (0.65, 0.65, 0.63), 0.12),
    Material("paint_silver", "car_panels.jpg", 1.0, (0.36, 0.37, 0.38), 0.12),
    Material("paint_grey", "car_panels.jpg", 1.0, (0.12, 0.125, 0.13), 0.12),
    Material("paint_black", "car_panels.jpg", 1.0, (0.03, 0.03, 0.032), 0.12),
    Material("paint_blue", "car_panels.jpg", 1.0, (0.05, 0.10, 0.24), 0.12),
    Material("paint_red", "car_panels.jpg", 1.0, (0.34, 0.035, 0.03), 0.12),
    Material("paint_beige", "car_panels.jpg", 1.0, (0.42, 0.37, 0.28), 0.12),
    Material("car_glass", None, 1.0, (0.035, 0.04, 0.042), 0.06),
    Material("car_black", None, 1.0, (0.035, 0.035, 0.035), 1.0),
    Material("wheel", "wheel.png"),
    Material("plates", "plates.png"),
    Material("headlamp_glass", None, 1.0, (0.60, 0.60, 0.58), 0.1),
    Material("headlamp_glass_parked", None, 1.0, (0.60, 0.60, 0.58), 0.1),
    Material("tail_glass", None, 1.0, (0.40, 0.03, 0.03), 0.1),
    Material("tail_glass_parked", None, 1.0, (0.40, 0.03, 0.03), 0.1),
    # people
    Material("clothing", "clothing.jpg"),
    # the tunnel of the drive
    Material("tunnel_tiles", "stone_trim.jpg", 1.2, (0.92, 0.93, 0.90), 0.5, drive_only=True),
    Material("tunnel_concrete", None, 1.0, (0.20, 0.19, 0.18), drive_only=True),
    Material("tunnel_lamp_glass", None, 1.0, (0.60, 0.60, 0.58), 0.3, drive_only=True),
]

_BY_NAME = {material.name: material for material in TABLE}


def tile_metres(name):
    """Metres per texture period of a material."""
    return _BY_NAME[name].tile


def image_files():
    """The texture files in use, in a fixed order."""
    return sorted({material.texture for material in TABLE if material.texture})


def gltf_materials(drive=False):
    """The table as glTF material objects; texture i is image i of :func:`image_files`."""
    files = image_files()
    result = []
    for material in TABLE:
        if material.drive_only and not drive:
            continue
        surface = {"metallicFactor": 0.0, "roughnessFactor": material.roughness}
        if material.colour != (1.0, 1.0, 1.0):
            surface["baseColorFactor"] = [*material.colour, 1.0]
        if material.texture:
            surface["baseColorTexture"] = {"index": files.index(material.texture)}
        entry = {"name": material.name, "pbrMetallicRoughness": surface}
        if material.masked:
            entry.update(alphaMode="MASK", alphaCutoff=material.cutoff, doubleSided=True)
        result.append(entry)
    return result
