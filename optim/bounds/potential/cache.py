"""Path bounds kept in memory: in a sweep over windows or times the attitude part is computed once."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Callable
from threading import Lock

from .path import PathBound

_MOST = 64
_kept: OrderedDict[tuple[object, ...], PathBound] = OrderedDict()
_lock = Lock()


def remembered(key: tuple[object, ...], compute: Callable[[], PathBound]) -> PathBound:
    """Return the path bound kept under the key, computing it the first time."""
    with _lock:
        if key in _kept:
            _kept.move_to_end(key)
            return _kept[key]
    value = compute()
    with _lock:
        _kept[key] = value
        while len(_kept) > _MOST:
            _kept.popitem(last=False)
    return value
