"""A reader of photometric glTF scenes for tools/oracle/oracle, and the grey copies of them that it renders.

Independent of the engine: JSON, numpy and Pillow alone. What it does not read it refuses. SPDX-License-Identifier: MIT
"""

import base64
import copy
import io
import json
import struct
from pathlib import Path
from urllib.parse import unquote

import numpy as np
from PIL import Image

LUMINANCE = np.array([0.212639, 0.715169, 0.072192])
COMPONENTS = {5120: np.int8, 5121: np.uint8, 5122: np.int16, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
READ = {"KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_materials_unlit", "KHR_texture_transform", "KHR_mesh_quantization"}
FARTHEST_ASIDE, FARTHEST_UP = 20, 50  # m, of a fixture from its lamp
GREY = 0.5            # reflectance of every surface of a grey copy


class BadInput(Exception):
    """One line: file, place, reason."""


def read_json(path):
    """The JSON of a .gltf or .glb file, and the binary chunk of the latter."""
    try:
        data = path.read_bytes()
    except OSError as error:
        raise BadInput(f"{path}: {error.strerror}") from None
    try:
        if data[:4] != b"glTF":
            return json.loads(data), None
        length, = struct.unpack_from("<I", data, 12)
        rest = 20 + length
        return json.loads(data[20:rest]), data[rest + 8:] if rest < len(data) else None
    except (ValueError, struct.error) as error:
        raise BadInput(f"{path}: no glTF file: {error}") from None


def sample_first(times, values):
    """The value of an animation at time 0: glTF holds the first key before it; linear between keys."""
    if times[0] >= 0 or len(times) == 1:
        return values[0]
    k = min(int(np.searchsorted(times, 0, side="right")), len(times) - 1)
    share = np.clip((0 - times[k - 1]) / (times[k] - times[k - 1]), 0, 1)
    return values[k - 1] * (1 - share) + values[k] * share


def matrix_of(node):
    if "matrix" in node:
        return np.array(node["matrix"], float).reshape(4, 4).T
    x, y, z, w = np.array(node.get("rotation", [0, 0, 0, 1]), float) / np.linalg.norm(node.get("rotation", [0, 0, 0, 1]))
    turn = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    made = np.eye(4)
    made[:3, :3] = turn * np.array(node.get("scale", [1, 1, 1]), float)
    made[:3, 3] = node.get("translation", [0, 0, 0])
    return made


class Scene:
    """Triangles, lamps and cameras of a file in the world at time 0, m, in double precision.

    corners, normals (n, 3, 3), uv (n, 3, 2), colour (n, 3, 4: factors on the base colour and opacity); material, order
    (of the node, parents first), front (1, or -1 where the node is mirrored) of each triangle; lamps: a structured
    array; fixtures: [first, last) order of each lamp."""

    def __init__(self, path):
        self.path = Path(path)
        self.json, self.chunk = read_json(self.path)
        j = self.json
        unread = set(j.get("extensionsRequired", [])) - READ
        unread |= {e for e in ("EXT_mesh_gpu_instancing", "EXT_lights_ies") if e in j.get("extensionsUsed", [])}
        if unread:
            raise BadInput(f"{self.path}: extensionsUsed: {', '.join(sorted(unread))}: the oracle does not read it")
        for i, node in enumerate(j.get("nodes", [])):
            if "skin" in node or "weights" in node:
                raise BadInput(f"{self.path}: nodes[{i}]: skins and morph targets: the oracle does not read them")
        self.buffers, self.accessors, self.pictures = {}, {}, {}
        self.block = j.get("extras", {}).get("vesper", {}) if isinstance(j.get("extras", {}), dict) else {}
        try:
            self.read_nodes()
            self.read_triangles()
            self.read_materials()
            self.read_lamps()
        except (KeyError, IndexError, TypeError, ValueError) as error:
            raise BadInput(f"{self.path}: not a sound glTF file: {type(error).__name__}: {error}") from None

    # Files

    def fetch(self, uri):
        if uri.startswith("data:"):
            return base64.b64decode(uri.split(",", 1)[1])
        place = self.path.parent / unquote(uri)
        try:
            return place.read_bytes()
        except OSError as error:
            raise BadInput(f"{place}: {error.strerror}, named by {self.path}") from None

    def view(self, index):
        view = self.json["bufferViews"][index]
        b = view["buffer"]
        if b not in self.buffers:
            source = self.json["buffers"][b]
            self.buffers[b] = self.fetch(source["uri"]) if "uri" in source else self.chunk
        first = view.get("byteOffset", 0)
        return self.buffers[b][first:first + view["byteLength"]], view.get("byteStride", 0)

    def numbers(self, view, offset, count, component, width):
        data, stride = self.view(view)
        kind = np.dtype(COMPONENTS[component]).newbyteorder("<")
        stride = stride or kind.itemsize * width
        return np.ndarray((count, width), kind, data, offset, (stride, kind.itemsize)).copy()

    def accessor(self, index):
        if index in self.accessors:
            return self.accessors[index]
        a = self.json["accessors"][index]
        width, count, component = WIDTHS[a["type"]], a["count"], a["componentType"]
        got = self.numbers(a["bufferView"], a.get("byteOffset", 0), count, component, width) if "bufferView" in a else np.zeros((count, width), COMPONENTS[component])
        if "sparse" in a:
            s = a["sparse"]
            places = self.numbers(s["indices"]["bufferView"], s["indices"].get("byteOffset", 0), s["count"], s["indices"]["componentType"], 1)
            got[places[:, 0]] = self.numbers(s["values"]["bufferView"], s["values"].get("byteOffset", 0), s["count"], component, width)
        if a.get("normalized"):
            got = np.maximum(got / np.iinfo(COMPONENTS[component]).max, -1.0)
        self.accessors[index] = got
        return got

    # Nodes

    def read_nodes(self):
        nodes = copy.deepcopy(self.json.get("nodes", []))
        for animation in self.json.get("animations", []):
            for channel in animation["channels"]:
                target, sampler = channel["target"], animation["samplers"][channel["sampler"]]
                if "node" in target and target["path"] in ("translation", "rotation", "scale"):
                    values = self.accessor(sampler["output"]).astype(float)
                    if sampler.get("interpolation") == "CUBICSPLINE":
                        values = values[1::3]
                    nodes[target["node"]][target["path"]] = sample_first(self.accessor(sampler["input"])[:, 0], values).tolist()
        count = len(nodes)
        self.parent = np.full(count, -1)
        for i, node in enumerate(nodes):
            for child in node.get("children", []):
                self.parent[child] = i
        scenes = self.json.get("scenes", [])
        roots = scenes[self.json.get("scene", 0)].get("nodes", []) if scenes else [i for i in range(count) if self.parent[i] < 0]
        self.world, self.order, self.end = np.zeros((count, 4, 4)), np.full(count, -1), np.full(count, -1)
        self.shown = []
        waiting = [(root, False) for root in reversed(roots)]
        while waiting:
            i, left = waiting.pop()
            if left:
                self.end[i] = len(self.shown)
                continue
            self.order[i] = len(self.shown)
            self.shown.append(i)
            own = matrix_of(nodes[i])
            self.world[i] = own if i in roots else self.world[self.parent[i]] @ own
            waiting.append((i, True))
            waiting += [(child, False) for child in reversed(nodes[i].get("children", []))]

    def name(self, node):
        return self.json["nodes"][node].get("name", f"node {node}")

    # Triangles

    def indices(self, primitive, count):
        listed = self.accessor(primitive["indices"])[:, 0].astype(np.int64) if "indices" in primitive else np.arange(count)
        mode = primitive.get("mode", 4)
        if mode == 4:
            return listed[:len(listed) // 3 * 3].reshape(-1, 3)
        if mode not in (5, 6):
            return np.zeros((0, 3), np.int64)
        n = np.arange(max(len(listed) - 2, 0))
        if mode == 6:
            return np.stack([listed[n + 1], listed[n + 2], np.full_like(n, listed[0])], axis=1)
        odd = n % 2
        return np.stack([listed[n], listed[n + 1 + odd], listed[n + 2 - odd]], axis=1)

    def primitive(self, mesh, number):
        p = self.json["meshes"][mesh]["primitives"][number]
        attributes = p["attributes"]
        position = self.accessor(attributes["POSITION"]).astype(float)
        index = self.indices(p, len(position))
        material = p.get("material", -1)
        corners = position[index]
        if "NORMAL" in attributes:
            normals = self.accessor(attributes["NORMAL"]).astype(float)[index]
        else:
            flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
            normals = np.repeat(flat[:, None], 3, axis=1)
        info = self.texture_info(material)
        name = f"TEXCOORD_{info['set']}"
        uv = self.accessor(attributes[name]).astype(float)[index] if name in attributes else np.zeros((len(index), 3, 2))
        s, c = np.sin(info["rotation"]), np.cos(info["rotation"])
        uv = (uv * info["scale"]) @ np.array([[c, s], [-s, c]]).T + info["offset"]
        colour = np.ones((len(index), 3, 4))
        if "COLOR_0" in attributes:
            stated = self.accessor(attributes["COLOR_0"]).astype(float)
            colour[..., :stated.shape[1]] = np.clip(stated, 0, 1)[index]
        return corners, normals, uv, colour, material

    def texture_info(self, material):
        """How the textures of a material lie: as its base colour, else its luminance picture, else what it emits."""
        m = self.json["materials"][material] if material >= 0 else {}
        picture = next((use for use in self.block.get("luminous", []) if use["material"] == material), None)
        source = m.get("pbrMetallicRoughness", {}).get("baseColorTexture") or picture or m.get("emissiveTexture", {})
        more = source.get("extensions", {}).get("KHR_texture_transform", {})
        return {"set": more.get("texCoord", source.get("texCoord", 0)), "rotation": more.get("rotation", 0),
                "scale": np.array(more.get("scale", [1, 1]), float), "offset": np.array(more.get("offset", [0, 0]), float)}

    def read_triangles(self):
        meshes, parts, self.part_boxes = {}, [], {}
        for i in self.shown:
            mesh = self.json["nodes"][i].get("mesh", -1)
            if mesh < 0:
                continue
            if mesh not in meshes:
                meshes[mesh] = [self.primitive(mesh, k) for k in range(len(self.json["meshes"][mesh]["primitives"]))]
            m = self.world[i]
            cofactor = np.stack([np.cross(m[1, :3], m[2, :3]), np.cross(m[2, :3], m[0, :3]), np.cross(m[0, :3], m[1, :3])])
            front = -1 if np.linalg.det(m[:3, :3]) < 0 else 1
            for corners, normals, uv, colour, material in meshes[mesh]:
                n = len(corners)
                if n == 0:
                    continue
                parts.append((corners @ m[:3, :3].T + m[:3, 3], front * (normals @ cofactor.T), uv, colour,
                              np.full(n, material), np.full(n, self.order[i]), np.full(n, front)))
                low, high = corners.reshape(-1, 3).min(0), corners.reshape(-1, 3).max(0)
                box = np.array([np.where([k & 1, k & 2, k & 4], high, low) for k in range(8)])
                self.part_boxes.setdefault(i, []).append(box @ m[:3, :3].T + m[:3, 3])
        if not parts:
            raise BadInput(f"{self.path}: nodes: no node shows a triangle")
        (self.corners, self.normals, self.uv, self.colour, self.material, self.node_order,
         self.front) = (np.concatenate(p) for p in zip(*parts))

    # Materials: whether a triangle is masked, and its texture's opacity

    def read_materials(self):
        materials = self.json.get("materials", [])
        self.cutoff, self.both_sides, self.base_alpha, self.alpha_picture = [], [], [], []
        for m in materials:
            mode, emits = m.get("alphaMode", "OPAQUE"), any(c > 0 for c in m.get("emissiveFactor", [0]))
            masked = mode == "MASK" or (mode == "BLEND" and not emits)
            self.cutoff.append((m.get("alphaCutoff", 0.5) if mode == "MASK" else 0.5) if masked else -1.0)
            self.both_sides.append(m.get("doubleSided", False))
            pbr = m.get("pbrMetallicRoughness", {})
            self.base_alpha.append(pbr.get("baseColorFactor", [1, 1, 1, 1])[3])
            self.alpha_picture.append(pbr.get("baseColorTexture", {}).get("index", -1) if masked else -1)
        # Index -1, no material, is the last one.
        self.cutoff = np.array(self.cutoff + [-1.0])
        self.both_sides = np.array(self.both_sides + [False])
        self.base_alpha = np.array(self.base_alpha + [1.0])
        self.alpha_picture = np.array(self.alpha_picture + [-1])

    def image(self, index):
        source = self.json["images"][index]
        data = self.fetch(source["uri"]) if "uri" in source else self.view(source["bufferView"])[0]
        try:
            return Image.open(io.BytesIO(data)).convert("RGBA")
        except OSError as error:
            raise BadInput(f"{self.path}: images[{index}]: {error}") from None

    def sampler(self, texture):
        t = self.json["textures"][texture]
        return self.json["samplers"][t["sampler"]] if "sampler" in t else {}

    def alpha_of(self, texture, uv):
        """Opacity of a texture at coordinates, 0 to 1: its full size, filtered as its sampler says."""
        if texture not in self.pictures:
            self.pictures[texture] = np.asarray(self.image(self.json["textures"][texture]["source"]))[..., 3] / 255
        return self.filtered(self.pictures[texture], self.sampler(texture), uv)

    def filtered(self, picture, sampler, uv):
        """Values of a picture (rows, columns, or these and channels) at coordinates."""
        size = np.array(picture.shape[1::-1])
        wraps = sampler.get("wrapS", 10497), sampler.get("wrapT", 10497)

        def texel(at):
            placed = []
            for axis in range(2):
                n, i = size[axis], at[:, axis].astype(np.int64)
                if wraps[axis] == 33071:
                    placed.append(np.clip(i, 0, n - 1))
                elif wraps[axis] == 33648:
                    i = i % (2 * n)
                    placed.append(np.where(i < n, i, 2 * n - 1 - i))
                else:
                    placed.append(i % n)
            return picture[placed[1], placed[0]]

        if sampler.get("magFilter") == 9728:
            return texel(np.floor(uv * size))
        at = uv * size - 0.5
        low = np.floor(at)
        share = (at - low).reshape(len(at), 2, *[1] * (picture.ndim - 2))
        row = [texel(low + [0, j]) * (1 - share[:, 0]) + texel(low + [1, j]) * share[:, 0] for j in (0, 1)]
        return row[0] * (1 - share[:, 1]) + row[1] * share[:, 1]

    def open_at(self, triangle, u, v):
        """Whether rays go through masked triangles where they hit them."""
        material = self.material[triangle]
        gone = np.zeros(len(triangle), bool)
        for m in np.unique(material):
            if self.cutoff[m] < 0:
                continue
            here = np.flatnonzero(material == m)
            t = triangle[here]
            weights = np.stack([1 - u[here] - v[here], u[here], v[here]], axis=1)
            alpha = self.base_alpha[m] * (self.colour[t, :, 3] * weights).sum(1)
            if self.alpha_picture[m] >= 0:
                alpha = alpha * self.alpha_of(self.alpha_picture[m], (self.uv[t] * weights[..., None]).sum(1))
            gone[here] = alpha < self.cutoff[m]
        return gone

    # Lamps

    def read_lamps(self):
        j = self.json
        lights = j.get("extensions", {}).get("KHR_lights_punctual", {}).get("lights", [])
        lobes = {lobe["light"]: lobe["exponent"] for lobe in self.block.get("lobes", [])}
        openings = {o["light"]: o for o in self.block.get("openings", []) if "light" in o}
        has_mesh = np.zeros(len(self.parent), bool)
        for i in reversed(self.shown):
            has_mesh[i] |= "mesh" in j["nodes"][i]
            if has_mesh[i] and self.parent[i] >= 0:
                has_mesh[self.parent[i]] = True
        lamps = []
        for i in self.shown:
            use = j["nodes"][i].get("extensions", {}).get("KHR_lights_punctual")
            if use is None:
                continue
            index = use["light"]
            light = lights[index]
            colour = np.array(light.get("color", [1, 1, 1]), float)
            intensity = light.get("intensity", 1.0) * float(LUMINANCE @ colour)
            if light["type"] == "directional" or not intensity > 0:
                continue
            m = self.world[i]
            lamp = {"node": i, "light": index, "place": m[:3, 3], "axis": -m[:3, 2] / np.linalg.norm(m[:3, 2]),
                    "right": m[:3, 0] / np.linalg.norm(m[:3, 0]), "intensity": intensity,
                    "colour": colour / (LUMINANCE @ colour), "slope": 0.0, "offset": 1.0, "exponent": -1.0,
                    "outer": np.pi, "area": 0.0}
            if index in lobes:
                lamp["exponent"], lamp["outer"] = lobes[index], np.pi / 2
            elif light["type"] == "spot":
                spot = light.get("spot", {})
                outer = min(spot.get("outerConeAngle", np.pi / 4), np.pi / 2)
                inner = min(spot.get("innerConeAngle", 0.0), outer * 0.9999)
                lamp["slope"] = 1 / max(np.cos(inner) - np.cos(outer), 1e-5)
                lamp["offset"], lamp["outer"] = 1 - lamp["slope"] * np.cos(inner), outer
            if index in openings:
                o = openings[index]
                lamp["area"] = o["width_m"] * o["height_m"] * (np.pi / 4 if o.get("round") else 1)
            lamp["first"], lamp["last"] = self.fixture(i, has_mesh)
            lamps.append(lamp)
        if not lamps:
            raise BadInput(f"{self.path}: extensions/KHR_lights_punctual: no lamp with a place shines")
        self.lamps = {key: np.array([lamp[key] for lamp in lamps]) for key in lamps[0]}

    def fixture(self, node, has_mesh):
        """[first, last) order of the nodes that never hide a lamp of this node."""
        place = self.world[node][:3, 3]
        stated = {entry["node"]: entry["fixture"] for entry in self.block.get("fixtures", [])}
        if node in stated:
            return (0, 0) if stated[node] == "none" else (self.order[stated[node]], self.end[stated[node]])
        while node >= 0 and not has_mesh[node]:
            node = self.parent[node]
        if node < 0:
            return 0, 0
        first, last = self.order[node], self.end[node]
        corners = np.concatenate([box for i in self.shown[first:last] for box in self.part_boxes.get(i, [])]) - place
        aside, up = np.hypot(corners[:, 0], corners[:, 2]), np.abs(corners[:, 1])
        return (first, last) if aside.max() < FARTHEST_ASIDE and up.max() < FARTHEST_UP else (0, 0)

    # Cameras

    def cameras(self):
        """Nodes with a perspective camera, and these."""
        nodes = [i for i in self.shown if "camera" in self.json["nodes"][i]]
        pairs = [(i, self.json["cameras"][self.json["nodes"][i]["camera"]]) for i in nodes]
        return [(i, camera) for i, camera in pairs if camera.get("type") == "perspective"]

    def camera_names(self):
        names = [camera.get("name", self.name(i)) for i, camera in self.cameras()]
        if not names:
            raise BadInput(f"{self.path}: cameras: none of a perspective kind")
        return names

    def camera(self, name):
        """Axes and place of a camera in the world, its vertical field of view, rad, and near plane, m."""
        for i, camera in self.cameras():
            if name in (camera.get("name", self.name(i)), self.name(i)):
                m = self.world[i]
                back = m[:3, 2] / np.linalg.norm(m[:3, 2])
                right = np.cross(m[:3, 1], back)
                right /= np.linalg.norm(right)
                return np.stack([right, np.cross(back, right), back], axis=1), m[:3, 3], camera["perspective"]["yfov"], camera["perspective"]["znear"]
        raise BadInput(f"{self.path}: cameras: no '{name}'; there is {', '.join(self.camera_names())}")

    # Grey copies

    def embedded(self):
        """The JSON with its buffers in it."""
        j = copy.deepcopy(self.json)
        for i, buffer in enumerate(j.get("buffers", [])):
            self.view(next(k for k, v in enumerate(j["bufferViews"]) if v["buffer"] == i))
            buffer["uri"] = "data:application/octet-stream;base64," + base64.b64encode(self.buffers[i]).decode()
        return j

    def even_copy(self, target):
        """Writes the scene with its materials, dark by themselves, in even light of pi lx alone, so that a picture
        without indirect light holds the reflectance of matt surfaces."""
        j = self.embedded()
        for i, image in enumerate(j.get("images", [])):
            if "uri" in image and not image["uri"].startswith("data:"):
                image["uri"] = "data:;base64," + base64.b64encode(self.fetch(image["uri"])).decode()
        for m in j.get("materials", []):
            for key in ("emissiveFactor", "emissiveTexture"):
                m.pop(key, None)
        for node in j["nodes"]:
            node.get("extensions", {}).pop("KHR_lights_punctual", None)
        j["extensions"]["KHR_lights_punctual"]["lights"] = []
        kept = {key: self.block[key] for key in ("version", "transfer") if key in self.block}
        more = {"ambient": {"illuminance_lx": np.pi}, "sky": {"luminance_cd_m2": 0}}
        j["extras"] = {"vesper": {"version": 1} | kept | more}
        target.write_text(json.dumps(j))

    def grey_copy(self, target, colours=None):
        """Writes the scene as a self-contained .gltf whose surfaces are all matt, of reflectance GREY, dark by themselves and
        without ambient light or sky, so that a picture of it holds lx * GREY / pi. Masks stay. `colours`: of lamps, by their
        number; the intensity in cd stays, so that only the channel tells which lamp gave the light."""
        j = self.embedded()
        textures, images = j.get("textures", []), j.get("images", [])
        kept_images, kept_textures = [], []
        for i, m in enumerate(j.get("materials", [])):
            pbr = {"baseColorFactor": [GREY, GREY, GREY, float(self.base_alpha[i])], "metallicFactor": 0, "roughnessFactor": 1}
            if self.alpha_picture[i] >= 0:
                old = m["pbrMetallicRoughness"]["baseColorTexture"]
                alpha = self.image(textures[old["index"]]["source"]).getchannel("A")
                png = io.BytesIO()
                Image.merge("RGBA", [Image.new("L", alpha.size, 255)] * 3 + [alpha]).save(png, "PNG")
                kept_images.append({"uri": "data:image/png;base64," + base64.b64encode(png.getvalue()).decode()})
                kept_textures.append({**textures[old["index"]], "source": len(kept_images) - 1})
                pbr["baseColorTexture"] = {**old, "index": len(kept_textures) - 1}
            grey = {"name": m.get("name", ""), "pbrMetallicRoughness": pbr, "doubleSided": m.get("doubleSided", False)}
            if self.cutoff[i] >= 0:
                grey |= {"alphaMode": "MASK", "alphaCutoff": float(self.cutoff[i])}
            j["materials"][i] = grey
        if any("material" not in p for mesh in j.get("meshes", []) for p in mesh["primitives"]):
            j.setdefault("materials", []).append({"pbrMetallicRoughness": {"baseColorFactor": [GREY] * 3 + [1], "metallicFactor": 0, "roughnessFactor": 1}})
        for mesh in j.get("meshes", []):
            for p in mesh["primitives"]:
                p.setdefault("material", len(j["materials"]) - 1)
                if "COLOR_0" in p["attributes"]:
                    if self.cutoff[p["material"]] >= 0:
                        raise BadInput(f"{self.path}: meshes '{mesh.get('name', '')}': masked by vertex colours: the oracle cannot make them grey")
                    del p["attributes"]["COLOR_0"]
        j["images"], j["textures"] = kept_images, kept_textures
        for key in ("images", "textures"):
            if not j[key]:
                del j[key]
        block = j.get("extras", {}).get("vesper", {"version": 1})
        block = {key: block[key] for key in ("version", "lobes", "openings") if key in block}
        j["extras"] = {"vesper": block | {"transfer": {"kind": "gamma", "gamma": 2.2}, "ambient": {"illuminance_lx": 0}, "sky": {"luminance_cd_m2": 0}}}
        if colours is not None:
            self.recolour(j, colours)
        target.write_text(json.dumps(j))

    def recolour(self, j, colours):
        """Gives every lamp a light of its own in this colour."""
        old = j["extensions"]["KHR_lights_punctual"]["lights"]
        made, renumbered = [], {}
        for k, (node, light) in enumerate(zip(self.lamps["node"], self.lamps["light"])):
            key = (int(light), tuple(colours[k]))
            if key not in renumbered:
                renumbered[key] = len(made)
                made.append({**old[light], "color": list(colours[k]), "intensity": float(self.lamps["intensity"][k] / (LUMINANCE @ colours[k]))})
            j["nodes"][node]["extensions"]["KHR_lights_punctual"]["light"] = renumbered[key]
        for node in sorted(set(range(len(j["nodes"]))) - set(self.lamps["node"].tolist())):  # dark, or directional
            j["nodes"][node].get("extensions", {}).pop("KHR_lights_punctual", None)
        j["extensions"]["KHR_lights_punctual"]["lights"] = made
        block = j["extras"]["vesper"]
        for key in ("lobes", "openings"):
            if key in block:
                block[key] = [{**entry, "light": new} for entry in block[key] for (light, _), new in renumbered.items() if entry["light"] == light]
