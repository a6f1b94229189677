"""Make the images of these pages from figures of the workflow, as PNG files of 200 dpi.

    python docs/make_images.py results [NAME ...]

NAME: name of a figure without .png; default: all figures of the pages that exist in the folder.
The figures have 300 dpi. A palette of 64 colours reduces the size of a file to a quarter.
"""

import sys
from pathlib import Path

import numpy as np
from PIL import Image

IMAGES = Path(__file__).parent / "images"
SCALE = 200 / 300
COLOURS = {Image.Quantize.FASTOCTREE: 48, Image.Quantize.MEDIANCUT: 16}


def reduced(path):
    """The smaller image of a figure file."""
    with Image.open(path) as image:
        size = [round(SCALE * side) for side in image.size]
        return with_palette(image.convert("RGB").resize(size, Image.Resampling.LANCZOS))


def with_palette(image):
    """The image with fewer colours, without dithering, which enlarges files and roughens lines.

    The octree method preserves rare colours such as those of lines, the median cut method pale
    areas.
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
    """Write the images and print their sizes."""
    for name in names or sorted(path.stem for path in IMAGES.glob("*.png")):
        figure = Path(results, "figures", f"{name}.png")
        if figure.is_file():
            target = IMAGES / figure.name
            reduced(figure).save(target, optimize=True)
            print(f"{target.name}: {target.stat().st_size / 1e3:.0f} kB")
        elif names:
            sys.exit(f"{figure} does not exist: run the workflow first")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(*sys.argv[1:])
