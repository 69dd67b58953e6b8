"""YAML that a user wrote, as far as a study needs it, bounded while it is read.

Texts, numbers, truths, lists and tables, anchors too; no dates, which nothing takes, and no tags
for other kinds of values.
"""

from __future__ import annotations

from typing import Any

import yaml
from yaml.constructor import ConstructorError

from models.errors import cut
from models.files.inputs import DEEPEST, UnreadableError, refuse_extreme

MOST_VALUES = 5_000
"""Each counted as often as it is named by an alias: ten lines can stand for a billion values."""
LONG = 40
"""Characters of a text that count as one value more."""
DIGITS = 100
"""Characters of a number. One to the base 60 takes time with the square of them."""
TOO_MANY = f"more than {MOST_VALUES} values, those of an alias counted each time; leave some out"
TOO_DEEP = f"values nested more than {DEEPEST} deep; a study nests them 5 deep"
IN_ITSELF = "an alias for what it stands in; name something before it"
KINDS = ("bool", "float", "int", "map", "merge", "null", "seq", "str")


def value(text: str) -> object:
    """What YAML text says. Raises UnreadableError, with the line, for what is no YAML, or has too
    many values, too deep ones, or numbers of too many digits."""
    loader = None
    try:
        loader = _Loader(text)  # which looks for control characters
        found: object = loader.get_single_data()
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        where = f"line {mark.line + 1}, column {mark.column + 1}: " if mark else ""
        why = " ".join(filter(None, (error.context, error.problem)))
        raise UnreadableError(f"not valid YAML: {where}{cut(why, 200)}") from None
    except yaml.YAMLError as error:
        raise UnreadableError(f"not valid YAML: {' '.join(str(error).split())[:200]}") from None
    except (ValueError, OverflowError):  # of `chr` and `int`, by what only scans
        assert loader is not None
        mark = loader.get_mark()
        raise UnreadableError(
            f"not valid YAML: line {mark.line + 1}, column {mark.column + 1}: an escape that is no "
            "character, or a number of too many digits; write another"
        ) from None
    refuse_extreme(found)
    return found


class _Loader(yaml.SafeLoader):
    """Reads no more than it is let, and values of few kinds."""

    def __init__(self, text: str) -> None:
        super().__init__(text)
        self.yaml_implicit_resolvers = {
            first: [(tag, shape) for tag, shape in kinds if tag.rpartition(":")[2] in KINDS]
            for first, kinds in self.yaml_implicit_resolvers.items()
        }
        self.yaml_constructors = {  # type: ignore[misc]  # of this reader alone
            tag: construct
            for tag, construct in self.yaml_constructors.items()
            if tag is None or tag.rpartition(":")[2] in KINDS  # None: the fault of any other
        }
        self.depth = self.values = 0
        self.values_of: dict[int, int] = {}

    def compose_node(self, parent: Any, index: Any) -> Any:
        """As the parser has it: called for each value, with those in it called for within."""
        mark = self.peek_event().start_mark  # type: ignore[no-untyped-call]  # as all of it is
        alias, before = self.check_event(yaml.AliasEvent), self.values
        self.depth += 1
        if self.depth > DEEPEST:
            raise ConstructorError(None, None, TOO_DEEP, mark)
        node = super().compose_node(parent, index)
        self.depth -= 1
        if alias and id(node) not in self.values_of:
            raise ConstructorError(None, None, IN_ITSELF, mark)
        own = 1 + (len(node.value) // LONG if isinstance(node, yaml.ScalarNode) else 0)
        self.values += self.values_of[id(node)] if alias else own
        self.values_of.setdefault(id(node), self.values - before)
        if self.values > MOST_VALUES:
            raise ConstructorError(None, None, TOO_MANY, mark)
        return node

    def construct_scalar(self, node: Any) -> Any:
        """The text of a value, which a number is made of if it is short."""
        text: str = super().construct_scalar(node)
        if node.tag.rpartition(":")[2] in ("int", "float") and len(text) > DIGITS:
            why = f"found {cut(text)}, a number of {len(text)} characters; use at most {DIGITS}"
            raise ConstructorError(None, None, why, node.start_mark)
        text.encode()  # half a character raises ValueError
        return text

    def construct_object(self, node: Any, deep: bool = False) -> Any:
        """A value; a text that its tag does not fit is a fault of the file."""
        try:
            return super().construct_object(node, deep)
        except (ValueError, LookupError):
            kind = node.tag.rpartition(":")[2]
            why = f"found {cut(str(node.value))}; it can not be read as {kind}, write another"
            raise ConstructorError(None, None, why, node.start_mark) from None
