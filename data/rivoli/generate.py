#!/usr/bin/python3
"""Generate the *Rivoli* street database beside this file, or check that the files here are what it generates.

python3 data/rivoli/generate.py            write rivoli*.gltf, *.bin, *.json, rivoli.xodr, signs.exr, textures/
python3 data/rivoli/generate.py --check    regenerate into a temporary folder and compare byte for byte
"""

import argparse
import filecmp
import sys
import tempfile
from pathlib import Path

sys.dont_write_bytecode = True

from street.drive import write_drive  # noqa: E402
from street.exr import write_exr  # noqa: E402
from street.neon import neon_signs  # noqa: E402
from street.photometry import write_photometry  # noqa: E402
from street.roads import roads  # noqa: E402
from street.scene import build_scene  # noqa: E402
from street.textures import write_textures  # noqa: E402

HERE = Path(__file__).resolve().parent
NAME = "rivoli"


def generate(folder):
    """Write the whole database into ``folder`` and return the counts."""
    document, counts = build_scene()
    document.write(folder, NAME)
    write_photometry(folder, NAME)
    (folder / f"{NAME}.xodr").write_text(roads())
    write_exr(folder / "signs.exr", neon_signs())
    counts["drive triangles"] = write_drive(folder)["triangles"]
    counts["texels"] = write_textures(folder / "textures")
    counts["bytes"] = sum((folder / file).stat().st_size for file in _products(folder))
    return counts


def check():
    """Compare a fresh generation with the files beside this script; returns the differing names."""
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        generate(folder)
        names = sorted(set(_products(folder)) | set(_products(HERE)))
        _, different, missing = filecmp.cmpfiles(folder, HERE, names, shallow=False)
        return different + missing


def _products(folder):
    """Generated files in ``folder``, relative and sorted."""
    suffixes = (".gltf", ".bin", ".photometry.json", ".measured.photometry.json", ".world.json", ".xodr")
    fixed = [NAME + suffix for suffix in suffixes] + [f"{NAME}-drive{suffix}" for suffix in suffixes[:3]] + ["signs.exr"]
    textures = sorted(f"textures/{path.name}" for path in (folder / "textures").glob("*"))
    return [file for file in fixed if (folder / file).exists()] + textures


def main():
    """Command line."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="compare instead of writing")
    arguments = parser.parse_args()
    if arguments.check:
        different = check()
        print("\n".join(f"differs: {name}" for name in different) or "identical")
        return 1 if different else 0
    for name, value in generate(HERE).items():
        print(f"{name:16} {value:>10}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
