"""Write formulas as MathML, which browsers render without scripts, fonts or a network.

Docutils translates the formulas.
"""

import re

from docutils.utils.math import MathError
from docutils.utils.math.latex2mathml import tex2mathml
from sphinx.errors import ExtensionError


def _mathml(node, as_block):
    try:
        drawn = tex2mathml(node.astext(), as_block=as_block)
    except MathError as error:
        raise ExtensionError(f"formula {node.astext()!r}: {error}") from error
    # Absolute-value bars have the height of a letter and no space around them.
    return re.sub(r"<mo[^>]*>\|</mo>", '<mo stretchy="false" lspace="0" rspace="0">|</mo>', drawn)


def _inline(translator, node):
    translator.body.append(_mathml(node, as_block=False))
    raise _skip()


def _block(translator, node):
    translator.body.append(f'<div class="math">{_mathml(node, as_block=True)}</div>')
    raise _skip()


def _skip():
    from docutils.nodes import SkipNode

    return SkipNode()


def setup(app):
    app.add_html_math_renderer("mathml", (_inline, None), (_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
