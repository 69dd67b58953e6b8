"""Motions of driven elastic links, each found once in a process: most tests ask for the same few,
and each takes a third of a second."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cached_property

import pytest

from analytic.elastic.elastic_motion import DrivenElasticMotion
from models.scene import as_bytes

_kept: dict[tuple[object, ...], object] = {}


@contextmanager
def kept_motions() -> Iterator[None]:
    """`DrivenElasticMotion` takes what one of the same scene and shapes has found; until the end of
    the block, as other tests plant faults in what finds it."""

    def once(name: str, key: Callable[[DrivenElasticMotion], tuple[object, ...]]) -> None:
        find = DrivenElasticMotion.__dict__[name].func

        def keep(own: DrivenElasticMotion) -> object:
            if own.bare is not None:
                return find(own)
            where = (name, as_bytes(own.scene), own.by, own.stiffened, *key(own))
            if where not in _kept:
                _kept[where] = find(own)
            return _kept[where]

        kept = cached_property(keep)
        kept.__set_name__(DrivenElasticMotion, name)
        patch.setattr(DrivenElasticMotion, name, kept)

    with pytest.MonkeyPatch.context() as patch:
        once("_periodic", lambda own: (own.halved % 2,))
        once("history", lambda own: (own.halved, own.start, own.until_s))
        yield
