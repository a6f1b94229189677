"""A YAML loader that refuses repeated keys and misleading numbers.

YAML itself keeps the last of two equal keys, and reads 010 as 8, 1:30 as 90 and 1.0e-400 as 0,
without a warning.  The module imports nothing slow, since every parse of the workflow imports it.
"""

import re
from typing import IO

import yaml

MOST_VALUES = 100_000
"""Largest number of keys and values in a file after expansion of aliases.  Checking this number
takes a few seconds."""

UNFINISHED = 0
"""Placeholder for the size of a node whose children are being counted."""


class StrictLoader(yaml.SafeLoader):
    """Loader of plain data, for yaml.load.

    A key next to a merged mapping (<<) may replace a key of that mapping.  Refused content raises
    yaml.constructor.ConstructorError.
    """

    def __init__(self, stream: str | bytes | IO):
        super().__init__(stream)
        self._checked: list[yaml.Node] = []

    def get_single_node(self) -> yaml.Node | None:
        """Parse the document.  A document with too many values is refused before any value is
        constructed."""
        node = super().get_single_node()
        if node is not None and _expanded_size(node, {}) > MOST_VALUES:
            raise yaml.constructor.ConstructorError(
                None, None, f"more than {MOST_VALUES} values after expansion of aliases"
            )
        return node

    def flatten_mapping(self, node: yaml.MappingNode) -> None:
        if not any(node is other for other in self._checked):  # before merging adds keys
            self._checked.append(node)
            self._refuse_twice(node)
        super().flatten_mapping(node)

    def _refuse_twice(self, node: yaml.MappingNode) -> None:
        previous: list[object] = []
        for key_node, _ in node.value:
            if key_node.tag == "tag:yaml.org,2002:merge":
                continue
            key = self.construct_object(key_node, deep=True)
            if any(key == other or str(key) == str(other) for other in previous):  # 1 equals 1.0
                raise yaml.constructor.ConstructorError(
                    None, None, f"the key {key} occurs twice", key_node.start_mark
                )
            previous.append(key)

    def construct_yaml_int(self, node: yaml.ScalarNode) -> int:
        """Construct an integer.  Numbers that YAML reads in another base are rejected."""
        self._refuse_other_bases(node)
        return super().construct_yaml_int(node)

    def construct_yaml_float(self, node: yaml.ScalarNode) -> float:
        """Construct a number.  A number that YAML reads in another base, or that underflows, is
        refused."""
        self._refuse_other_bases(node)
        value = super().construct_yaml_float(node)
        if value == 0.0 and re.search("[1-9]", re.split("[eE]", node.value)[0]):
            raise ValueError(f"{node.value} is not allowed: nearer 0 than a float; write 0")
        return value

    def _refuse_other_bases(self, node: yaml.ScalarNode) -> None:
        """Raise ConstructorError for a number that YAML 1.1 reads in another base: 010 as 8, 1:30
        as 90."""
        text = self.construct_scalar(node).lstrip("+-")
        if ":" in text:
            raise ValueError(f"{node.value} is not allowed: base 60 in YAML; write one number")
        if re.fullmatch("0[0-9_]+", text):
            raise ValueError(
                f"{node.value} is not allowed: base 8 in YAML; write it without the leading 0"
            )

    def construct_object(self, node: yaml.Node, deep: bool = False) -> object:
        try:
            return super().construct_object(node, deep)
        except (yaml.YAMLError, RecursionError):
            raise
        except Exception as error:  # for example a date with month 13
            raise yaml.constructor.ConstructorError(
                None, None, f"{node.tag.rpartition(':')[2]}: {error}", node.start_mark
            ) from None


def _expanded_size(node: yaml.Node, sizes: dict[int, int]) -> int:
    """Number of nodes in a tree after expansion of aliases.

    sizes: dict to which the sizes of the nodes are added, by id.  Raises ConstructorError for a
    node that contains itself.
    """
    if sizes.get(id(node)) == UNFINISHED:
        raise yaml.constructor.ConstructorError(
            None, None, "a value that contains itself is not allowed", node.start_mark
        )
    if id(node) not in sizes:
        sizes[id(node)] = UNFINISHED
        if isinstance(node, yaml.MappingNode):
            children = [child for pair in node.value for child in pair]
        else:
            children = node.value if isinstance(node, yaml.SequenceNode) else []
        sizes[id(node)] = 1 + sum(_expanded_size(child, sizes) for child in children)
    return sizes[id(node)]


StrictLoader.add_constructor("tag:yaml.org,2002:int", StrictLoader.construct_yaml_int)
StrictLoader.add_constructor("tag:yaml.org,2002:float", StrictLoader.construct_yaml_float)
