"""The light of lamps, or all light, by Radiance (oconv, obj2mesh, rtrace), for tools/oracle/oracle.

SPDX-License-Identifier: MIT

Lamps are spheres of 1 mm with a brightfunc. A surface of a fixture is a mixfunc that lets those rays through that go to a
lamp of its own; a masked one is a mixpict on a mesh. Directions and places are those of the glTF file.
For all light each material has its mean reflectance, and each triangle its mean emission: a glow, which rays meet by
chance, and which reflects nothing."""

import os
import subprocess
from pathlib import Path

import numpy as np
import pyradiance

from scene import BadInput

RADIUS = 1e-3  # m, of lamps
CLOSE = 5e-3   # m, by which a ray to a lamp may miss it
LOOKS = 4096   # places on triangles of a material, for its mean


class Radiance:
    def __init__(self, scene, folder, light=None):
        """`light`: of light, for all light."""
        self.scene, self.folder, self.light = scene, folder, light
        self.tools = Path(pyradiance.__file__).parent / "bin"
        self.environment = {**os.environ, "PATH": f"{self.tools}:{os.environ['PATH']}", "RAYPATH": f".:{self.tools.parent / 'lib'}"}
        self.calc, self.rad = [], ["void plastic opaque\n0\n0\n5 0 0 0 0 0\n"]
        self.matt = self.mean_reflectances() if light else {}
        self.add_lamps()
        if light:
            self.rad.append("void glow sky\n0\n0\n4 {:.9g} {:.9g} {:.9g} 0\n".format(*light.sky))
            self.rad.append("sky source dome\n0\n0\n4 0 1 0 360\n")
        self.add_triangles()
        self.add_masked()
        (folder / "oracle.cal").write_text("\n".join(self.calc) + "\n")
        (folder / "scene.rad").write_text("\n".join(self.rad))
        (folder / "scene.oct").write_bytes(self.run("oconv", "-n", "12", "-r", "131072", "scene.rad"))

    def run(self, tool, *words, data=None):
        (self.tools / tool).chmod(0o755)
        done = subprocess.run([str(self.tools / tool), *words], cwd=self.folder, env=self.environment, input=data, capture_output=True)
        if done.returncode != 0:
            raise BadInput(f"{tool} {' '.join(words)}: {done.stderr.decode(errors='replace').strip()}")
        return done.stdout

    def mean_reflectances(self):
        """Of materials, over the area of their triangles; a plastic for each of them."""
        scene, noise, made = self.scene, np.random.default_rng(1), {}
        edges = scene.corners[:, 1:] - scene.corners[:, :1]
        area = np.linalg.norm(np.cross(edges[:, 0], edges[:, 1]), axis=1) + 1e-12
        for m in np.unique(scene.material):
            mine = np.flatnonzero(scene.material == m)
            made[m] = self.light.mean_reflectance(noise.choice(mine, LOOKS, p=area[mine] / area[mine].sum()), noise)
            self.rad.append("void plastic matt{}\n0\n0\n5 {:.6g} {:.6g} {:.6g} 0 0\n".format(m, *made[m]))
        return made

    def add_lamps(self):
        lamps = self.scene.lamps
        place = np.round(lamps["place"], 6)
        _, self.at = np.unique(place, axis=0, return_inverse=True)
        self.at = self.at.ravel()
        for group in range(self.at.max() + 1):
            lobes = []
            for k in np.flatnonzero(self.at == group):
                x, y, z = lamps["axis"][k]
                cosine = f"(0-(Dx*({x:.9g})+Dy*({y:.9g})+Dz*({z:.9g})))"
                shape = f"power({cosine},{lamps['exponent'][k]:.9g})" if lamps["exponent"][k] >= 0 else f"ramp({lamps['slope'][k]:.12g}*{cosine}+({lamps['offset'][k]:.12g}))"
                lobes.append(f"{lamps['intensity'][k]:.9g}*{shape}")
            self.calc.append(f"lobe{group} = {' + '.join(lobes)};")
            x, y, z = lamps["place"][np.flatnonzero(self.at == group)[0]]
            mine = self.at == group
            colour = np.average(lamps["colour"][mine], axis=0, weights=lamps["intensity"][mine])
            tint = colour if self.light else np.ones(3)
            red, green, blue = tint / (np.pi * RADIUS**2)
            self.rad.append(f"void brightfunc lobe{group}\n2 lobe{group} oracle.cal\n0\n0\n"
                            f"lobe{group} light lamp{group}\n0\n0\n3 {red:.9g} {green:.9g} {blue:.9g}\n"
                            f"lamp{group} sphere bulb{group}\n0\n0\n4 {x:.9g} {y:.9g} {z:.9g} {RADIUS}\n")
        self.calc += ["ramp(t) = if(t - 1, 1, if(t, t*t, 0));", "power(c, n) = if(c, c^n, 0);",
                      # The square of how far a ray from where it hits misses a place.
                      "misses(x, y, z) = sq((y-Py)*Dz-(z-Pz)*Dy) + sq((z-Pz)*Dx-(x-Px)*Dz) + sq((x-Px)*Dy-(y-Py)*Dx);", "sq(x) = x*x;"]

    def modifiers(self):
        """For each triangle the modifier that lets through the rays to lamps of its fixtures."""
        scene, lamps = self.scene, self.scene.lamps
        spans = np.unique(np.stack([lamps["first"], lamps["last"]], axis=1), axis=0)
        spans = spans[spans[:, 1] > spans[:, 0]]
        key = [()] * len(scene.node_order)
        for number, (first, last) in enumerate(spans):
            for t in np.flatnonzero((scene.node_order >= first) & (scene.node_order < last)):
                key[t] = key[t] + (number,)
        inner = [f"matt{m}" if self.light else "opaque" for m in scene.material]
        for spans_of in sorted(set(key) - {()}):
            name = "fixture" + "_".join(map(str, spans_of))
            own = np.zeros(len(lamps["node"]), bool)
            for number in spans_of:
                own |= (lamps["first"] == spans[number, 0]) & (lamps["last"] == spans[number, 1])
            places = np.unique(np.round(lamps["place"][own], 6), axis=0)
            through = "0"
            for x, y, z in places:
                through = f"if({CLOSE * CLOSE:.9g} - misses({x:.9g},{y:.9g},{z:.9g}), 1, {through})"
            self.calc.append(f"{name} = {through};")
            for kind in sorted({inside for inside, k in zip(inner, key) if k == spans_of}):
                self.rad.append(f"void mixfunc {name}{kind}\n4 void {kind} {name} oracle.cal\n0\n0\n")
        return [inside if k == () else "fixture" + "_".join(map(str, k)) + inside for inside, k in zip(inner, key)]

    def add_triangles(self):
        names, corners = self.modifiers(), self.scene.corners.copy()
        masked = self.scene.cutoff[self.scene.material] >= 0
        size = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
        if self.light:
            masked = masked | ~self.light.stops
            self.add_emitters(names, corners)
        for t in np.flatnonzero(~masked & (size > 1e-9)):
            self.rad.append(f"{names[t]} polygon t{t}\n0\n0\n9 " + " ".join(f"{c:.7f}" for c in corners[t].ravel()))

    def add_emitters(self, names, corners):
        """Triangles that emit, turned so that their front is Radiance's."""
        light = self.light
        for k, t in enumerate(light.emitters):
            names[t] = f"glow{t}"
            self.rad.append("void glow glow{}\n0\n0\n4 {:.6g} {:.6g} {:.6g} 0\n".format(t, *light.mean_emission[k]))
            if light.twofold[k]:
                raise BadInput(f"{self.scene.path}: a material that emits on both sides: not for Radiance")
            if self.scene.front[t] < 0:
                corners[t] = corners[t, ::-1]

    def add_masked(self):
        scene = self.scene
        for m in np.flatnonzero(scene.cutoff >= 0):
            if self.light and self.light.materials.clear[m]:
                continue
            mine = np.flatnonzero(scene.material == m)
            if len(mine) == 0:
                continue
            picture = scene.alpha_picture[m]
            material, mesh = f"mask{m}", f"mask{m}.rtm"
            if picture < 0:
                raise BadInput(f"{scene.path}: materials[{m}]: masked without a texture: not for Radiance")
            scene.alpha_of(picture, np.zeros((1, 2)))
            alpha = scene.pictures[picture]
            write_hdr(self.folder / f"mask{m}.hdr", alpha)
            high, wide = alpha.shape
            u, v = wide / min(wide, high), high / min(wide, high)
            red, green, blue = self.matt.get(m, np.zeros(3))
            self.calc.append(f"cut{m}(r, g, b) = if(r - {scene.cutoff[m] / scene.base_alpha[m]:.9g}, 1, 0);")
            (self.folder / f"mask{m}.mat").write_text(
                f"void plastic opaque\n0\n0\n5 {red:.6g} {green:.6g} {blue:.6g} 0 0\n"
                f"void mixpict {material}\n"
                f"7 opaque void cut{m} mask{m}.hdr oracle.cal {u:.9g}*frac(Lu) {v:.9g}*frac(Lv)\n0\n0\n")
            lines = [f"usemtl {material}"]
            lines += [f"v {x:.7f} {y:.7f} {z:.7f}" for x, y, z in scene.corners[mine].reshape(-1, 3)]
            lines += [f"vt {s:.7f} {1 - t:.7f}" for s, t in scene.uv[mine].reshape(-1, 2)]
            lines += [f"f {k}/{k} {k + 1}/{k + 1} {k + 2}/{k + 2}" for k in range(1, 3 * len(mine), 3)]
            (self.folder / f"mask{m}.obj").write_text("\n".join(lines) + "\n")
            (self.folder / "oracle.cal").write_text("\n".join(self.calc) + "\n")
            self.run("obj2mesh", "-n", "12", "-r", "131072", "-a", f"mask{m}.mat", f"mask{m}.obj", mesh)
            self.rad.append(f"void mesh leaves{m}\n1 {mesh}\n0\n0\n")

    def illuminance(self, position, normal):
        """lx of all lamps on points with these normals."""
        return self.traced(position, normal, "-ab", "0", "-dt", "0", "-dc", "1")[:, 0]

    def all_light(self, position, normal, bounces, paths):
        """lx, RGB, of all light."""
        options = ["-ab", bounces, "-aa", "0", "-ad", paths, "-as", "0", "-dt", "0.01", "-dc", "0.9"]
        return self.traced(position, normal, *options)

    def traced(self, position, normal, *options):
        rows = np.concatenate([position, normal], axis=1)
        text = "\n".join(" ".join(f"{c:.9g}" for c in row) for row in rows) + "\n"
        options = [*map(str, options), "-ds", "0", "-dj", "0", "-lw", "1e-9"]
        got = self.run("rtrace", "-h", "-I", *options, "scene.oct", data=text.encode())
        return np.loadtxt(got.decode().splitlines(), ndmin=2)


def write_hdr(file, alpha):
    """A grey Radiance picture: value / 256 * 2^(e - 128), 128 to 255 in its first byte."""
    mantissa, exponent = np.frexp(np.maximum(alpha, 1e-9))
    pixel = np.repeat(np.clip(np.floor(mantissa * 256), 128, 255).astype(np.uint8)[..., None], 4, axis=2)
    pixel[..., 3] = np.clip(exponent + 128, 1, 255)
    file.write_bytes(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {alpha.shape[0]} +X {alpha.shape[1]}\n".encode() + pixel.tobytes())
