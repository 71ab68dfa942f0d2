"""The night-time photometry that goes with the daytime street: lamps by node name, emitters by material."""

import json

_SODIUM, _HALOGEN, _TAIL_RED = 2400, 3800, [1.0, 0.02, 0.01]


def photometry():
    """The document's content; intensities in candela, luminances in cd/m2, angles in degrees."""
    return {
        "version": 1,
        "textures": {"transfer": "gamma", "gamma": 2.2},
        "ambient": {"illuminance_lx": 0.4, "colour_temperature_K": 3200},
        "sky": {"luminance_cd_m2": 0.02, "colour_temperature_K": 2800},
        "lights": {"keep": False},
        "lamps": [
            # the lanterns' reflectors: mostly down and, tilted 6 degrees, towards the carriageway
            {
                "name": "street lamp",
                "nodes": "street_lamp_*/light",
                "type": "spot",
                "intensity_cd": 1300,
                "inner_cone_deg": 48,
                "outer_cone_deg": 82,
                "aim": [-0.1, 0, -1],
                "colour_temperature_K": _SODIUM,
            },
            # what their glass lets out in all directions, on facades and trees
            {
                "name": "street lamp glass",
                "nodes": "street_lamp_*/light",
                "type": "point",
                "intensity_cd": 300,
                "colour_temperature_K": _SODIUM,
            },
            {
                "name": "arcade lantern",
                "nodes": "arcade_lamp_*/light",
                "type": "point",
                "intensity_cd": 150,
                "colour_temperature_K": 2700,
            },
            {
                "name": "ego low beam",
                "nodes": "car_ego/headlamp_*",
                "type": "cosine_power",
                "intensity_cd": 7000,
                "exponent": 250,
                "colour_temperature_K": _HALOGEN,
            },
            {
                "name": "low beam",
                "nodes": "car_traffic_*/headlamp_*",
                "type": "cosine_power",
                "intensity_cd": 9000,
                "exponent": 250,
                "colour_temperature_K": _HALOGEN,
            },
            {
                "name": "position lamp",
                "nodes": "car_parked_*/headlamp_*",
                "type": "spot",
                "intensity_cd": 8,
                "inner_cone_deg": 40,
                "outer_cone_deg": 80,
                "colour_temperature_K": 3000,
            },
            _red("ego tail lamp", "car_ego/tail_*", 7),
            _red("tail lamp", "car_traffic_*/tail_*", 7),
            _red("parked tail lamp", "car_parked_*/tail_*", 3),
            {
                "name": "red signal",
                "nodes": "signal_*/red",
                "type": "cosine_power",
                "intensity_cd": 70,
                "exponent": 6,
                "colour_rgb": [1.0, 0.05, 0.02],
            },
            {
                "name": "green signal",
                "nodes": "signal_*/green",
                "type": "cosine_power",
                "intensity_cd": 70,
                "exponent": 6,
                "colour_rgb": [0.05, 1.0, 0.55],
            },
        ],
        "emitters": [
            {
                "name": "lantern glass",
                "materials": "lamp_glass",
                "luminance_cd_m2": 5500,
                "colour_temperature_K": _SODIUM,
            },
            {
                "name": "headlamp",
                "materials": "headlamp_glass",
                "luminance_cd_m2": 20000,
                "colour_temperature_K": _HALOGEN,
            },
            {
                "name": "position lamp",
                "materials": "headlamp_glass_parked",
                "luminance_cd_m2": 250,
                "colour_temperature_K": 3000,
            },
            {"name": "tail lamp", "materials": "tail_glass", "luminance_cd_m2": 100, "colour_rgb": _TAIL_RED},
            {
                "name": "parked tail lamp",
                "materials": "tail_glass_parked",
                "luminance_cd_m2": 45,
                "colour_rgb": _TAIL_RED,
            },
            {"name": "red signal", "materials": "signal_red", "luminance_cd_m2": 2200, "colour_rgb": [1.0, 0.05, 0.02]},
            {
                "name": "green signal",
                "materials": "signal_green",
                "luminance_cd_m2": 2200,
                "colour_rgb": [0.05, 1.0, 0.55],
            },
            {
                "name": "warm room",
                "materials": "window_lit_warm",
                "luminance_cd_m2": 90,
                "colour_temperature_K": 2700,
                "modulate": True,
            },
            {
                "name": "cool room",
                "materials": "window_lit_cool",
                "luminance_cd_m2": 100,
                "colour_temperature_K": 4200,
                "modulate": True,
            },
            {
                "name": "shop display",
                "materials": "shop_window",
                "luminance_cd_m2": 260,
                "colour_temperature_K": 3400,
                "modulate": True,
            },
            {
                "name": "shop fascia",
                "materials": "sign_lit",
                "luminance_cd_m2": 220,
                "colour_temperature_K": 3800,
                "modulate": True,
            },
            {
                "name": "pharmacy cross",
                "materials": "sign_cross",
                "luminance_cd_m2": 450,
                "colour_rgb": [0.05, 1.0, 0.25],
            },
        ],
        "surfaces": [{"materials": "asphalt*", "reflectance_scale": 1.0, "roughness": 0.8}],
    }


def _red(name, nodes, candela):
    return {
        "name": name,
        "nodes": nodes,
        "type": "cosine_power",
        "intensity_cd": candela,
        "exponent": 1.5,
        "colour_rgb": _TAIL_RED,
    }


def write_photometry(path):
    """Write the JSON file."""
    path.write_text(json.dumps(photometry(), indent=2) + "\n")
