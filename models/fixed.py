"""Mappings that stay as they were made: what was worked out for a scene holds as long as it."""

from __future__ import annotations

from typing import NoReturn, TypeVar

K = TypeVar("K")
V = TypeVar("V")


class FixedMapping(dict[K, V]):
    """A dict that cannot be changed; another one is made of it with ``{**old, ...}``."""

    def _refuse(self, *_: object, **__: object) -> NoReturn:
        raise TypeError("a scene is not changed; make another one with dataclasses.replace")

    __setitem__ = __delitem__ = __ior__ = _refuse
    clear = pop = popitem = setdefault = update = _refuse

    def __reduce__(self) -> tuple[type[FixedMapping[K, V]], tuple[dict[K, V]]]:
        return FixedMapping, (dict(self),)
