"""Write the images of these pages, as PNG of 200 dpi, from the figures of the workflow.

    python docs/make_images.py results [NAME ...]

NAME: names of figures, without .png. Default: all images that have a figure in the folder.
A palette of 128 colours makes a file a quarter as large.
"""

import sys
from pathlib import Path

from PIL import Image

IMAGES = Path(__file__).parent / "images"
SCALE = 200 / 300
"""Resolution of an image divided by that of a figure."""


def main(results, *names):
    """Write the images and print the size of each."""
    for name in names or sorted(path.stem for path in IMAGES.glob("*.png")):
        path = Path(results, "figures", f"{name}.png")
        if path.is_file():
            with Image.open(path) as figure:
                size = [round(SCALE * side) for side in figure.size]
                image = figure.convert("RGB").resize(size, Image.Resampling.LANCZOS)
            # An octree keeps rare colours, such as those of lines.
            image = image.quantize(128, Image.Quantize.FASTOCTREE, dither=Image.Dither.NONE)
            image.save(IMAGES / path.name, optimize=True)
            print(f"{path.name}: {(IMAGES / path.name).stat().st_size / 1e3:.0f} kB")
        elif names:
            sys.exit(f"{path} does not exist: run the workflow first")


if __name__ == "__main__":
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    main(*sys.argv[1:])
