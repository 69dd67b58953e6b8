"""The one kind of array that is passed about: of double precision, its shape told in words."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
