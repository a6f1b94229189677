"""Make the pictures of these pages from figures of the workflow, as PNG of 200 dpi.

    python docs/make_images.py results [NAME ...]

NAME: of figures, without .png; without any, all that the pages show and the folder has. Figures
are written in 300 dpi, which is more than a page needs. Colours stay what they are.
"""

import sys
from pathlib import Path

from PIL import Image

IMAGES = Path(__file__).parent / "images"
SHARE = 200 / 300


def shrunk(path):
    """The picture of a figure."""
    with Image.open(path) as image:
        size = [round(SHARE * side) for side in image.size]
        return image.convert("RGB").resize(size, Image.Resampling.LANCZOS)


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
