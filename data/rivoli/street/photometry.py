"""The night-time photometry that goes with the daytime street: lamps by node name, emitters by material."""

import json

SODIUM, HALOGEN = 2400, 3800  # K
HEADLAMP, TAIL = {"width_m": 0.265, "height_m": 0.14}, {"width_m": 0.2, "height_m": 0.26}  # their glasses, cars.py
# The glasses of lanterns are meshes that emit, furniture.py and groundfloor.py: here they only shape shadows.
_LANTERN, _ARCADE = ({"width_m": width, "round": True, "drawn": False} for width in (0.4, 0.3))
_SIGNAL = {"width_m": 0.193, "round": True}  # of the area of the ten-sided lens, furniture.py
TAIL_RED, _SIGNAL_RED, _SIGNAL_GREEN = [1.0, 0.02, 0.01], [1.0, 0.05, 0.02], [0.05, 1.0, 0.55]


def measured_photometry():
    """The same night with measured distributions for street lamps and headlamps, and a road of class R3."""
    document = photometry()
    lobes = ("street lamp", "ego low beam", "low beam")
    document["lamps"] = [
        # C0 along the road, C90 towards the carriageway.
        _measured("street lamp", "street_lamp_*/light", "street-lamp.ies", SODIUM)
        | {"flux_lm": 9500, "aim": [0, 0, -1], "c0": [0, 1, 0], "opening": _LANTERN},
        beam("low beam", ["car_ego/headlamp_*", "car_traffic_*/headlamp_*"], "low-beam.csv"),
        # One of the oncoming drivers has forgotten to dip.
        beam("high beam", "car_traffic_005/headlamp_*", "high-beam.csv"),
    ] + [lamp for lamp in document["lamps"] if lamp["name"] not in lobes]
    for emitter in document["emitters"]:
        if emitter["name"] == "headlamp":
            emitter["lamp"] = "low beam"
    document["surfaces"] = [{"materials": "asphalt*", "reflection_table": "R3", "q0": 0.07}]
    return document


def photometry():
    """The document's content; intensities in candela, luminances in cd/m2, angles in degrees."""
    return {
        "version": 1,
        "textures": {"transfer": "gamma", "gamma": 2.2},
        "ambient": {"illuminance_lx": 0.4, "colour_temperature_K": 3200},
        "sky": {"luminance_cd_m2": 0.02, "colour_temperature_K": 2800},
        "lights": {"keep": False},
        "lamps": [
            # The lanterns' reflectors: mostly down and, tilted 6 degrees, towards the carriageway.
            spot("street lamp", "street_lamp_*/light", 3000, (48, 82), SODIUM, aim=[-0.1, 0, -1], opening=_LANTERN),
            # What their glass lets out above the reflector, on facades and trees.
            spot("street lamp glass", "street_lamp_*/light", 700, (72, 89), SODIUM, aim=[0, 0, 1], opening=_LANTERN),
            spot("arcade lantern", "arcade_lamp_*/light", 250, (45, 80), 2700, opening=_ARCADE),
            spot("ego low beam", "car_ego/headlamp_*", 9000, (1.5, 17), HALOGEN, opening=HEADLAMP),
            spot("low beam", "car_traffic_*/headlamp_*", 9000, (1.5, 10), HALOGEN, opening=HEADLAMP),
            # Parked cars show their parking lamps: UN Regulation 77 asks for at least 2 cd.
            spot("parking lamp", "car_parked_*/headlamp_*", 2, (10, 45), 3000, opening=HEADLAMP),
            coloured("tail lamp", ["car_traffic_*/tail_*", "car_ego/tail_*"], 5, (10, 55), TAIL_RED, opening=TAIL),
            coloured("rear parking lamp", "car_parked_*/tail_*", 2, (10, 45), TAIL_RED, opening=TAIL),
            coloured("red signal", "signal_*/red", 100, (5, 40), _SIGNAL_RED, opening=_SIGNAL),
            coloured("green signal", "signal_*/green", 100, (5, 40), _SIGNAL_GREEN, opening=_SIGNAL),
        ],
        "emitters": [
            # As drivers see it, far from the lamp's axis: from below I / A would be 23,700 cd/m^2.
            _glass("lantern glass", "lamp_glass", 8000, SODIUM),
            # I / A, over 0.069 m^2 of glass.
            _glass("arcade lantern glass", "arcade_lamp_glass", 3600, 2700),
            # Seen as their lamps' openings: what they show follows from the candela.
            {"name": "headlamp", "materials": "headlamp_glass", "lamp": ["low beam", "ego low beam"]},
            {"name": "parking lamp", "materials": "headlamp_glass_parked", "lamp": "parking lamp"},
            {"name": "tail lamp", "materials": "tail_glass", "lamp": "tail lamp"},
            {"name": "rear parking lamp", "materials": "tail_glass_parked", "lamp": "rear parking lamp"},
            {"name": "red signal", "materials": "signal_red", "lamp": "red signal"},
            {"name": "green signal", "materials": "signal_green", "lamp": "green signal"},
            # Luminance is rho E / pi of what is lit: 0.6 at 150 lx in dwellings, at 300 lx in offices, 0.5 at 1600 lx in shop
            # windows. The boards of signs have 150 cd/m^2 in the mean, the cross 450: at most 1000 are recommended in
            # city centres (CIE 150:2017, average over a sign, zone E4).
            {
                "name": "warm room",
                "materials": "window_lit_warm",
                "luminance_cd_m2": 30,
                "colour_temperature_K": 2700,
                "modulate": True,
            },
            {
                "name": "cool room",
                "materials": "window_lit_cool",
                "luminance_cd_m2": 60,
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
            {"name": "neon sign", "materials": "sign_lit", "image": "signs.exr"},
            {
                "name": "pharmacy cross",
                "materials": "sign_cross",
                "luminance_cd_m2": 450,
                "colour_rgb": [0.05, 1.0, 0.25],
            },
        ],
        # A driver sees a road at grazing angles, where its luminance coefficient is about Q0 = 0.07 sr^-1 (CIE R3) and not
        # the diffuse albedo of asphalt over pi: until the road has a measured table, its reflectance is pi Q0 = 0.22.
        "surfaces": [{"materials": "asphalt*", "reflectance_scale": 2.2}],
    }


def _glass(name, material, luminance, kelvin):
    return {"name": name, "materials": material, "luminance_cd_m2": luminance, "colour_temperature_K": kelvin}


def spot(name, nodes, candela, cones, kelvin, aim=(0, 0, -1), opening=None):
    """A lamp of full intensity within the first half angle (degrees) that fades to nothing at the second."""
    lamp = {
        "name": name,
        "nodes": nodes,
        "type": "spot",
        "intensity_cd": candela,
        "inner_cone_deg": cones[0],
        "outer_cone_deg": cones[1],
        "aim": list(aim),
        "colour_temperature_K": kelvin,
    }
    return lamp | ({"opening": opening} if opening else {})


def _measured(name, nodes, file, kelvin):
    """A lamp of a measured distribution of data/photometry."""
    return {
        "name": name,
        "nodes": nodes,
        "type": "distribution",
        "file": f"../photometry/{file}",
        "colour_temperature_K": kelvin,
    }


def beam(name, nodes, file):
    """The nodes look 1 degree down; a beam has its cut-off, 0.57 degrees down, in itself."""
    return _measured(name, nodes, file, HALOGEN) | {"pitch_deg": 1, "opening": HEADLAMP}


def coloured(name, nodes, candela, cones, colour, opening):
    lamp = spot(name, nodes, candela, cones, None, opening=opening)
    del lamp["colour_temperature_K"]
    return lamp | {"colour_rgb": colour}


def write_photometry(folder, name):
    """Write the JSON files."""
    for suffix, document in (("", photometry()), (".measured", measured_photometry())):
        (folder / f"{name}{suffix}.photometry.json").write_text(json.dumps(document, indent=2) + "\n")
