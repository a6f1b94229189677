"""Make the pictures of these pages from figures of the workflow, as PNG of 200 dpi.

    python docs/make_images.py results [NAME ...]

NAME: names of figures, without .png; by default all figures of the pages that the folder has.
Figures have 300 dpi, which is more than a page needs. With a palette of 64 colours a picture is
a quarter as large.
"""

import sys
from pathlib import Path

import numpy as np
from PIL import Image

IMAGES = Path(__file__).parent / "images"
SHARE = 200 / 300
COLOURS = {Image.Quantize.FASTOCTREE: 48, Image.Quantize.MEDIANCUT: 16}


def shrunk(path):
    """The picture of a figure."""
    with Image.open(path) as image:
        size = [round(SHARE * side) for side in image.size]
        return with_palette(image.convert("RGB").resize(size, Image.Resampling.LANCZOS))


def with_palette(image):
    """The picture with fewer colours; a dither would make it larger and its lines rough.

    An octree keeps rare colours, such as those of lines, the median cut large pale areas.
    """
    palette = Image.new("P", (1, 1))
    colours = [
        image.quantize(count, method, dither=Image.Dither.NONE).getpalette()[: 3 * count]
        for method, count in COLOURS.items()
    ]
    palette.putpalette(np.concatenate(colours).tolist())
    picture = image.quantize(palette=palette, dither=Image.Dither.NONE)
    paper, final = 3 * picture.getpixel((0, 0)), picture.getpalette()
    picture.putpalette([*final[:paper], 255, 255, 255, *final[paper + 3 :]])
    return picture


def main(results, *names):
    """Write the pictures and say how large they are."""
    for name in names or sorted(path.stem for path in IMAGES.glob("*.png")):
        figure = Path(results, "figures", f"{name}.png")
        if figure.is_file():
            target = IMAGES / figure.name
            shrunk(figure).save(target, optimize=True)
            print(f"{target.name}: {target.stat().st_size / 1e3:.0f} kB")
        elif names:
            sys.exit(f"{figure} is not there: run the workflow first")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(*sys.argv[1:])
