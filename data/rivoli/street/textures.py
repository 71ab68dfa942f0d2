"""Writes every texture of the material table: reflectance R is stored as T = R^(1/2.2) in 8 bits."""

import numpy as np
from PIL import Image

from . import tex_ground, tex_masonry, tex_openings, tex_small
from .materials import image_files

JPEG_QUALITY = 90
_SOURCES = (tex_masonry, tex_ground, tex_openings, tex_small)


def write_textures(folder):
    """Generate all textures into ``folder`` and return the total number of texels."""
    folder.mkdir(parents=True, exist_ok=True)
    texels = 0
    for file in image_files():
        image = _encode(_painter(file)())
        if file.endswith(".jpg"):
            image.save(folder / file, quality=JPEG_QUALITY, subsampling=0)
        else:
            image.save(folder / file, optimize=True)
        texels += image.width * image.height
    return texels


def _painter(file):
    name = file.rsplit(".", 1)[0]
    return next(getattr(module, name) for module in _SOURCES if hasattr(module, name))


def _encode(reflectance):
    """Gamma-encode the colour channels; a fourth channel is alpha and stays linear."""
    colour = np.clip(reflectance[..., :3], 0.0, 1.0) ** (1.0 / 2.2)
    planes = [colour] if reflectance.shape[2] == 3 else [colour, reflectance[..., 3:]]
    stored = np.round(np.concatenate(planes, axis=2) * 255.0).astype(np.uint8)
    return Image.fromarray(stored)
