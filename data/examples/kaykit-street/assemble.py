#!/usr/bin/env python3
"""Assembles a street from two sets of free models, as one self-contained daytime glTF file. SPDX-License-Identifier: MIT

    assemble.py ASSETS -o kaykit-street.gltf

ASSETS holds kaykit-city/ (KayKit City Builder Bits 1.0, CC0) and openmaterial/vehicle_example/ (ASAM OpenMATERIAL 3D,
MPL-2.0). Neither is copied into this repository. The result is the same, byte for byte, each time.

KayKit's models share one material with a palette texture; lamps and windows are told apart by the palette field their
triangles use, and get materials of their own here, so that a photometry file can address them by name.
"""
import argparse
import base64
import json
import math
import pathlib
import struct
import sys

SCALE = 5.0     # KayKit is toy-sized: a car is 0.94 long. Times five, a car has 4.7 m, a street 9 m between its kerbs.
TILES = 14      # of 10 m each, along -Z
ROAD = 0.07     # height of the road in KayKit's units; the pavement lies at 0.1

# (column, row) in the palette's 8 x 4 fields -> material, for models whose name starts so.
FIELDS = {
    "building": {(0, 3): "window", (1, 3): "window"},
    "car": {(0, 3): "car_glass", (1, 3): "car_glass", (2, 3): "headlamp_lens", (6, 2): "tail_lamp_lens"},
    "streetlight": {(3, 1): "lamp_glass"},
    "trafficlight": {(4, 1): "signal_red", (2, 3): "signal_amber", (2, 2): "signal_green"},
}
COMPONENTS = {5121: "B", 5123: "H", 5125: "I", 5126: "f"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


def turn_y(degrees):
    half = math.radians(degrees) / 2
    return [0, round(math.sin(half), 9), 0, round(math.cos(half), 9)]


class Model:
    """A glTF file with its buffers."""

    def __init__(self, file):
        self.file = file
        self.json = json.loads(file.read_text())
        self.buffers = [(file.parent / b["uri"]).read_bytes() for b in self.json["buffers"]]

    def values(self, accessor):
        a = self.json["accessors"][accessor]
        view = self.json["bufferViews"][a["bufferView"]]
        width = WIDTHS[a["type"]]
        start = view.get("byteOffset", 0) + a.get("byteOffset", 0)
        flat = struct.unpack_from(f"<{width * a['count']}{COMPONENTS[a['componentType']]}", self.buffers[view["buffer"]], start)
        return [flat[i:i + width] for i in range(0, len(flat), width)]


class Street:
    """The glTF file in the making. Everything lies in one buffer."""

    def __init__(self):
        self.out = {"asset": {"version": "2.0", "generator": "assemble.py of vesper's kaykit-street"}, "scene": 0, "scenes": [{"name": "kaykit street", "nodes": []}]}
        for key in ("nodes", "meshes", "materials", "textures", "images", "samplers", "accessors", "bufferViews", "cameras"):
            self.out[key] = []
        self.bytes = bytearray()
        self.models = {}
        self.shared = {}

    def add(self, key, value):
        self.out[key].append(value)
        return len(self.out[key]) - 1

    def once(self, key, value):
        """Adds a value, or finds the equal one that is there."""
        name = key + json.dumps(value, sort_keys=True)
        if name not in self.shared:
            self.shared[name] = self.add(key, value)
        return self.shared[name]

    def store(self, data, **view):
        while len(self.bytes) % 4:
            self.bytes.append(0)
        start = len(self.bytes)
        self.bytes += data
        return self.add("bufferViews", {"buffer": 0, "byteOffset": start, "byteLength": len(data), **view})

    def copy_accessor(self, model, index, cache):
        if index not in cache:
            a = dict(model.json["accessors"][index])
            view = model.json["bufferViews"][a["bufferView"]]
            start = view.get("byteOffset", 0)
            data = model.buffers[view["buffer"]][start:start + view["byteLength"]]
            stride = {"byteStride": view["byteStride"]} if "byteStride" in view else {}
            a["bufferView"] = self.store(data, **stride)
            cache[index] = self.add("accessors", a)
        return cache[index]

    def texture(self, model, info):
        texture = dict(model.json["textures"][info["index"]])
        image = model.json["images"][texture["source"]]
        data = (model.file.parent / image["uri"]).read_bytes()
        uri = "data:image/png;base64," + base64.b64encode(data).decode()
        made = {"source": self.once("images", {"name": image["name"], "mimeType": "image/png", "uri": uri})}
        if "sampler" in texture:
            made["sampler"] = self.once("samplers", model.json["samplers"][texture["sampler"]])
        return {**info, "index": self.once("textures", made)}

    def material(self, model, index, name=None):
        material = json.loads(json.dumps(model.json["materials"][index]))
        if name:
            material["name"] = name
        pbr = material.get("pbrMetallicRoughness", {})
        for key in ("baseColorTexture", "metallicRoughnessTexture"):
            if key in pbr:
                pbr[key] = self.texture(model, pbr[key])
        return self.once("materials", material)

    def primitives(self, model, source, name, cache):
        """A primitive, cut by palette field where FIELDS says so."""
        attributes = {k: self.copy_accessor(model, v, cache) for k, v in source["attributes"].items()}
        fields = next((v for k, v in FIELDS.items() if name.startswith(k)), None)
        if not fields:
            yield {"attributes": attributes, "indices": self.copy_accessor(model, source["indices"], cache), "material": self.material(model, source["material"])}
            return
        corners = [i[0] for i in model.values(source["indices"])]
        uv = model.values(source["attributes"]["TEXCOORD_0"])
        parts = {}
        for i in range(0, len(corners), 3):
            three = corners[i:i + 3]
            field = (int(8 * sum(uv[c][0] for c in three) / 3), int(4 * sum(uv[c][1] for c in three) / 3))
            parts.setdefault(fields.get(field), []).extend(three)
        for part in sorted(parts, key=lambda p: p or ""):
            # Not every house is awake: windows are named after their building.
            label = f"{part}_{name.removeprefix('building_')}" if part == "window" else part
            view = self.store(struct.pack(f"<{len(parts[part])}H", *parts[part]))
            indices = self.add("accessors", {"bufferView": view, "componentType": 5123, "count": len(parts[part]), "type": "SCALAR"})
            yield {"attributes": attributes, "indices": indices, "material": self.material(model, source["material"], label)}

    def load(self, file):
        """Brings a file's meshes in once; returns the model and its mesh numbers here."""
        if file not in self.models:
            model, cache = Model(file), {}
            named = {n["mesh"]: n["name"] for n in model.json["nodes"] if "mesh" in n}
            meshes = [self.add("meshes", {"name": m["name"], "primitives": [p for s in m["primitives"] for p in self.primitives(model, s, named.get(i, ""), cache)]})
                      for i, m in enumerate(model.json["meshes"])]
            self.models[file] = model, meshes
        return self.models[file]

    def place(self, file, name, parent, children=(), **transform):
        """An instance of a whole file under a node of that name."""
        model, meshes = self.load(file)

        def copy(index):
            node = dict(model.json["nodes"][index])
            if "mesh" in node:
                node["mesh"] = meshes[node["mesh"]]
            if "children" in node:
                node["children"] = [copy(c) for c in node["children"]]
            return self.add("nodes", node)

        roots = [copy(r) for r in model.json["scenes"][0]["nodes"]]
        return self.node(name, parent, children=[*roots, *children], **transform)

    def node(self, name, parent=None, **more):
        index = self.add("nodes", {"name": name, **{k: v for k, v in more.items() if v != []}})
        if parent is None:
            self.out["scenes"][0]["nodes"].append(index)
        else:
            self.out["nodes"][parent].setdefault("children", []).append(index)
        return index

    def loose(self, name, **more):
        """A node that `place` will take as a child."""
        return self.add("nodes", {"name": name, **more})

    def text(self):
        self.out["buffers"] = [{"byteLength": len(self.bytes), "uri": "data:application/octet-stream;base64," + base64.b64encode(self.bytes).decode()}]
        return json.dumps(self.out, separators=(",", ":")) + "\n"


def build(kaykit, car):
    street = Street()
    town = street.node("town", scale=[SCALE] * 3)  # KayKit's units below here, metres elsewhere

    def put(model, name, x, z, turn=0, y=0.0, children=()):
        street.place(kaykit / f"{model}.gltf", name, town, children, translation=[x, y, z], rotation=turn_y(turn))

    for i in range(TILES):
        put("road_straight_crossing" if i in (4, 9) else "road_straight", f"road_{i}", 0, -2 * i)
        for side, order in ((-1, "AHCFDBGE"), (1, "DGBHEACF")):
            put(f"building_{order[i % 8]}", f"building_{'left' if side < 0 else 'right'}_{i}", 2 * side, -2 * i, -90 * side)
        # One lamp each ten metres, left and right in turn; its arm points over the road.
        side = 1 if i % 2 == 0 else -1
        put("streetlight", f"street_lamp_{i}", 0.95 * side, -2 * i - 0.4, 0 if side > 0 else 180, 0.1,
            [street.loose("light", translation=[-0.2, 0.885, 0])])
        put(("bench", "firehydrant", "trash_A", "bush", "dumpster")[i % 5], f"thing_{i}", -1.15 * side, -2 * i + 0.35, 90 * side, 0.1)
    for i, z in ((4, -8.6), (9, -18.6)):
        put("trafficlight_A", f"traffic_light_{i}_right", 0.95, z + 1.2, 180, 0.1)
        put("trafficlight_A", f"traffic_light_{i}_left", -0.95, z - 0.2, 0, 0.1)

    # Right-hand traffic: ahead of us and towards us. KayKit's cars look along +Z.
    cars = (("sedan", 0.3, -5.2, 180), ("hatchback", 0.3, -12.5, 180), ("police", 0.3, -21, 180), ("taxi", -0.3, -3.4, 0),
            ("stationwagon", -0.3, -7.3, 0), ("hatchback", -0.3, -14.6, 0), ("sedan", -0.3, -19.5, 0), ("taxi", -0.3, -25, 0))
    for i, (kind, x, z, turn) in enumerate(cars):
        ends = [street.loose(f"{what}_{side}", translation=[sx * 0.15, y, end * 0.46])
                for what, y, end in (("headlamp", 0.07, 1), ("tail_lamp", 0.085, -1)) for side, sx in (("left", 1), ("right", -1))]
        put(f"car_{kind}", f"car_{i}", x, z, turn, ROAD + 0.055, ends)

    # Our own car is in metres and looks along +X; cameras look along -Z.
    eye = street.loose("driver's eye", translation=[-0.11, 1.105, -0.299], rotation=turn_y(-90), camera=camera(street, "driver", 42))
    street.place(car / "vehicle_example.gltf", "car_ego", None, [eye], translation=[1.5, ROAD * SCALE, 2], rotation=turn_y(90))
    street.node("pavement view", translation=[4.6, 2.0, 6], rotation=turn_y(16), camera=camera(street, "pavement", 50))
    street.node("balcony view", translation=[-3.6, 9, 4], rotation=tilt(-12, -14), camera=camera(street, "balcony", 50))
    return street


def camera(street, name, degrees):
    return street.add("cameras", {"name": name, "type": "perspective", "perspective": {"yfov": round(math.radians(degrees), 6), "znear": 0.05}})


def tilt(yaw, pitch):
    a, b = math.radians(yaw) / 2, math.radians(pitch) / 2
    return [round(math.cos(a) * math.sin(b), 9), round(math.sin(a) * math.cos(b), 9), round(-math.sin(a) * math.sin(b), 9), round(math.cos(a) * math.cos(b), 9)]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("assets", type=pathlib.Path, help="folder with kaykit-city/ and openmaterial/")
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("kaykit-street.gltf"))
    arguments = parser.parse_args()
    kaykit, car = arguments.assets / "kaykit-city", arguments.assets / "openmaterial" / "vehicle_example"
    for folder in (kaykit, car):
        if not folder.is_dir():
            sys.exit(f"{folder}: no such folder; see README.md for where the models come from")
    arguments.output.write_text(build(kaykit, car).text())
    return 0


if __name__ == "__main__":
    sys.exit(main())
