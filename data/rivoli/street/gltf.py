"""A minimal glTF 2.0 writer: nodes, shared meshes, materials, cameras, one sun and one animation."""

import json

import numpy as np

FLOAT, USHORT, UINT = 5126, 5123, 5125
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963


class Document:
    """Collects a scene and writes ``<name>.gltf`` and ``<name>.bin``."""

    def __init__(self, materials, images):
        """``materials``: glTF material objects in order; ``images``: texture file paths in order."""
        self.materials = materials
        self.images = images
        self.material_index = {material["name"]: i for i, material in enumerate(materials)}
        self.nodes, self.meshes, self.cameras, self.accessors = [], [], [], []
        self.roots = []
        self.channels, self.samplers = [], []
        self._mesh_index, self._triangles = {}, []
        self._streams = {}
        self._scalar_cache = {}

    def node(self, name, parent=None, mesh=None, translation=None, rotation=None, scale=None, **extra):
        """Add a node and return its index; ``mesh`` is a geometry.Mesh, stored once however often used."""
        node = {"name": name}
        if translation is not None:
            node["translation"] = [round(float(v), 5) for v in translation]
        if rotation is not None:
            node["rotation"] = rotation
        if scale is not None:
            node["scale"] = [round(float(v), 5) for v in scale]
        if mesh is not None:
            node["mesh"] = self._store_mesh(mesh)
        node.update(extra)
        self.nodes.append(node)
        index = len(self.nodes) - 1
        if parent is None:
            self.roots.append(index)
        else:
            self.nodes[parent].setdefault("children", []).append(index)
        return index

    def camera(self, name, yfov_deg, parent=None, znear=0.1, aspect=1.6, **placement):
        """Add a perspective camera on a node of the same name."""
        self.cameras.append(
            {
                "name": name,
                "type": "perspective",
                "perspective": {"yfov": round(float(np.radians(yfov_deg)), 7), "znear": znear, "aspectRatio": aspect},
            }
        )
        return self.node(name, parent, camera=len(self.cameras) - 1, **placement)

    def animate(self, node, path, times, values):
        """Add a LINEAR channel; times in seconds, ``path`` "translation" or "rotation"."""
        key = tuple(times)
        if key not in self._scalar_cache:
            self._scalar_cache[key] = self._accessor(np.asarray(times, np.float32), "SCALAR", FLOAT, None, bounds=True)
        values = np.asarray(values, np.float32)
        output = self._accessor(values, "VEC3" if values.shape[1] == 3 else "VEC4", FLOAT, None)
        self.samplers.append({"input": self._scalar_cache[key], "interpolation": "LINEAR", "output": output})
        self.channels.append({"sampler": len(self.samplers) - 1, "target": {"node": node, "path": path}})

    def statistics(self):
        """Counts for the report: instanced triangles, nodes, batches, materials in use."""
        uses = [node["mesh"] for node in self.nodes if "mesh" in node]
        batches = sum(len(self.meshes[m]["primitives"]) for m in set(uses))
        used = {p["material"] for m in set(uses) for p in self.meshes[m]["primitives"]}
        return {
            "triangles": sum(self._triangles[m] for m in uses),
            "nodes": len(self.nodes),
            "meshes": len(self.meshes),
            "draw batches": batches,
            "mesh instances": len(uses),
            "materials": len(used),
        }

    def write(self, folder, name):
        """Write the pair of files."""
        views, blob = [], bytearray()
        for key in sorted(self._streams):
            stride, target, chunks = self._streams[key]
            data = b"".join(chunks)
            blob.extend(b"\0" * (-len(blob) % 4))
            view = {"buffer": 0, "byteOffset": len(blob), "byteLength": len(data), "name": key}
            if target is not None:
                view["target"] = target
            if target == ARRAY_BUFFER:
                view["byteStride"] = stride
            blob.extend(data)
            views.append(view)
        order = {key: i for i, key in enumerate(sorted(self._streams))}
        for accessor in self.accessors:
            accessor["bufferView"] = order[accessor["bufferView"]]
        document = {
            "asset": {"version": "2.0", "generator": "vesper rivoli generator"},
            "extensionsUsed": ["KHR_lights_punctual"],
            "extensions": {
                "KHR_lights_punctual": {
                    "lights": [{"name": "sun", "type": "directional", "intensity": 80000.0, "color": [1.0, 0.96, 0.9]}]
                }
            },
            "scene": 0,
            "scenes": [{"name": name, "nodes": self.roots}],
            "nodes": self.nodes,
            "cameras": self.cameras,
            **({"animations": [{"name": "drive", "channels": self.channels, "samplers": self.samplers}]} if self.channels else {}),
            "meshes": self.meshes,
            "materials": self.materials,
            "textures": [{"sampler": 0, "source": i} for i in range(len(self.images))],
            "images": [{"uri": uri} for uri in self.images],
            "samplers": [{"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497}],
            "accessors": self.accessors,
            "bufferViews": views,
            "buffers": [{"uri": f"{name}.bin", "byteLength": len(blob)}],
        }
        (folder / f"{name}.bin").write_bytes(bytes(blob))
        text = json.dumps(document, separators=(",", ":"))
        (folder / f"{name}.gltf").write_text(text.replace('},{"', '},\n{"') + "\n")

    def _store_mesh(self, mesh):
        if mesh.name not in self._mesh_index:
            primitives = []
            for material, positions, normals, uvs, indices in mesh.primitives():
                small = len(positions) <= 65535
                primitives.append(
                    {
                        "attributes": {
                            "POSITION": self._accessor(positions, "VEC3", FLOAT, ARRAY_BUFFER, bounds=True),
                            "NORMAL": self._accessor(normals, "VEC3", FLOAT, ARRAY_BUFFER),
                            "TEXCOORD_0": self._accessor(uvs, "VEC2", FLOAT, ARRAY_BUFFER),
                        },
                        "indices": self._accessor(
                            indices.astype(np.uint16 if small else np.uint32),
                            "SCALAR",
                            USHORT if small else UINT,
                            ELEMENT_ARRAY_BUFFER,
                        ),
                        "material": self.material_index[material],
                    }
                )
            self._mesh_index[mesh.name] = len(self.meshes)
            self.meshes.append({"name": mesh.name, "primitives": primitives})
            self._triangles.append(mesh.triangle_count())
        return self._mesh_index[mesh.name]

    def _accessor(self, array, kind, component, target, bounds=False):
        key = f"{kind.lower()}_{component}_{'animation' if target is None else 'mesh'}"
        stride = array.itemsize * (array.shape[1] if array.ndim == 2 else 1)
        _, _, chunks = self._streams.setdefault(key, (stride, target, []))
        accessor = {
            "bufferView": key,
            "byteOffset": sum(len(chunk) for chunk in chunks),
            "componentType": component,
            "count": len(array),
            "type": kind,
        }
        if bounds:
            rows = array.reshape(len(array), -1)
            accessor["min"] = [float(v) for v in rows.min(axis=0)]
            accessor["max"] = [float(v) for v in rows.max(axis=0)]
        chunks.append(array.astype(array.dtype.newbyteorder("<")).tobytes())
        self.accessors.append(accessor)
        return len(self.accessors) - 1
